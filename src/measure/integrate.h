/* SPDX-License-Identifier: MIT
 * The ten integrals over a solid, each between proven bounds.
 */
#ifndef CSG_MEASURE_INTEGRATE_H
#define CSG_MEASURE_INTEGRATE_H

#include "measure/integrals.h"
#include "measure/walk.h"

typedef struct csg_integral_bounds {
    double low[CSG_INTEGRALS], high[CSG_INTEGRALS]; /* field frame, all rounding included */
    bool is_proven;                                 /* false: stopped before anything was known */
    uint64_t cubes;                                 /* looked at */
} csg_integral_bounds;

/* Until the volume's bounds are within tolerance * their upper one of each other, or most_cubes
 * have been looked at. CSGM_OK, or why it was stopped (reported); *out is what is proven by then.
 * The same for any number of threads. */
csgm_status csg_measure_integrate(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                                  csg_integral_bounds *out);

#endif
