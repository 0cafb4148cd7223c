/* SPDX-License-Identifier: MIT
 * The triangle of a mesh that is nearest to a point: a tree of boxes over the triangles as they
 * are when it is made, in the order of their numbers, which follow the blocks' Morton order.
 */
#ifndef CSG_MESH_REMESH_NEAREST_H
#define CSG_MESH_REMESH_NEAREST_H

#include "mesh/remesh.h"

typedef struct csg_nearest_box {
    float min[3], max[3]; /* min > max: nothing there */
} csg_nearest_box;

typedef struct csg_nearest {
    const csg_remesh *remesh;
    csg_nearest_box *nodes; /* a heap: the children of i are 2 i and 2 i + 1 */
    size_t leaf_count;      /* a power of two */
} csg_nearest;

/* False: out of memory, nothing to release. */
bool csg_nearest_make(csg_nearest *nearest, const csg_remesh *remesh);
void csg_nearest_release(csg_nearest *nearest);

/* The distance, INFINITY where it is over `most`. triangle may be NULL. Any thread. */
double csg_nearest_distance(const csg_nearest *nearest, csg_vec3 at, double most,
                            uint32_t *triangle);

#endif
