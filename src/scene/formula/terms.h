/* SPDX-License-Identifier: MIT
 * Arithmetic on formula steps, for code that builds long formulas: a failure (memory, too long)
 * makes every later term NONE.
 */
#ifndef CSG_SCENE_TERMS_H
#define CSG_SCENE_TERMS_H

#include "scene/formula/formula.h"

/* Steepness of csg_term_step: a jump for all that lengths can show. */
#define CSG_STEP_SLOPE 1e15

static inline csg_term csg_term_number(csg_terms *t, double value)
{
    return csg_formula_constant(t, value);
}
static inline csg_term csg_term_of(csg_terms *t, csg_formula_op op, csg_term a, csg_term b)
{
    bool none = a == CSG_FORMULA_NONE || b == CSG_FORMULA_NONE;
    return none ? CSG_FORMULA_NONE : csg_formula_apply(t, op, a, b);
}

#define CSG_TERM_UNARY(name, OP)                                                                   \
    static inline csg_term csg_term_##name(csg_terms *t, csg_term a)                               \
    {                                                                                              \
        return csg_term_of(t, CSG_FORMULA_##OP, a, a);                                             \
    }
#define CSG_TERM_BINARY(name, OP)                                                                  \
    static inline csg_term csg_term_##name(csg_terms *t, csg_term a, csg_term b)                   \
    {                                                                                              \
        return csg_term_of(t, CSG_FORMULA_##OP, a, b);                                             \
    }                                                                                              \
    static inline csg_term csg_term_##name##_number(csg_terms *t, csg_term a, double number)       \
    {                                                                                              \
        return csg_term_of(t, CSG_FORMULA_##OP, a, csg_term_number(t, number));                    \
    }
CSG_TERM_UNARY(neg, NEG)
CSG_TERM_UNARY(abs, ABS)
CSG_TERM_UNARY(sqrt, SQRT)
CSG_TERM_UNARY(sin, SIN)
CSG_TERM_UNARY(cos, COS)
CSG_TERM_UNARY(floor, FLOOR)
CSG_TERM_BINARY(add, ADD)
CSG_TERM_BINARY(sub, SUB)
CSG_TERM_BINARY(mul, MUL)
CSG_TERM_BINARY(div, DIV)
CSG_TERM_BINARY(min, MIN)
CSG_TERM_BINARY(max, MAX)
CSG_TERM_BINARY(atan2, ATAN2)
CSG_TERM_BINARY(pow, POW)
#undef CSG_TERM_UNARY
#undef CSG_TERM_BINARY

/* number - a */
static inline csg_term csg_term_number_sub(csg_terms *t, double number, csg_term a)
{
    return csg_term_sub(t, csg_term_number(t, number), a);
}
static inline csg_term csg_term_square(csg_terms *t, csg_term a)
{
    return csg_term_mul(t, a, a);
}
static inline csg_term csg_term_norm2(csg_terms *t, csg_term a, csg_term b)
{
    return csg_term_sqrt(t, csg_term_add(t, csg_term_square(t, a), csg_term_square(t, b)));
}
static inline csg_term csg_term_norm3(csg_terms *t, csg_term a, csg_term b, csg_term c)
{
    csg_term two = csg_term_add(t, csg_term_square(t, a), csg_term_square(t, b));
    return csg_term_sqrt(t, csg_term_add(t, two, csg_term_square(t, c)));
}
static inline csg_term csg_term_clamp(csg_terms *t, csg_term a, double low, double high)
{
    return csg_term_min_number(t, csg_term_max_number(t, a, low), high);
}
/* 0 where a <= 0, 1 where a > 0 by more than nothing. */
static inline csg_term csg_term_step(csg_terms *t, csg_term a)
{
    return csg_term_clamp(t, csg_term_mul_number(t, a, CSG_STEP_SLOPE), 0, 1);
}
/* a + share (b - a) */
static inline csg_term csg_term_mix(csg_terms *t, csg_term a, csg_term b, csg_term share)
{
    return csg_term_add(t, a, csg_term_mul(t, share, csg_term_sub(t, b, a)));
}

#endif
