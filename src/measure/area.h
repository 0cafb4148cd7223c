/* SPDX-License-Identifier: MIT
 * The area of a solid's surface, between proven bounds.
 */
#ifndef CSG_MEASURE_AREA_H
#define CSG_MEASURE_AREA_H

#include "measure/walk.h"

typedef struct csg_area_bounds {
    double low, high; /* high: INFINITY where nothing bounds how a field's gradients turn */
    bool is_proven;   /* false: stopped before anything was known */
    uint64_t cubes;   /* looked at */
} csg_area_bounds;

/* Until they are within tolerance * the upper one of each other, or most_cubes have been looked at.
 * CSGM_OK, or why it was stopped (reported); *out is what is proven by then. The same for any
 * number of threads. */
csgm_status csg_measure_area(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                             csg_area_bounds *out);

#endif
