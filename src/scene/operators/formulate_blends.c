/* SPDX-License-Identifier: MIT
 * Unions with blends (scene/operators/reference_blends.c) as formulas.
 */
#include "scene/formula/formulate.h"

#include <assert.h>

#include "scene/operators/blend_kinds.h"
#include "scene/operators/blends.h"

static csg_term largest(csg_terms *t, const csg_term *values, size_t count)
{
    csg_term most = values[0];
    for (size_t i = 1; i < count; i++)
        most = csg_term_max(t, most, values[i]);
    return most;
}

/* What a blend adds to the larger of two that differ by x. */
static csg_term excess(csg_terms *t, csg_blend blend, csg_term x)
{
    double n = blend.n, limit = csg_blend_support(blend);
    if (isfinite(limit))
        x = csg_term_min_number(t, x, limit);
    switch ((csg_blend_kind)blend.kind) {
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    case CSG_BLEND_##NAME:                                                                         \
        return name##_term(t, n, x);
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME: /* the larger one */                                                    \
        break;
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    case CSG_BLEND_##NAME: /* no binary blend */                                                   \
        break;
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        assert(!"a binary blend");
    }
    return CSG_FORMULA_NONE;
}

/* Of two, w - d / 2 - sqrt((w^2 - d^2 / 2) / 2), which is 0 where they differ by d = w. */
static csg_term round_pair(csg_terms *t, double w, const csg_term values[2])
{
    csg_term d = csg_term_abs(t, csg_term_sub(t, values[0], values[1]));
    d = csg_term_min_number(t, d, w);
    csg_term under =
        csg_term_number_sub(t, w * w / 2, csg_term_mul_number(t, csg_term_square(t, d), 0.25));
    csg_term root = csg_term_sqrt(t, under);
    csg_term excess =
        csg_term_sub(t, csg_term_number_sub(t, w, csg_term_mul_number(t, d, 0.5)), root);
    return csg_term_add(t, largest(t, values, 2), excess);
}

/* Of more, the root of a norm by so many steps of Newton's method, from the left. */
static csg_term round_all(csg_terms *t, double w, csg_term *values, size_t count)
{
    enum { STEPS = 8 };
    csg_term most = largest(t, values, count), at = csg_term_number(t, 0);
    for (size_t i = 0; i < count; i++)
        values[i] = csg_term_add_number(t, csg_term_sub(t, values[i], most), w);
    for (int step = 0; step < STEPS; step++) {
        csg_term squares = 0, sum = 0;
        for (size_t i = 0; i < count; i++) {
            csg_term over = csg_term_max_number(t, csg_term_sub(t, values[i], at), 0);
            csg_term square = csg_term_square(t, over);
            squares = i ? csg_term_add(t, squares, square) : square;
            sum = i ? csg_term_add(t, sum, over) : over;
        }
        csg_term norm = csg_term_sqrt(t, squares);
        csg_term more = csg_term_mul(t, csg_term_sub_number(t, norm, w), norm);
        at = csg_term_add(t, at, csg_term_div(t, more, sum));
    }
    return csg_term_add(t, most, at);
}

/* sqrt(a+^2 + b+^2), and the larger one where both are negative. */
static csg_term orthogonal(csg_terms *t, const csg_term values[2])
{
    csg_term both = csg_term_norm2(t, csg_term_max_number(t, values[0], 0),
                                   csg_term_max_number(t, values[1], 0));
    return csg_term_add(t, both, csg_term_min_number(t, largest(t, values, 2), 0));
}

csg_term csg_formulate_union(csg_terms *t, csg_blend blend, csg_term *values, size_t count)
{
    if (blend.kind == CSG_BLEND_ORTHOGONAL && count == 2)
        return orthogonal(t, values);
    if (count == 1 || blend.kind == CSG_BLEND_SHARP || !(blend.n > 0))
        return largest(t, values, count);
    if (blend.kind == CSG_BLEND_ROUND)
        return count == 2 ? round_pair(t, blend.n, values) : round_all(t, blend.n, values, count);
    csg_term x = csg_term_abs(t, csg_term_sub(t, values[0], values[1]));
    return csg_term_add(t, largest(t, values, 2), excess(t, blend, x));
}
