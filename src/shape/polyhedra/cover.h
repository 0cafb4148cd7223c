/* SPDX-License-Identifier: MIT
 * Whether a triangle is near a mesh, by a walk over that mesh: from the triangle below one of its
 * corners across edges to those beside it. Where the two surfaces lie close together that settles
 * it without a search for anything.
 */
#ifndef CSG_SHAPE_COVER_H
#define CSG_SHAPE_COVER_H

#include "shape/polyhedra/piece.h"

/* Of a triangle of a tree, for the edge from each corner to the next: the triangle on its other
 * side, by its place; CSG_ACROSS_NONE where there is none, or none was found soon enough. */
#define CSG_ACROSS_NONE UINT32_MAX
typedef struct csg_across {
    uint32_t places[3];
} csg_across;

/* The tree is that of the chain. False: out of memory. */
bool csg_across_make(csg_arena *scratch, const csg_triangles *chain, const csg_tree *tree,
                     csg_across *across);

/* Whether no point of the triangle (frame units) is farther from the tree's than `enough`; then
 * *bound is at most that, and none is farther than it. begin: the place of a triangle near to one
 * of the corners. False where the walk does not show it. */
bool csg_triangle_is_covered(const csg_tree *tree, const csg_across *across, const csg_vec3 v[3],
                             uint32_t begin, double enough, double *bound);

#endif
