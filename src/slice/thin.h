/* SPDX-License-Identifier: MIT
 * Fewer points for a closed contour: those stay away whose absence moves it by no more than a given
 * distance.
 *
 * A chord may take the place of others if it passes, in their order, through each edge that they
 * cross, within that distance of the crossing, and past each corner as near. Then it is in the same
 * squares as they were, and these have no other chord: so contours still cross neither others nor
 * themselves. One pass, by a cone of directions that every further edge narrows.
 */
#ifndef CSG_SLICE_THIN_H
#define CSG_SLICE_THIN_H

#include <stdbool.h>
#include <stddef.h>

typedef struct csg_slice_point {
    double x, y;
    double low, high; /* of the edge along its axis, a little within its ends */
    signed char axis; /* along which the edge runs; -1: a corner in a square */
    bool is_pinned;   /* a square beside it has more chords: it stays */
    bool stays;       /* the result */
} csg_slice_point;

/* Returns how many stay: at least three, or all. */
size_t csg_slice_thin(csg_slice_point *points, size_t count, double distance);

#endif
