/* SPDX-License-Identifier: MIT
 * See random_formula.h.
 */
#include "scene/random_formula.h"

#include <assert.h>

#include "scene/formula/formula.h"

typedef struct maker {
    csg_formula_builder builder;
    csg_random *random;
} maker;

static csg_formula_id number(maker *m, double low, double high)
{
    return csg_formula_constant(&m->builder, csg_random_uniform(m->random, low, high));
}

static csg_formula_id apply(maker *m, csg_formula_op op, csg_formula_id a, csg_formula_id b)
{
    return csg_formula_apply(&m->builder, op, a, b);
}

/* u^2 + something > 0 */
static csg_formula_id positive(maker *m, csg_formula_id u)
{
    csg_formula_id square = apply(m, CSG_FORMULA_MUL, u, u);
    return apply(m, CSG_FORMULA_ADD, square, number(m, 0.2, 1));
}

/* c sin(90 u), |c| < 1 */
static csg_formula_id wave(maker *m, csg_formula_id u)
{
    csg_formula_id angle = apply(m, CSG_FORMULA_MUL, u, number(m, 30, 90));
    return apply(m, CSG_FORMULA_MUL, apply(m, CSG_FORMULA_SIN, angle, 0), number(m, 0.2, 0.9));
}

static csg_formula_id unary(maker *m, csg_formula_op op, csg_formula_id u)
{
    switch (op) {
    case CSG_FORMULA_SQRT:
    case CSG_FORMULA_LN:
        return apply(m, op, positive(m, u), 0);
    case CSG_FORMULA_SIN:
    case CSG_FORMULA_COS:
        return apply(m, op, apply(m, CSG_FORMULA_MUL, u, number(m, 20, 120)), 0);
    case CSG_FORMULA_TAN:
        return apply(m, op, apply(m, CSG_FORMULA_MUL, wave(m, u), number(m, 20, 60)), 0);
    case CSG_FORMULA_ASIN:
    case CSG_FORMULA_ACOS:
        u = apply(m, op, wave(m, u), 0);
        return apply(m, CSG_FORMULA_MUL, u, number(m, 0.005, 0.02));
    case CSG_FORMULA_ATAN:
        return apply(m, CSG_FORMULA_MUL, apply(m, op, u, 0), number(m, 0.005, 0.02));
    case CSG_FORMULA_EXP:
        return apply(m, op, apply(m, CSG_FORMULA_MIN, u, number(m, 0, 1)), 0);
    default: /* NEG, ABS, FLOOR */
        return apply(m, op, u, 0);
    }
}

static csg_formula_id binary(maker *m, csg_formula_op op, csg_formula_id a, csg_formula_id b)
{
    switch (op) {
    case CSG_FORMULA_MUL:
        return apply(m, op, wave(m, a), b);
    case CSG_FORMULA_DIV:
        return apply(m, op, a, positive(m, b));
    case CSG_FORMULA_POW:
        return apply(m, op, positive(m, wave(m, a)),
                     csg_random_below(m->random, 2) ? wave(m, b) : number(m, -2, 3));
    case CSG_FORMULA_ATAN2:
        a = apply(m, op, a, positive(m, b));
        return apply(m, CSG_FORMULA_MUL, a, number(m, 0.005, 0.02));
    case CSG_FORMULA_MOD:
        return apply(m, op, a, number(m, 0.3, 2));
    default: /* ADD, SUB, MIN, MAX */
        return apply(m, op, a, b);
    }
}

uint32_t test_random_formula(csg_memory *memory, csg_random *random, unsigned size, bool continuous,
                             csg_formula_step *out)
{
    enum { MOST = 64 };
    csg_formula_id made[MOST];
    unsigned count = 0;
    maker m = {.random = random};
    csg_formula_begin(&m.builder, memory);
    for (; count < 3; count++)
        made[count] = apply(&m, CSG_FORMULA_X + count, 0, 0);
    for (unsigned i = 0; i < size && count < MOST; i++) {
        csg_formula_op op =
            CSG_FORMULA_NEG + csg_random_below(random, CSG_FORMULA_OP_COUNT - CSG_FORMULA_NEG);
        if (continuous && (op == CSG_FORMULA_FLOOR || op == CSG_FORMULA_MOD))
            op = CSG_FORMULA_SIN;
        csg_formula_id a = made[csg_random_below(random, count)];
        csg_formula_id b = made[count - 1 - csg_random_below(random, count < 4 ? count : 4)];
        made[count++] = csg_formula_op_arity(op) > 1 ? binary(&m, op, a, b) : unary(&m, op, b);
    }
    assert(made[count - 1] != CSG_FORMULA_NONE && m.builder.count <= TEST_MOST_STEPS);
    uint32_t steps = csg_formula_collect(&m.builder, made[count - 1], out);
    csg_formula_end(&m.builder);
    return steps;
}
