/* SPDX-License-Identifier: MIT
 * From integrals between bounds to volume, centroid and inertia between bounds.
 */
#ifndef CSG_MEASURE_PROPERTIES_H
#define CSG_MEASURE_PROPERTIES_H

#include "base/geometry.h"
#include "measure/integrals.h"

/* The integrals are around `origin` (scene units). Fills volume, mass, centroid, inertia and what
 * is principal of it. */
void csg_measure_derive(const double low[CSG_INTEGRALS], const double high[CSG_INTEGRALS],
                        csg_vec3 origin, double density, csgm_measures *out);

/* So far, and rounding. */
csgm_interval csg_interval_grown(double low, double high, double relative);

#endif
