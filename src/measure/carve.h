/* SPDX-License-Identifier: MIT
 * A cube carved by a formula of half spaces: how much is left, at least and at most.
 */
#ifndef CSG_MEASURE_CARVE_H
#define CSG_MEASURE_CARVE_H

#include "measure/cut.h"
#include "measure/halves.h"

typedef enum csg_carve_side { CSG_CARVE_LEAST, CSG_CARVE_MOST } csg_carve_side;

/* The volume, with rounding as csg_cut_cube; out: NULL, or the integrals around the cube's centre.
 * Where it is not worth the work, 0 or the whole cube. */
double csg_carve(const csg_halves *halves, double half, csg_carve_side side,
                 double out[CSG_INTEGRALS]);

#endif
