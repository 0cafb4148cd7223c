/* SPDX-License-Identifier: MIT
 * A field between two planes: over a cube f(x) is within [value - below, value + above] +
 * slope . (x - c), with rounding.
 */
#ifndef CSG_MEASURE_ENCLOSURE_H
#define CSG_MEASURE_ENCLOSURE_H

#include <math.h>

#include "field/kernels/kernel.h"

typedef struct csg_enclosure {
    double value, slope[3];
    double below, above;
    double stray;   /* > 0: no gradient of the field is farther from `slope`; 0: not known */
    bool is_convex; /* where the field is positive, or where it is not, is convex */
    double bend; /* > 0: gradients turn by no more, per length between two points; 0: not known */
} csg_enclosure;

/* Of gradients, which are found with floats here and there: primitives allow themselves as much. */
#define CSG_ENCLOSURE_ROUNDING 1e-5

/* Of the ball around a cube. */
static inline double csg_enclosure_radius(double half)
{
    return half * sqrt(3.0) * (1 + 1e-9);
}

/* For a tape that is valid in the ball around the cube; c has no rounding as floats. Two ways:
 *   the mean value form, with all gradients within `stray` of `slope` (mesh/distance/slopes.h):
 *     off by stray times the distance from c;
 *   for one primitive whose gradients stray in proportion to the distance from c
 * (CSG_TRAIT_STEADY), and for a formula with bounded second derivatives, Taylor's: off by half of
 * that. False: nothing is known. scratch: as the kernel needs it. */
bool csg_enclosure_find(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                        double half, float *scratch, size_t scratch_floats, csg_enclosure *out);

#endif
