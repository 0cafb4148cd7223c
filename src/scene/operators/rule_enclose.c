/* SPDX-License-Identifier: MIT
 * What a rule's value can be for operands between bounds: the corners where it is monotone, else
 * the enclosures of operators.md 7.2, 7.3, 5.5 and 6.7.
 */
#include <math.h>

#include "base/elementary.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/rule_private.h"

/* A sigmoid's tails make its exterior blend differ from a local one by less than this part of
 * delta, in value and against monotony (alpha delta / eps >= 10). */
#define SIGMOID_TAIL 1e-7

/* Range of the larger operand's lead where the first is the larger (right) or the second. False:
 * it cannot be. */
static bool lead_range(const double *low, const double *high, bool right, double *least,
                       double *most)
{
    int hi = !right, lo = right;
    *most = high[hi] - low[lo];
    *least = fmax(low[hi] - high[lo], 0);
    return *most >= 0;
}

/* ---- EXTERIOR ---------------------------------------------------------------------------------
 */

/* The largest excess at leads beyond delta, a bump with one peak. */
static double largest_bump(const csg_rule *rule, bool right, double least, double most)
{
    double delta = rule->parameters[0], eps = rule->parameters[1], slope;
    double from = fmax(least, delta), to = fmin(most, csg_rule_support(rule));
    if (!(from < to))
        return 0;
    double peak = delta + eps * rule->facts.bump_at[!right];
    double best = fmax(csg_rule_exterior_excess(rule, right, from, &slope),
                       csg_rule_exterior_excess(rule, right, to, &slope));
    if (from < peak && peak < to)
        best = fmax(best, csg_rule_exterior_excess(rule, right, peak, &slope));
    return fmax(best, 0);
}

/* Monotone: the larger operand plus the excess of leads below delta. */
static double monotone_part(const csg_rule *rule, double x, double y)
{
    double t = fabs(x - y), slope;
    double excess = t < rule->parameters[0] ? csg_rule_exterior_excess(rule, x >= y, t, &slope) : 0;
    return fmax(x, y) + excess;
}

/* Of the excess nothing is known but its largest value and how fast it changes. */
static void enclose_wide(const csg_rule *rule, const double *low, const double *high, double out[2])
{
    double support = csg_rule_support(rule), lowest = INFINITY, highest = 0, slope;
    double steepest = (rule->k[0] + 1) / 2, limit = rule->parameters[0] * rule->most_excess;
    for (int right = 0; right < 2; right++) {
        double least, most;
        if (!lead_range(low, high, right, &least, &most))
            continue;
        double from = fmin(least, support), to = fmin(most, support);
        double one = csg_rule_exterior_excess(rule, right, from, &slope);
        double other = csg_rule_exterior_excess(rule, right, to, &slope);
        double between = steepest * (to - from) / 2;
        lowest = fmin(lowest, fmin(one, other) - between);
        highest = fmax(highest, fmax(one, other) + between);
    }
    out[0] = fmax(low[0], low[1]) + (isfinite(lowest) ? fmax(lowest, 0) : 0);
    out[1] = fmax(high[0], high[1]) + fmin(highest, limit);
}

static void enclose_exterior(const csg_rule *rule, const double *low, const double *high,
                             double out[2])
{
    if (csg_rule_is_wide(rule)) {
        enclose_wide(rule, low, high, out);
        return;
    }
    double bump = 0, excess = 0, slope, delta = rule->parameters[0];
    for (int right = 0; right < 2; right++) {
        double least, most;
        if (!lead_range(low, high, right, &least, &most))
            continue;
        bump = fmax(bump, largest_bump(rule, right, least, most));
        if (least < delta)
            excess = fmax(excess, csg_rule_exterior_excess(rule, right, least, &slope));
    }
    double slack = rule->step.kind == CSG_STEP_SIGMOID ? SIGMOID_TAIL * delta : 0;
    out[0] = monotone_part(rule, low[0], low[1]) - slack;
    out[1] = fmin(monotone_part(rule, high[0], high[1]) + bump,
                  fmax(high[0], high[1]) + fmax(excess, bump)) +
             slack;
}

/* ---- INTERIOR ---------------------------------------------------------------------------------
 */

static void enclose_interior(const csg_rule *rule, const double *low, const double *high,
                             double out[2])
{
    double deepest = 0, flattest = INFINITY, slope;
    for (int right = 0; right < 2; right++) {
        double least, most, peak = rule->parameters[0] * rule->facts.dent_at[right];
        if (!lead_range(low, high, right, &least, &most))
            continue;
        bool local = isfinite(most) && most < csg_rule_support(rule);
        double at_least = isfinite(least) ? csg_rule_interior_dent(rule, right, least, &slope) : 0;
        double at_most = local ? csg_rule_interior_dent(rule, right, most, &slope) : 0;
        deepest = fmax(deepest, fmax(at_least, at_most));
        flattest = fmin(flattest, fmin(at_least, at_most));
        if (least < peak && peak < most)
            deepest = fmax(deepest, csg_rule_interior_dent(rule, right, peak, &slope));
    }
    out[0] = fmax(fmax(low[0], low[1]) - deepest, fmin(low[0], low[1]));
    out[1] = fmax(high[0], high[1]) - (isfinite(flattest) ? flattest : 0);
}

/* ---- fields -----------------------------------------------------------------------------------
 */

/* The spline's range between two angles: its ends, knots, and where its slope is 0. */
static void factor_range(const csg_spline *s, double from, double to, double out[2])
{
    double slope, first = csg_spline_at(s, from, &slope), last = csg_spline_at(s, to, &slope);
    out[0] = fmin(first, last);
    out[1] = fmax(first, last);
    for (uint32_t i = 0; i + 1 < s->count; i++) {
        double h = s->angle[i + 1] - s->angle[i], step = (s->factor[i + 1] - s->factor[i]) / h;
        double m0 = s->slope[i], m1 = s->slope[i + 1];
        /* slope(t) = m0 + t (6 step - 4 m0 - 2 m1) + t^2 (3 m0 + 3 m1 - 6 step) */
        double b = 6 * step - 4 * m0 - 2 * m1, a = 3 * m0 + 3 * m1 - 6 * step;
        double root = sqrt(fmax(b * b - 4 * a * m0, 0)), q = -(b + (b < 0 ? -root : root)) / 2;
        const double at[3] = {0, a != 0 ? q / a : 0, q != 0 ? m0 / q : 0};
        for (int k = 0; k < 3; k++) {
            double angle = s->angle[i] + fmin(fmax(at[k], 0), 1) * h;
            if (angle < from || angle > to)
                continue;
            double factor = csg_spline_at(s, angle, &slope);
            out[0] = fmin(out[0], factor);
            out[1] = fmax(out[1], factor);
        }
    }
}

static void enclose_angles(const csg_rule *rule, bool is_union, const double *low,
                           const double *high, double out[2])
{
    double partials[2], factors[2];
    factor_range(&rule->spline, csg_atan2(low[1], high[0]), csg_atan2(high[1], low[0]), factors);
    out[0] = factors[0] * csg_plain_arc(rule, is_union, low, partials);
    out[1] = factors[1] * csg_plain_arc(rule, is_union, high, partials);
}

/* The function falls with the turn and rises with what it is normalised by. */
static void enclose_turns(const csg_rule *rule, bool is_union, const double *low,
                          const double *high, const double cosines[2], double out[2])
{
    double debulge = rule->parameters[3], partials[2];
    double least = 1 - cosines[1] + debulge, most = 1 - cosines[0] + debulge;
    double deep = is_union ? least : most, shallow = is_union ? most : least;
    out[0] = csg_scale_set(rule, is_union, deep, shallow, low, partials);
    out[1] = csg_scale_set(rule, is_union, shallow, deep, high, partials);
}

void csg_rule_enclose(const csg_rule *rule, bool is_union, const double *low, const double *high,
                      size_t count, const double cosines[2], double *partials, double out[2])
{
    bool monotone = count == 1 || rule->monotone[!is_union];
    csg_blend_kind kind = monotone ? CSG_BLEND_END : (csg_blend_kind)rule->kind;
    switch (kind) {
    case CSG_BLEND_EXTERIOR:
        enclose_exterior(rule, low, high, out);
        return;
    case CSG_BLEND_INTERIOR:
        enclose_interior(rule, low, high, out);
        return;
    case CSG_BLEND_ARC:
        enclose_angles(rule, is_union, low, high, out);
        return;
    case CSG_BLEND_SCALE_SET:
        enclose_turns(rule, is_union, low, high, cosines, out);
        return;
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_RICCI:
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
    case CSG_BLEND_PERLIN:
    case CSG_BLEND_ARC_SHARP:
    case CSG_BLEND_FIELD_SHARP: /* always monotone */
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break;
    }
    out[0] = csg_rule_apply(rule, is_union, low, count, 0, partials);
    out[1] = csg_rule_apply(rule, is_union, high, count, 0, partials);
}
