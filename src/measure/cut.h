/* SPDX-License-Identifier: MIT
 * A cube cut by a plane: the integrals over what is on the plane's positive side.
 */
#ifndef CSG_MEASURE_CUT_H
#define CSG_MEASURE_CUT_H

#include "measure/integrals.h"

/* Over {x : |x_k| <= half, value + slope . x >= 0}. Off by no more than CSG_CUT_ROUNDING times 8
 * half^3, times half for the first moments and half^2 for the second. Returns the volume, within
 * [0, 8 half^3]. out: NULL where only the volume is asked for. */
double csg_cut_cube(double half, double value, const double slope[3], double out[CSG_INTEGRALS]);

/* The same of a box, |x_k| <= half[k]. */
double csg_cut_box(const double half[3], double value, const double slope[3],
                   double out[CSG_INTEGRALS]);

/* About thirty tetrahedra of at most 7 half^3, each with some twenty roundings of 2^-53. */
#define CSG_CUT_ROUNDING 0x1p-38

/* Integrals around the origin of what has these around c, in place. */
void csg_integrals_shift(double integrals[CSG_INTEGRALS], const double c[3]);

/* Over the cube |x_k| <= half. */
void csg_integrals_of_cube(double half, double out[CSG_INTEGRALS]);

/* Adds a tetrahedron with its sign: positive where (b - a) x (c - a) points away from q. */
void csg_integrals_add_tetrahedron(double out[CSG_INTEGRALS], const double *q, const double *a,
                                   const double *b, const double *c);

#endif
