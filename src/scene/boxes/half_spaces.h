/* SPDX-License-Identifier: MIT
 * Box of an intersection of half-spaces, which none of them bounds alone (a gem cut by planes).
 */
#ifndef CSG_SCENE_HALF_SPACES_H
#define CSG_SCENE_HALF_SPACES_H

#include "base/geometry.h"

enum { CSG_MOST_HALF_SPACES = 24 };

/* normal . p <= d, normal of unit length. */
typedef struct csg_half_space {
    csg_vec3 normal;
    double d;
} csg_half_space;

/* The image of {normal . q <= d} under map. */
csg_half_space csg_half_space_map(csg_half_space half_space, const csg_affine *inverse_of_map);

/* A box of the part of `box` inside all of them, count <= CSG_MOST_HALF_SPACES; `box` itself where
 * that part is unbounded or so long that its tip cannot be told. */
csg_box csg_half_spaces_box(const csg_half_space *half_spaces, size_t count, csg_box box);

#endif
