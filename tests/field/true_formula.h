/* SPDX-License-Identifier: MIT
 * Formulas in interval arithmetic with correct rounding (MPFI): ends that hold whatever the machine
 * does, for tests of our own bounds.
 */
#ifndef TEST_TRUE_FORMULA_H
#define TEST_TRUE_FORMULA_H

#include <mpfi.h>

#include "scene/formula/formula.h"

enum { TRUE_BITS = 96 };

typedef struct true_formula {
    csg_formula_step *steps;
    mpfi_t *values; /* of each step */
    uint32_t count;
    mpfi_t degree, scratch;
    mpfi_t at[3]; /* the box, for true_formula_run */
} true_formula;

/* Takes the steps that `result` needs. */
void true_formula_begin(true_formula *f, const csg_formula_builder *builder, csg_formula_id result);
void true_formula_end(true_formula *f);

/* What the formula can be over f->at. An interval with NaN ends: nothing is known, as of an
 * operation outside of its domain. */
mpfi_srcptr true_formula_run(true_formula *f);

#endif
