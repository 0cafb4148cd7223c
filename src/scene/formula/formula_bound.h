/* SPDX-License-Identifier: MIT
 * What formula_bound.c finds of the steps of a formula over a box.
 */
#ifndef CSG_SCENE_FORMULA_BOUND_H
#define CSG_SCENE_FORMULA_BOUND_H

#include "scene/formula/formula.h"

/* NaN ends: nothing is known, not even that there is a value. */
typedef struct csg_formula_range {
    double low, high;
} csg_formula_range;

/* Value, components of the gradient, and a bound of its length. */
typedef struct csg_formula_bound {
    csg_formula_range value;
    csg_formula_range gradient[3];
    double length;
} csg_formula_bound;

/* Of each step, into `bounds` (room for count); returns the last step's length, INFINITY where
 * nothing is known. */
double csg_formula_bound_on_box(const csg_formula_step *steps, uint32_t count, csg_box box,
                                csg_formula_bound *bounds);

#endif
