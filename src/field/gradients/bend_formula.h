/* SPDX-License-Identifier: MIT
 * How fast the gradient of a formula turns in a box, by interval arithmetic on second derivatives.
 */
#ifndef CSG_FIELD_BEND_FORMULA_H
#define CSG_FIELD_BEND_FORMULA_H

#include "field/gradients/cone_formula.h"

/* x, y, z in `at`, of which the formula is a function all over. *bend: no less than the norm of the
 * matrix of second derivatives anywhere in the box. False: nothing is known, as where a minimum or
 * an absolute value may change sides. */
bool csg_bend_formula(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                      double *bend);

#endif
