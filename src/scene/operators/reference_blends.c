/* SPDX-License-Identifier: MIT
 * Binary blends (their functions: blends.h) and the n-ary round union in double precision
 * (operators.md 2.1, 2.2, 12). Operands outside the support leave the largest operand as it is, bit
 * for bit.
 */
#include "scene/operators/blend_kinds.h"
#include "scene/reference.h"

#include <assert.h>

#include "scene/operators/blends.h"
#include "scene/operators/choice.h"

void csg_reference_blend_function(csg_blend blend, double x, double *value, double *derivative)
{
    csg_blended made = {0, 0};
    bool blends = x < csg_blend_support(blend); /* not where it is NaN */
    switch ((csg_blend_kind)blend.kind) {
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    case CSG_BLEND_##NAME:                                                                         \
        made = blends ? name##_double(blend.n, x) : made;                                          \
        break;
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
    *value = made.value;
    *derivative = made.slope;
}

static double fold_union(csg_blend blend, const double *values, double *partials)
{
    size_t hi = csg_largest_of(values, 2), lo = 1 - hi;
    double x = values[hi] - values[lo], value, derivative;
    csg_reference_blend_function(blend, x, &value, &derivative);
    if (value == 0 && derivative == 0)
        return csg_choose(values, 2, hi, partials);
    partials[hi] = 1 + derivative;
    partials[lo] = -derivative;
    return values[hi] + value;
}

/* With x_i = w + f_i - max f, the active operands (x_i > t) satisfy sum (x_i - t)^2 = w^2, and
 * G = max f + t. Newton's method on the norm of the positive parts, convex and decreasing, runs up
 * to the root from the left; the last active set is then solved in closed form. */
typedef struct active_sums {
    double count, mean, deviations; /* sum of squared deviations from the mean */
} active_sums;

static active_sums sum_active(const double *values, size_t count, double max, double w, double t)
{
    active_sums s = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        double x = w + (values[i] - max);
        if (!(x > t))
            continue;
        s.count += 1; /* Welford's update */
        double d = x - s.mean;
        s.mean += d / s.count;
        s.deviations += d * (x - s.mean);
    }
    return s;
}

static double solve_round(const double *values, size_t count, double max, double w)
{
    double t = 0;
    for (int i = 0; i < 100; i++) {
        active_sums s = sum_active(values, count, max, w, t);
        double square = s.deviations + s.count * (s.mean - t) * (s.mean - t);
        double norm = sqrt(square), next = t + (norm - w) * norm / (s.count * (s.mean - t));
        if (!(next > t) || next >= w)
            break;
        t = next;
    }
    active_sums s = sum_active(values, count, max, w, t);
    double exact = s.mean - sqrt(fmax(w * w - s.deviations, 0) / s.count);
    return fmin(fmax(exact, 0), w);
}

static double round_union(double w, const double *values, size_t count, double *partials)
{
    size_t top = csg_largest_of(values, count), active = 0;
    double max = values[top];
    for (size_t i = 0; i < count; i++)
        active += w + (values[i] - max) > 0;
    if (active < 2)
        return csg_choose(values, count, top, partials);
    double t = solve_round(values, count, max, w), total = 0;
    for (size_t i = 0; i < count; i++)
        total += partials[i] = fmax(w + (values[i] - max) - t, 0);
    for (size_t i = 0; i < count; i++)
        partials[i] /= total;
    return max + t;
}

/* The union of solids whose complements meet at right angles (scene.h). */
static double orthogonal_union(const double *values, double *partials)
{
    double a = values[0], b = values[1], both = sqrt(a * a + b * b);
    if (!(a > 0 && b > 0))
        return csg_choose(values, 2, csg_largest_of(values, 2), partials);
    partials[0] = a / both;
    partials[1] = b / both;
    return both;
}

double csg_reference_union(csg_blend blend, const double *values, size_t count, double *partials)
{
    assert(count > 0);
    size_t top = csg_largest_of(values, count);
    if (blend.kind == CSG_BLEND_ORTHOGONAL && count == 2)
        return orthogonal_union(values, partials);
    if (count == 1 || blend.kind == CSG_BLEND_SHARP || !(blend.n > 0) || isinf(values[top]))
        return csg_choose(values, count, top, partials);
    assert(!csg_blend_is_fillet(blend.kind)); /* values do not say it: csg_reference_node */
    if (blend.kind == CSG_BLEND_ROUND)
        return round_union(blend.n, values, count, partials);
    assert(count == 2);
    return fold_union(blend, values, partials);
}
