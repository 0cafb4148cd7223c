/* SPDX-License-Identifier: MIT
 * See true_formula.h.
 */
#include "field/true_formula.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

void true_formula_begin(true_formula *f, const csg_formula_builder *builder, csg_formula_id result)
{
    f->steps = calloc(builder->count, sizeof *f->steps);
    assert_non_null(f->steps);
    f->count = csg_formula_collect(builder, result, f->steps);
    assert_true(f->count > 0);
    f->values = calloc(f->count, sizeof *f->values);
    assert_non_null(f->values);
    for (uint32_t i = 0; i < f->count; i++)
        mpfi_init2(f->values[i], TRUE_BITS);
    for (int axis = 0; axis < 3; axis++)
        mpfi_init2(f->at[axis], TRUE_BITS);
    mpfi_init2(f->scratch, TRUE_BITS);
    mpfi_init2(f->degree, TRUE_BITS);
    mpfi_const_pi(f->degree);
    mpfi_div_ui(f->degree, f->degree, 180);
}

void true_formula_end(true_formula *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        mpfi_clear(f->values[i]);
    for (int axis = 0; axis < 3; axis++)
        mpfi_clear(f->at[axis]);
    mpfi_clear(f->scratch);
    mpfi_clear(f->degree);
    free(f->values);
    free(f->steps);
}

static void nothing_known(mpfi_ptr out)
{
    mpfr_set_nan(&out->left);
    mpfr_set_nan(&out->right);
}

static void least_or_most(mpfi_ptr out, mpfi_srcptr a, mpfi_srcptr b, bool least)
{
    if (mpfi_nan_p(a) || mpfi_nan_p(b)) {
        nothing_known(out);
    } else if (least) {
        mpfr_min(&out->left, &a->left, &b->left, MPFR_RNDD);
        mpfr_min(&out->right, &a->right, &b->right, MPFR_RNDU);
    } else {
        mpfr_max(&out->left, &a->left, &b->left, MPFR_RNDD);
        mpfr_max(&out->right, &a->right, &b->right, MPFR_RNDU);
    }
}

/* A base above 0, as e^(b ln a); 0 itself with a positive exponent at its lower end. */
static void power(true_formula *f, mpfi_ptr out, mpfi_srcptr a, mpfi_srcptr b)
{
    bool from_zero = mpfr_zero_p(&a->left) && mpfr_sgn(&b->left) > 0;
    if (mpfi_nan_p(a) || mpfi_nan_p(b) || mpfr_sgn(&a->left) < 0 ||
        (mpfr_zero_p(&a->left) && !from_zero)) {
        nothing_known(out);
    } else if (mpfr_zero_p(&a->right)) {
        mpfi_set_ui(out, 0);
    } else {
        mpfi_set(f->scratch, a);
        if (from_zero)
            mpfr_set(&f->scratch->left, &a->right, MPFR_RNDD);
        mpfi_log(f->scratch, f->scratch);
        mpfi_mul(f->scratch, f->scratch, b);
        mpfi_exp(out, f->scratch);
        if (from_zero)
            mpfr_set_zero(&out->left, 1);
    }
}

/* Angles are in degrees. */
static void turn(true_formula *f, csg_formula_op op, mpfi_ptr out, mpfi_srcptr a, mpfi_srcptr b)
{
    mpfi_mul(f->scratch, a, f->degree);
    switch (op) {
    case CSG_FORMULA_SIN:
        mpfi_sin(out, f->scratch);
        return;
    case CSG_FORMULA_COS:
        mpfi_cos(out, f->scratch);
        return;
    case CSG_FORMULA_TAN:
        mpfi_tan(out, f->scratch);
        return;
    case CSG_FORMULA_ASIN:
        mpfi_asin(out, a);
        break;
    case CSG_FORMULA_ACOS:
        mpfi_acos(out, a);
        break;
    case CSG_FORMULA_ATAN:
        mpfi_atan(out, a);
        break;
    default:
        mpfi_atan2(out, a, b);
        break;
    }
    mpfi_div(out, out, f->degree);
}

static void step(true_formula *f, uint32_t i)
{
    const csg_formula_step *s = &f->steps[i];
    mpfi_ptr out = f->values[i];
    mpfi_srcptr a = f->values[s->a], b = f->values[s->b];
    switch ((csg_formula_op)s->op) {
    case CSG_FORMULA_CONSTANT:
        mpfi_set_d(out, s->constant);
        break;
    case CSG_FORMULA_X:
    case CSG_FORMULA_Y:
    case CSG_FORMULA_Z:
        mpfi_set(out, f->at[s->op - CSG_FORMULA_X]);
        break;
    case CSG_FORMULA_NEG:
        mpfi_neg(out, a);
        break;
    case CSG_FORMULA_ABS:
        mpfi_abs(out, a);
        break;
    case CSG_FORMULA_SQRT:
        mpfi_sqrt(out, a);
        break;
    case CSG_FORMULA_EXP:
        mpfi_exp(out, a);
        break;
    case CSG_FORMULA_LN:
        mpfi_log(out, a);
        break;
    case CSG_FORMULA_FLOOR:
        mpfr_floor(&out->left, &a->left);
        mpfr_floor(&out->right, &a->right);
        break;
    case CSG_FORMULA_ADD:
        mpfi_add(out, a, b);
        break;
    case CSG_FORMULA_SUB:
        mpfi_sub(out, a, b);
        break;
    case CSG_FORMULA_MUL: /* u u is no product of strangers */
        s->a == s->b ? mpfi_sqr(out, a) : mpfi_mul(out, a, b);
        break;
    case CSG_FORMULA_DIV:
        mpfi_div(out, a, b);
        break;
    case CSG_FORMULA_MIN:
    case CSG_FORMULA_MAX:
        least_or_most(out, a, b, s->op == CSG_FORMULA_MIN);
        break;
    case CSG_FORMULA_POW:
        power(f, out, a, b);
        break;
    case CSG_FORMULA_MOD:
    case CSG_FORMULA_OP_COUNT:
        nothing_known(out);
        break;
    case CSG_FORMULA_SIN:
    case CSG_FORMULA_COS:
    case CSG_FORMULA_TAN:
    case CSG_FORMULA_ASIN:
    case CSG_FORMULA_ACOS:
    case CSG_FORMULA_ATAN:
    case CSG_FORMULA_ATAN2:
        turn(f, (csg_formula_op)s->op, out, a, b);
        break;
    }
}

mpfi_srcptr true_formula_run(true_formula *f)
{
    for (uint32_t i = 0; i < f->count; i++)
        step(f, i);
    return f->values[f->count - 1];
}
