/* SPDX-License-Identifier: MIT
 * The contours of one layer, from the cubes that it runs through: marching squares on squares of
 * any size.
 *
 * Signs are those of the field at the squares' corners. An edge between two squares, the whole side
 * of the smaller one, is crossed where its ends differ; the crossing is found on it once, whatever
 * its squares, and keeps off its ends. Around a square crossings alternate between into the solid
 * and out of it, so that pairs of neighbours can be joined by chords within it: each crossing has a
 * chord on both sides, and no two chords of a square cross. So contours are closed, and uncrossed;
 * they have the solid on their left. Of two ways to pair four or more the field in the square's
 * middle chooses.
 *
 * A chord in a square that is not smooth gets a corner where the tangents of its two ends meet
 * within the square. At last points are left out (thin.h).
 */
#ifndef CSG_SLICE_CONTOURS_H
#define CSG_SLICE_CONTOURS_H

#include "field/kernels/roots.h"
#include "shape/plane/outline.h"
#include "slice/cubes.h"
#include "slice/thin.h"

typedef struct csg_slice_square csg_slice_square;
typedef struct csg_slice_crossing csg_slice_crossing;

typedef struct csg_slice_contours {
    csg_slice_cubes *cubes;
    csg_memory *memory;
    csg_slice_square *squares;
    csg_slice_crossing *crossings;
    uint32_t *of_squares; /* crossings of each square, one square after the other */
    csg_slice_point *loop;
    size_t square_count, square_capacity, crossing_count, crossing_capacity, of_squares_capacity,
        loop_capacity;
    csg_edges *edges;
    uint64_t points; /* before they were thinned out */
    bool is_open;    /* a contour was not closed, which is a bug */
} csg_slice_contours;

/* False: out of memory; release in any case. */
bool csg_slice_contours_init(csg_slice_contours *contours, csg_slice_cubes *cubes);
void csg_slice_contours_release(csg_slice_contours *contours);

/* Of layer number `layer`, which is in the cubes' slab; appends to *out, in scene units. False: out
 * of memory, or is_open. */
bool csg_slice_contours_make(csg_slice_contours *contours, size_t layer, csg_outline *out);

#endif
