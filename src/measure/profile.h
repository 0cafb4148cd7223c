/* SPDX-License-Identifier: MIT
 * Volume, moments and area of a solid of revolution (axis.h) by half of its section with a plane
 * through the axis, in squares that are divided where more is to be known.
 */
#ifndef CSG_MEASURE_PROFILE_H
#define CSG_MEASURE_PROFILE_H

#include "measure/integrate.h"

typedef struct csg_profile_measures {
    double tolerance, area_tolerance; /* shares of their upper bounds, which are asked */
    csg_integral_bounds integrals;    /* if is_close */
    csgm_interval area;               /* if is_area_close */
    bool is_close, is_area_close;     /* as asked; what is not is to be found by cubes */
} csg_profile_measures;

/* For a walk whose tape turns about its axis. CSGM_OK, or why it was stopped (reported). On one
 * thread: there are few squares. */
csgm_status csg_measure_profile(csg_measure_walk *walk, csg_profile_measures *out);

#endif
