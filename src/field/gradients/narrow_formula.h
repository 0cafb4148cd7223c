/* SPDX-License-Identifier: MIT
 * The values that a formula's steps can have in a box, where the formula's own is in a given range.
 */
#ifndef CSG_FIELD_NARROW_FORMULA_H
#define CSG_FIELD_NARROW_FORMULA_H

#include "field/gradients/cone_formula.h"
#include "field/kernels/functions.h"

enum { CSG_NARROW_MOST = 256 /* steps; formulas of more are not narrowed */ };

/* values: of each of the formula's steps, at all points of the box where its result is within
 * `wanted`. False: there are none. */
bool csg_narrow_formula(const csg_tape *tape, const csg_tape_formula *formula,
                        const csg_cone_box *at, range wanted, range values[CSG_NARROW_MOST]);

#endif
