/* SPDX-License-Identifier: MIT
 * Are these the same triangles of the same points, in whatever order?
 */
#ifndef CSG_DIFF_MATCH_H
#define CSG_DIFF_MATCH_H

#include "diff/side.h"

/* A triangle with the least of its points first. */
typedef struct csg_diff_face {
    uint32_t points[3], triangle, turned; /* corner k is number (turned + k) % 3 of the triangle */
} csg_diff_face;

typedef struct csg_diff_match {
    csg_diff_face *faces[2]; /* sorted by their points: each is the same triangle in A and in B */
    size_t count;
} csg_diff_match;

/* *same: whether they are; only then the match is filled. Memory from the pair's arena;
 * CSGM_ERR_MEMORY is reported. */
csgm_status csg_diff_match_make(csg_diff_pair *pair, csg_diff_match *match, bool *same);

#endif
