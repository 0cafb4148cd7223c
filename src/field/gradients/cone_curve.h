/* SPDX-License-Identifier: MIT
 * The gradients that the field of a piece of a curve (curve_kernel.c) can have in a ball; see
 * cone.h.
 */
#ifndef CSG_FIELD_CONE_CURVE_H
#define CSG_FIELD_CONE_CURVE_H

#include <stdbool.h>

/* In the piece's own frame: those in the ball of radius rho around q lie within *spread of
 * `gradient`, which has unit length, and differ by no more than *bend times their points'
 * distance; INFINITY: that is not known. False: no bound. */
bool csg_cone_curve(const float *own, const double q[3], double rho, double gradient[3],
                    double *spread, double *bend);

#endif
