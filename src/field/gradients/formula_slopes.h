/* SPDX-License-Identifier: MIT
 * Derivatives of a formula's operations in ranges, from the operations of functions.h, whose ranges
 * include all rounding: for who differentiates formulas once (cone_formula.c) or twice
 * (bend_formula.c).
 */
#ifndef CSG_FIELD_FORMULA_SLOPES_H
#define CSG_FIELD_FORMULA_SLOPES_H

#include <stdbool.h>

#include "field/kernels/functions.h"
#include "scene/formula/formula.h"

static const range ONE = {1, 1}, NOTHING = {0, 0}, UNKNOWN = {NAN, NAN};

static inline range scaled(range a, float by)
{
    return range_mul(a, (range){by, by});
}

/* 1 / a */
static inline range reciprocal(range a)
{
    return range_div(ONE, a);
}

/* 1 / (first + second), of squares. */
static inline range one_over_sum(range first, range second)
{
    return reciprocal(range_add(first, second));
}

static inline range slope_of_root(range radicand)
{
    return reciprocal(range_sqrt(radicand, radicand));
}

/* The derivative of what takes one operand; v its value. */
static inline range slope_of(uint8_t op, range a, range v)
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
static inline void slopes_of(uint8_t op, range a, range b, range v, range *by_a, range *by_b)
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

static inline range value_of(uint8_t op, range a, range b)
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

static inline bool is_nothing(range a)
{
    return a.low == 0 && a.high == 0;
}

/* Of what does not change nothing is left, whatever it is multiplied by. */
static inline range times(range slope, range gradient)
{
    return is_nothing(gradient) || is_nothing(slope) ? NOTHING : range_mul(slope, gradient);
}

static inline range plus(range a, range b)
{
    return is_nothing(a) ? b : is_nothing(b) ? a : range_add(a, b);
}

#endif
