/* SPDX-License-Identifier: MIT
 * How far a solid reaches along directions, between proven bounds; along each axis as a rule.
 */
#ifndef CSG_MEASURE_EXTENT_H
#define CSG_MEASURE_EXTENT_H

#include "measure/walk.h"

enum { CSG_EXTENTS = 6 /* x, y, z: the least, then the largest */ };

typedef struct csg_extents {
    double low[CSG_EXTENTS], high[CSG_EXTENTS]; /* field frame */
    bool is_found[CSG_EXTENTS]; /* the solid has a point there for certain; else the bounds' */
    bool is_close;              /* all are known to the tolerance */
    uint64_t cubes;
} csg_extents;

/* The largest of direction . x over the solid, field frame. */
typedef struct csg_support_point {
    double low, high;
    bool is_found; /* `at` is in the solid for certain and reaches as far as low, but for rounding;
                      else low is nothing but the bounds' */
    csg_vec3 at;
    uint64_t cubes;
} csg_support_point;

/* tolerance: a length. CSGM_OK, or why it was stopped (reported); *out is what is proven by then.
 * The same for any number of threads. */
csgm_status csg_measure_extents(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                                csg_extents *out);

/* The same along each of `count` unit vectors; most_cubes: of each. */
csgm_status csg_measure_reaches(csg_measure_walk *walk, const csg_vec3 *directions, size_t count,
                                double tolerance, uint64_t most_cubes, csg_support_point *out);

#endif
