/* SPDX-License-Identifier: MIT
 * Whether new triangles would cross the rest of a mesh, near or far in it: a tree of boxes over the
 * triangles in the order of their numbers. Marching cubes numbers them block by block in Morton
 * order, and what replaces a triangle lies where it was: so the tree stays good without being
 * rebuilt, boxes are only filled in again.
 */
#ifndef CSG_MESH_CROSSING_H
#define CSG_MESH_CROSSING_H

#include "base/geometry.h"
#include "mesh/corners.h"

typedef struct csg_crossing_box {
    float min[3], max[3]; /* min > max: nothing there */
} csg_crossing_box;

/* Over places that may change; it tells of them as they are. */
typedef struct csg_crossing {
    const csg_corners *corners;
    const csg_vec3 *at;
    csg_crossing_box *nodes; /* a heap: the children of i are 2 i and 2 i + 1 */
    size_t leaf_count;       /* a power of two */
    double clear;            /* nearer than that to a triangle counts as through it */
} csg_crossing;

/* Triangles to come, and whose place they take. */
typedef struct csg_crossing_change {
    const csg_vec3 (*at)[3];
    const uint32_t (*vertex)[3];
    size_t count;
    uint32_t vertices[2];  /* all triangles at these go, CSG_CORNER_NONE: no others */
    uint32_t triangles[2]; /* and these, the same */
} csg_crossing_change;

/* False: out of memory, nothing to release. */
bool csg_crossing_make(csg_crossing *crossing, const csg_corners *corners, const csg_vec3 *at);
void csg_crossing_release(csg_crossing *crossing);

/* After a triangle has changed, or is gone. */
void csg_crossing_update(csg_crossing *crossing, uint32_t triangle);
void csg_crossing_update_around(csg_crossing *crossing, uint32_t vertex);

/* Whether an edge goes through a triangle: of the new ones, or of one of them and one that stays.
 * What they share, a corner or an edge, does not count. */
bool csg_crossing_is_made(const csg_crossing *crossing, const csg_crossing_change *change);

#endif
