/* SPDX-License-Identifier: MIT
 * The ten integrals over a solid that its mass properties follow from.
 */
#ifndef CSG_MEASURE_INTEGRALS_H
#define CSG_MEASURE_INTEGRALS_H

/* Of 1, x, y, z, then of x^2, y^2, z^2, x y, x z, y z. */
enum {
    CSG_INTEGRAL_ONE,
    CSG_INTEGRAL_X,
    CSG_INTEGRAL_XX = 4,
    CSG_INTEGRAL_XY = 7,
    CSG_INTEGRAL_XZ,
    CSG_INTEGRAL_YZ,
    CSG_INTEGRALS
};

#endif
