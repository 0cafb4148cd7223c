/* SPDX-License-Identifier: MIT
 * Forward differentiation in ranges: each step's value and its derivatives by x, y, z, from the
 * operations of functions.h, whose ranges include all rounding. A minimum has the gradient of one
 * of its operands, or where both are possible of either; u * u is no product of strangers.
 */
#include "field/gradients/cone_formula.h"

#include "field/gradients/formula_slopes.h"

static range hull(range a, range b)
{
    if (!is_known(a) || !is_known(b))
        return UNKNOWN;
    return (range){smaller(a.low, b.low), larger(a.high, b.high)};
}

typedef struct dual {
    range value, gradient[3];
} dual;

/* The operand that counts, or either. */
static dual extreme(uint8_t op, const dual *a, const dual *b, range value, bool *has_edges)
{
    bool is_least = op == CSG_FORMULA_MIN;
    dual out = {.value = value};
    if (is_least ? a->value.high < b->value.low : a->value.low > b->value.high)
        return *a;
    if (is_least ? b->value.high < a->value.low : b->value.low > a->value.high)
        return *b;
    *has_edges = true;
    for (int k = 0; k < 3; k++)
        out.gradient[k] = hull(a->gradient[k], b->gradient[k]);
    return out;
}

static bool is_square(const csg_tape_step *step, const dual *a, const dual *b)
{
    return step->op == CSG_FORMULA_MUL && a == b;
}

static range value_at(const csg_tape_step *step, const dual *a, const dual *b)
{
    return is_square(step, a, b) ? range_square(a->value, a->value)
                                 : value_of(step->op, a->value, b->value);
}

static dual run_step(const csg_tape_step *step, const dual *a, const dual *b, range value,
                     bool *has_edges)
{
    range by_a, by_b = NOTHING;
    if (step->op == CSG_FORMULA_MIN || step->op == CSG_FORMULA_MAX)
        return extreme(step->op, a, b, value, has_edges);
    dual out = {.value = value};
    if (is_square(step, a, b))
        by_a = scaled(a->value, 2);
    else if (csg_formula_op_is_unary(step->op))
        by_a = slope_of(step->op, a->value, out.value);
    else
        slopes_of(step->op, a->value, b->value, out.value, &by_a, &by_b);
    *has_edges |= step->op == CSG_FORMULA_ABS && by_a.low < by_a.high;
    for (int k = 0; k < 3; k++)
        out.gradient[k] = plus(times(by_a, a->gradient[k]), times(by_b, b->gradient[k]));
    return out;
}

bool csg_cone_formula(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                      const csg_cone_box seeds[3], const struct range *values,
                      csg_cone_box *gradient, bool *has_edges)
{
    dual slots[CSG_FORMULA_SLOTS], constant = {.value = NOTHING};
    for (int i = 0; i < 3; i++) {
        slots[i] = (dual){.value = {at->low[i], at->high[i]}};
        for (int k = 0; k < 3; k++)
            slots[i].gradient[k] = (range){seeds[i].low[k], seeds[i].high[k]};
    }
    for (uint32_t s = 0; s < formula->count; s++) {
        const csg_tape_step *step = &tape->steps[formula->first + s];
        const dual *a = &slots[step->a], *b = &slots[step->b];
        constant.value = (range){step->value, step->value};
        if (step->constant == CSG_CONSTANT_A)
            a = &constant;
        else if (step->constant == CSG_CONSTANT_B)
            b = &constant;
        range value = values ? values[s] : value_at(step, a, b);
        slots[step->out] = run_step(step, a, b, value, has_edges);
    }
    const dual *result = &slots[formula->result];
    bool known = is_known(result->value) != 0;
    for (int k = 0; k < 3; k++) {
        gradient->low[k] = result->gradient[k].low;
        gradient->high[k] = result->gradient[k].high;
        known = known && is_known(result->gradient[k]) && result->gradient[k].low > -1e9f &&
                result->gradient[k].high < 1e9f;
    }
    return known;
}
