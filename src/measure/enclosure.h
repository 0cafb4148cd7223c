/* SPDX-License-Identifier: MIT
 * A field between two planes: over a cube f(x) is within [value - below, value + above] +
 * slope . (x - c), with rounding.
 */
#ifndef CSG_MEASURE_ENCLOSURE_H
#define CSG_MEASURE_ENCLOSURE_H

#include "field/kernels/kernel.h"

typedef struct csg_enclosure {
    double value, slope[3];
    double below, above;
} csg_enclosure;

/* For a tape that is valid in the ball around the cube; c has no rounding as floats. Two ways:
 *   the mean value form, with all gradients within `stray` of `slope` (mesh/distance/slopes.h):
 *     off by stray times the distance from c;
 *   for one primitive whose gradient turns at a rate that is known (scene/primitives/cone_ball.h,
 *     "turning"), Taylor's with the gradient at c: off by half of that rate times the squared
 *     distance, and for convex primitives, whose fields are concave, to one side only.
 * False: nothing is known. scratch: as the kernel needs it. */
bool csg_enclosure_find(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                        double half, float *scratch, size_t scratch_floats, csg_enclosure *out);

#endif
