/* SPDX-License-Identifier: MIT
 * Forward differentiation in ranges, twice; see bend_formula.h. Of f(u, v) the second derivatives
 * are f_u u" + f_v v" + f_uu u' u' + f_uv (u' v' + v' u') + f_vv v' v'. Operations that are no
 * products, sums or functions of one operand are known where an operand does not change.
 */
#include "field/gradients/bend_formula.h"

#include <math.h>

#include "field/gradients/formula_slopes.h"

enum { SECONDS = 6 /* xx, yy, zz, xy, xz, yz */ };

static const unsigned char FIRST[SECONDS] = {0, 1, 2, 0, 0, 1},
                           SECOND[SECONDS] = {0, 1, 2, 1, 2, 2};

typedef struct jet {
    range value, first[3], second[SECONDS];
} jet;

static bool is_constant(const jet *a)
{
    return is_nothing(a->first[0]) && is_nothing(a->first[1]) && is_nothing(a->first[2]);
}

/* The second derivative of what takes one operand, but for a kink; v its value, by the slope. */
static range bend_of(uint8_t op, range a, range v, range by)
{
    switch (op) {
    case CSG_FORMULA_NEG:
    case CSG_FORMULA_ABS:
        return NOTHING;
    case CSG_FORMULA_SIN:
    case CSG_FORMULA_COS:
        return range_neg(v, v);
    case CSG_FORMULA_SQRT: /* by = 1 / (2 v) */
        return range_neg(range_mul(range_square(by, by), reciprocal(v)), a);
    case CSG_FORMULA_EXP:
        return v;
    case CSG_FORMULA_LN:
        return range_neg(range_square(by, by), a);
    default:
        return UNKNOWN;
    }
}

/* (a b)' and so on: p q + q p for a place of the matrix; p p where they are one. */
static range product_at(const range *p, const range *q, int place)
{
    int i = FIRST[place], k = SECOND[place];
    if (p == q)
        return i == k ? (is_nothing(p[i]) ? NOTHING : range_square(p[i], p[i])) : times(p[i], p[k]);
    return plus(times(p[i], q[k]), times(q[i], p[k]));
}

static jet bend_one(const jet *a, range by, range twice, range value)
{
    jet out = {.value = value};
    for (int k = 0; k < 3; k++)
        out.first[k] = times(by, a->first[k]);
    for (int k = 0; k < SECONDS; k++)
        out.second[k] =
            plus(times(by, a->second[k]), times(twice, product_at(a->first, a->first, k)));
    return out;
}

/* Sums, and products, whose mixed derivative is 1. */
static jet bend_two(uint8_t op, const jet *a, const jet *b, range value)
{
    jet out = {.value = value};
    range by_a, by_b;
    slopes_of(op, a->value, b->value, value, &by_a, &by_b);
    for (int k = 0; k < 3; k++)
        out.first[k] = plus(times(by_a, a->first[k]), times(by_b, b->first[k]));
    for (int k = 0; k < SECONDS; k++) {
        out.second[k] = plus(times(by_a, a->second[k]), times(by_b, b->second[k]));
        if (op == CSG_FORMULA_MUL)
            out.second[k] = plus(out.second[k], product_at(a->first, b->first, k));
    }
    return out;
}

static range either(range a, range b)
{
    return is_known(a) && is_known(b) ? (range){fminf(a.low, b.low), fmaxf(a.high, b.high)}
                                      : UNKNOWN;
}

/* The operand that counts all over the box, or what holds both. */
static jet extreme_of(uint8_t op, const jet *a, const jet *b, range value)
{
    bool is_a = op == CSG_FORMULA_MIN ? a->value.high < b->value.low : a->value.low > b->value.high;
    bool is_b = op == CSG_FORMULA_MIN ? b->value.high < a->value.low : b->value.low > a->value.high;
    if (is_a || is_b)
        return is_a ? *a : *b;
    jet out = {.value = value};
    for (int k = 0; k < 3; k++)
        out.first[k] = either(a->first[k], b->first[k]);
    for (int k = 0; k < SECONDS; k++)
        out.second[k] = either(a->second[k], b->second[k]);
    return out;
}

/* False: nothing is known. */
static bool run_step(const csg_tape_step *step, const jet *a, const jet *b, jet *out)
{
    range by_a, by_b,
        value = a == b && step->op == CSG_FORMULA_MUL ? range_square(a->value, a->value)
                                                      : value_of(step->op, a->value, b->value);
    if (step->op == CSG_FORMULA_MIN || step->op == CSG_FORMULA_MAX) {
        *out = extreme_of(step->op, a, b, value);
    } else if (csg_formula_op_is_unary(step->op) && is_constant(a)) {
        *out = (jet){.value = value};
    } else if (csg_formula_op_is_unary(step->op)) {
        by_a = slope_of(step->op, a->value, value);
        *out = bend_one(a, by_a, bend_of(step->op, a->value, value, by_a), value);
    } else if (is_constant(a) && is_constant(b)) {
        *out = (jet){.value = value};
    } else if (a == b && step->op == CSG_FORMULA_MUL) {
        *out = bend_one(a, scaled(a->value, 2), (range){2, 2}, value);
    } else if (step->op == CSG_FORMULA_ADD || step->op == CSG_FORMULA_SUB ||
               step->op == CSG_FORMULA_MUL) {
        *out = bend_two(step->op, a, b, value);
    } else if (step->op == CSG_FORMULA_DIV && is_constant(b)) {
        slopes_of(step->op, a->value, b->value, value, &by_a, &by_b);
        *out = bend_one(a, by_a, NOTHING, value);
    } else {
        return false;
    }
    return is_known(value);
}

/* Of a symmetric matrix whose places are in these ranges: its rows' largest sum, or the root of the
 * sum of squares. */
static double norm_of_matrix(const range second[SECONDS])
{
    double size[SECONDS], squares = 0;
    for (int k = 0; k < SECONDS; k++) {
        size[k] = fmax(fabs((double)second[k].low), fabs((double)second[k].high));
        squares += (k < 3 ? 1 : 2) * size[k] * size[k];
    }
    double rows = fmax(size[0] + size[3] + size[4],
                       fmax(size[1] + size[3] + size[5], size[2] + size[4] + size[5]));
    return fmin(rows, sqrt(squares)) * (1 + 1e-12);
}

/* Whether some operand may take another's place, or change its sign where that counts: told by
 * values alone, at a tenth of what second derivatives cost. */
static bool may_change_sides(const csg_tape *tape, const csg_tape_formula *formula,
                             const csg_cone_box *at)
{
    range slots[CSG_FORMULA_SLOTS];
    for (int i = 0; i < 3; i++)
        slots[i] = (range){at->low[i], at->high[i]};
    for (uint32_t s = 0; s < formula->count; s++) {
        const csg_tape_step *step = &tape->steps[formula->first + s];
        const range constant = {step->value, step->value};
        range a = step->constant == CSG_CONSTANT_A ? constant : slots[step->a];
        range b = step->constant == CSG_CONSTANT_B ? constant : slots[step->b];
        bool is_choice = step->op == CSG_FORMULA_MIN || step->op == CSG_FORMULA_MAX;
        if ((is_choice && a.low <= b.high && b.low <= a.high) ||
            (step->op == CSG_FORMULA_ABS && a.low <= 0 && a.high >= 0))
            return true;
        bool is_square = step->op == CSG_FORMULA_MUL && step->a == step->b && !step->constant;
        slots[step->out] = is_square ? range_square(a, a) : value_of(step->op, a, b);
    }
    return false;
}

static double size_of(range a)
{
    return fmax(fabs((double)a.low), fabs((double)a.high));
}

/* Notes a kink at the step. False: there are too many. */
static bool note_kink(const csg_tape_step *step, uint32_t at, const jet *a, const jet *b,
                      csg_formula_pieces *out)
{
    static const jet ZERO = {.value = {0, 0}};
    const jet *other = step->op == CSG_FORMULA_ABS ? &ZERO : b;
    bool is_choice = step->op == CSG_FORMULA_MIN || step->op == CSG_FORMULA_MAX;
    if (!(is_choice || step->op == CSG_FORMULA_ABS) || a->value.low > other->value.high ||
        other->value.low > a->value.high)
        return true;
    if (out->kink_count == CSG_MOST_KINKS)
        return false;
    double squares = 0;
    for (int k = 0; k < 3; k++) {
        range apart = range_sub(a->first[k], other->first[k]);
        squares += size_of(apart) * size_of(apart);
    }
    out->kinks[out->kink_count++] =
        (csg_kink){at, sqrt(squares) * (1 + 1e-12), fmax(size_of(a->value), size_of(other->value))};
    return true;
}

bool csg_bend_pieces(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                     csg_formula_pieces *out)
{
    jet slots[CSG_FORMULA_SLOTS], constant = {.value = NOTHING};
    out->kink_count = 0;
    for (int i = 0; i < 3; i++) {
        slots[i] = (jet){.value = {at->low[i], at->high[i]}};
        slots[i].first[i] = ONE;
    }
    for (uint32_t s = 0; s < formula->count; s++) {
        const csg_tape_step *step = &tape->steps[formula->first + s];
        const jet *a = &slots[step->a], *b = &slots[step->b];
        constant.value = (range){step->value, step->value};
        if (step->constant == CSG_CONSTANT_A)
            a = &constant;
        else if (step->constant == CSG_CONSTANT_B)
            b = &constant;
        if (!note_kink(step, s, a, b, out) || !run_step(step, a, b, &slots[step->out]))
            return false;
    }
    const jet *result = &slots[formula->result];
    for (int k = 0; k < SECONDS; k++)
        if (!is_known(result->second[k]))
            return false;
    out->bend = norm_of_matrix(result->second);
    return out->bend < 1e9;
}

bool csg_bend_formula(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                      double *bend)
{
    csg_formula_pieces pieces;
    if (may_change_sides(tape, formula, at) || !csg_bend_pieces(tape, formula, at, &pieces))
        return false;
    *bend = pieces.bend;
    return true;
}
