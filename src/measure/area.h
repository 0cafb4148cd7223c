/* SPDX-License-Identifier: MIT
 * The area of a solid's surface, between proven bounds.
 */
#ifndef CSG_MEASURE_AREA_H
#define CSG_MEASURE_AREA_H

#include "measure/walk.h"

/* Of a surface less can be known than of what it encloses, at the same cost: how many times the
 * tolerance, and what share of all cubes. */
enum { CSG_AREA_WIDER = 10, CSG_AREA_SHARE = 2 };

typedef struct csg_area_bounds {
    double low, high; /* high: INFINITY where nothing bounds how a field's gradients turn */
    bool is_proven;   /* false: stopped before anything was known */
    uint64_t cubes;   /* looked at */
} csg_area_bounds;

/* Where the outward normal's component along a direction is within [least, most], and the place is
 * no higher along it than a level that is within [level_low, level_high]. */
typedef struct csg_area_selection {
    double direction[3];          /* of unit length */
    double least, most;           /* -1 and 1: all */
    double level_low, level_high; /* field frame; INFINITY: at any height */
} csg_area_selection;

/* Of the surface that is selected; NULL: of all of it. Until the bounds are within tolerance * `of`
 * of each other (0: of the upper one), or most_cubes have been looked at. CSGM_OK, or why it was
 * stopped (reported); *out is what is proven by then. The same for any number of threads. */
csgm_status csg_measure_area(csg_measure_walk *walk, const csg_area_selection *selection,
                             double tolerance, double of, uint64_t most_cubes,
                             csg_area_bounds *out);

#endif
