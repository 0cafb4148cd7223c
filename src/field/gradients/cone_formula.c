/* SPDX-License-Identifier: MIT
 * Forward differentiation in ranges: each step's value and its derivatives by x, y, z, from the
 * operations of functions.h, whose ranges include all rounding. A minimum has the gradient of one
 * of its operands, or where both are possible of either; u * u is no product of strangers.
 */
#include "field/gradients/cone_formula.h"

#include "field/kernels/functions.h"
#include "scene/formula/formula.h"

static const range ONE = {1, 1}, NOTHING = {0, 0}, UNKNOWN = {NAN, NAN};

static range scaled(range a, float by)
{
    return range_mul(a, (range){by, by});
}

/* 1 / a */
static range reciprocal(range a)
{
    return range_div(ONE, a);
}

static range hull(range a, range b)
{
    if (!is_known(a) || !is_known(b))
        return UNKNOWN;
    return (range){smaller(a.low, b.low), larger(a.high, b.high)};
}

/* 1 / (first + second), of squares. */
static range one_over_sum(range first, range second)
{
    return reciprocal(range_add(first, second));
}

static range slope_of_root(range radicand)
{
    return reciprocal(range_sqrt(radicand, radicand));
}

/* The derivative of what takes one operand; v its value. */
static range slope_of(uint8_t op, range a, range v)
{
    switch (op) {
    case CSG_FORMULA_NEG:
        return (range){-1, -1};
    case CSG_FORMULA_ABS:
        return (range){a.low <= 0 ? -1.0f : 1.0f, a.high >= 0 ? 1.0f : -1.0f};
    case CSG_FORMULA_SQRT:
        return v.low > 0 ? scaled(reciprocal(v), 0.5f) : UNKNOWN;
    case CSG_FORMULA_SIN:
        return range_cos(a, a);
    case CSG_FORMULA_COS:
        return range_neg(range_sin(a, a), a);
    case CSG_FORMULA_TAN:
        return range_add(ONE, range_square(v, v));
    case CSG_FORMULA_ASIN:
        return slope_of_root(range_mul(range_sub(ONE, a), range_add(ONE, a)));
    case CSG_FORMULA_ACOS:
        return range_neg(slope_of_root(range_mul(range_sub(ONE, a), range_add(ONE, a))), a);
    case CSG_FORMULA_ATAN:
        return one_over_sum(ONE, range_square(a, a));
    case CSG_FORMULA_EXP:
        return v;
    case CSG_FORMULA_LN:
        return reciprocal(a);
    case CSG_FORMULA_FLOOR: /* no jump where the value is one */
        return v.high - v.low < 0.5f ? NOTHING : UNKNOWN;
    default:
        return UNKNOWN;
    }
}

/* The derivatives of what takes two. */
static void slopes_of(uint8_t op, range a, range b, range v, range *by_a, range *by_b)
{
    range squares = range_add(range_square(a, a), range_square(b, b));
    *by_a = *by_b = UNKNOWN;
    switch (op) {
    case CSG_FORMULA_ADD:
        *by_a = *by_b = ONE;
        break;
    case CSG_FORMULA_SUB:
        *by_a = ONE;
        *by_b = (range){-1, -1};
        break;
    case CSG_FORMULA_MUL:
        *by_a = b;
        *by_b = a;
        break;
    case CSG_FORMULA_DIV:
        *by_a = reciprocal(b);
        *by_b = range_neg(range_div(v, b), b);
        break;
    case CSG_FORMULA_POW:
        *by_a = range_mul(b, range_pow(a, range_sub(b, ONE)));
        *by_b = a.low > 0 ? range_mul(v, range_ln(a, a)) : UNKNOWN;
        break;
    case CSG_FORMULA_ATAN2: /* but for the cut */
        if (b.low > 0 || a.low > 0 || a.high < 0) {
            *by_a = range_div(b, squares);
            *by_b = range_neg(range_div(a, squares), a);
        }
        break;
    case CSG_FORMULA_MOD:
        if (b.low == b.high && truncated(a.low / b.low) == truncated(a.high / b.low)) {
            float whole = truncated(a.low / b.low);
            *by_a = ONE;
            *by_b = (range){-whole, -whole};
        }
        break;
    default:
        break;
    }
}

static range value_of(uint8_t op, range a, range b)
{
    switch (op) {
#define CSG_FORMULA_OP(NAME, name, arity) VALUE_##arity(NAME, name)
#define VALUE_0(NAME, name)
#define VALUE_1(NAME, name)                                                                        \
    case CSG_FORMULA_##NAME:                                                                       \
        return range_##name(a, b);
#define VALUE_2(NAME, name) VALUE_1(NAME, name)
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
    default:
        return UNKNOWN;
    }
}

typedef struct dual {
    range value, gradient[3];
} dual;

static bool is_nothing(range a)
{
    return a.low == 0 && a.high == 0;
}

/* Of what does not change nothing is left, whatever it is multiplied by. */
static range times(range slope, range gradient)
{
    return is_nothing(gradient) || is_nothing(slope) ? NOTHING : range_mul(slope, gradient);
}

static range plus(range a, range b)
{
    return is_nothing(a) ? b : is_nothing(b) ? a : range_add(a, b);
}

/* The operand that counts, or either. */
static dual extreme(uint8_t op, const dual *a, const dual *b, bool *has_edges)
{
    bool is_least = op == CSG_FORMULA_MIN;
    dual out = {.value = value_of(op, a->value, b->value)};
    if (is_least ? a->value.high < b->value.low : a->value.low > b->value.high)
        return *a;
    if (is_least ? b->value.high < a->value.low : b->value.low > a->value.high)
        return *b;
    *has_edges = true;
    for (int k = 0; k < 3; k++)
        out.gradient[k] = hull(a->gradient[k], b->gradient[k]);
    return out;
}

static dual run_step(const csg_tape_step *step, const dual *a, const dual *b, bool *has_edges)
{
    range by_a, by_b = NOTHING;
    if (step->op == CSG_FORMULA_MIN || step->op == CSG_FORMULA_MAX)
        return extreme(step->op, a, b, has_edges);
    bool is_square = step->op == CSG_FORMULA_MUL && a == b;
    dual out = {.value = is_square ? range_square(a->value, a->value)
                                   : value_of(step->op, a->value, b->value)};
    if (is_square)
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
                      const csg_cone_box seeds[3], csg_cone_box *gradient, bool *has_edges)
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
        slots[step->out] = run_step(step, a, b, has_edges);
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
