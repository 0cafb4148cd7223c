/* SPDX-License-Identifier: MIT
 * Whether all of a triangle is near a mesh: the one-sided Hausdorff distance from it, held against
 * a limit by branch and bound.
 */
#ifndef CSG_SHAPE_WITHIN_H
#define CSG_SHAPE_WITHIN_H

#include "shape/polyhedra/piece.h"

typedef enum csg_within {
    CSG_WITHIN,        /* no point is farther than the limit */
    CSG_WITHIN_BEYOND, /* some point is */
    CSG_WITHIN_OPEN    /* not known after as many divisions as are allowed */
} csg_within;

typedef struct csg_within_search {
    const csg_tree *tree;
    double limit;    /* frame units; distances are as computed (csg_piece_slack) */
    uint32_t hint;   /* a place in the tree to begin with; in, out */
    uint64_t pieces; /* looked at; counted on */
    csg_vec3 beyond; /* out: where it is farther, or not known */
} csg_within_search;

/* v: corners, frame units. most: pieces that are looked at. */
csg_within csg_triangle_is_within(csg_within_search *search, const csg_vec3 v[3], uint64_t most);

#endif
