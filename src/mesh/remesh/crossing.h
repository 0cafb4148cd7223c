/* SPDX-License-Identifier: MIT
 * Whether new triangles would cross the rest of a mesh, near or far in it.
 */
#ifndef CSG_MESH_REMESH_CROSSING_H
#define CSG_MESH_REMESH_CROSSING_H

#include "mesh/remesh/triangle_tree.h"

enum { CSG_CROSSING_MOST = 2 * CSG_CORNERS_MOST_VALENCE };

/* Triangles to come, CSG_CROSSING_MOST at most, and whose place they take. */
typedef struct csg_crossing_change {
    const csg_vec3 (*at)[3];
    const uint32_t (*vertex)[3];
    size_t count;
    uint32_t vertices[2];  /* all triangles at these go, CSG_CORNER_NONE: no others */
    uint32_t triangles[2]; /* and these, the same */
    bool is_fan;           /* all there is around vertex[i][0], which is the same for all */
} csg_crossing_change;

/* Whether an edge goes through a triangle, or comes as near to it as the tree's noise: of the new
 * ones, or of one of them and one that stays. What they share, a corner or an edge, does not
 * count: triangles that lie in one another there are found only where all that is near faces one
 * way, which *one_sheet says; it may be NULL. */
bool csg_crossing_is_made(const csg_triangle_tree *tree, const csg_crossing_change *change,
                          bool *one_sheet);

#endif
