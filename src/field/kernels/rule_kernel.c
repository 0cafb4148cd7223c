/* SPDX-License-Identifier: MIT
 * Soft nodes and operators on fields, each step over a whole batch; soft_formulas.h has the
 * mathematics. Built once per instruction set, as kernel.c is.
 *
 * Intervals: all but an arc with a profile and a turning scale function are monotone, so their
 * values at the ends are, moved outwards by what rounding can do to them; 0 and 1 are exact and
 * stay, since operands are dropped for them.
 */
#include "field/kernels/rule_kernel.h"

#include "field/kernels/soft_formulas.h"
#include "field/rule_layout.h"
#include "field/turning.h"

/* Relative rounding of a join or of a field function, and of N_S and N_A after it. */
#define ROUNDING 0x1p-20f
/* Room of what a soft node delivers as a value, in units of |scale| + |shift|, which no such value
 * exceeds: that of scale and shift, and of the folds of lengths above, which round by a few units
 * in the last place of their operands and have no room of their own. Leaves have it in their slack.
 */
#define VALUE_ROUNDING 0x1p-19f

/* ---- soft nodes and deliveries ----------------------------------------------------------------
 */

#define SOFTEN_LOOP(expression, factor)                                                            \
    for (size_t i = 0; i < count; i++) {                                                           \
        const float v = values[i];                                                                 \
        curve c = (expression);                                                                    \
        values[i] = c.value;                                                                       \
        slope[i] = (factor)*c.slope;                                                               \
    }                                                                                              \
    break;

/* v becomes F, slope dF / dv. */
static void soften(const float *parameters, uint8_t kind, float *restrict values,
                   float *restrict slope, size_t count)
{
    const float rate = parameters[CSG_SOFTEN_RATE], iso = parameters[CSG_SOFTEN_ISO];
    switch ((csg_tape_curve)kind) {
#define CSG_FALLOFF(NAME, name, iso_, steepest, steepest_at, doc)                                  \
    case CSG_CURVE_##NAME:                                                                         \
        SOFTEN_LOOP(falloff_##name(distance_of(iso, rate, v)), -rate)
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
    case CSG_CURVE_STEP:
        SOFTEN_LOOP(step_cubic(larger(smaller(rate * v, 1.0f), -1.0f)), rate)
    case CSG_CURVE_CLAMP:
        SOFTEN_LOOP(clamped(0.5f + rate * v), rate)
    }
}

#define NORMALISE_LOOP(expression)                                                                 \
    for (size_t i = 0; i < count; i++) {                                                           \
        const float u = values[i];                                                                 \
        curve c = (expression);                                                                    \
        values[i] = c.value;                                                                       \
        slope[i] = c.slope;                                                                        \
    }                                                                                              \
    break;

/* Whether N_S or N_A is left to do. A turning operator's join has done it, unless there was none:
 * then the other operand has no gradient, and the angle counts as right. */
static int is_normalised(const csg_tape_node *node)
{
    return node->blend == CSG_BLEND_SCALE_SET || node->blend == CSG_BLEND_SOFT_SET ||
           (node->blend == CSG_BLEND_TURNING && node->arity == 1);
}

static void normalise(const csg_tape_node *node, const float *parameters, float *restrict values,
                      float *restrict slope, size_t count)
{
    const float top = parameters[CSG_SCALE_TOP], bend = parameters[CSG_SCALE_BEND];
    const float lift = parameters[CSG_SCALE_LIFT], right = 1.0f + parameters[CSG_SCALE_OMEGA];
    switch (is_normalised(node) ? node->blend : CSG_BLEND_SHARP) {
    case CSG_BLEND_SCALE_SET:
        NORMALISE_LOOP(normalise_scale(top, bend, u))
    case CSG_BLEND_TURNING:
        NORMALISE_LOOP(normalise_turned(lift, right, u))
    case CSG_BLEND_SOFT_SET:
        NORMALISE_LOOP(normalise_sum(u))
    default:
        for (size_t i = 0; i < count; i++)
            slope[i] = 1.0f;
    }
}

static const float *delivery_of(const csg_tape *tape, const csg_tape_node *node)
{
    const float *parameters = tape->parameters + node->parameters;
    return node->op == CSG_OP_SOFTEN ? parameters : parameters + CSG_RULE_DELIVER;
}

/* F, still to be delivered. */
static void fields(const csg_tape *tape, const csg_tape_node *node, float *values, float *slope,
                   size_t count)
{
    const float *parameters = tape->parameters + node->parameters;
    if (node->op == CSG_OP_SOFTEN)
        soften(parameters, node->blend, values, slope, count);
    else
        normalise(node, parameters, values, slope, count);
}

static void hand_over(const float *delivery, float *restrict values, size_t count)
{
    const float scale = delivery[CSG_DELIVER_SCALE], level = delivery[CSG_DELIVER_LEVEL];
    const float shift = delivery[CSG_DELIVER_SHIFT];
    const float low = delivery[CSG_DELIVER_LOW], high = delivery[CSG_DELIVER_HIGH];
    for (size_t i = 0; i < count; i++)
        values[i] = smaller(larger(scale * (values[i] - level) + shift, low), high);
}

static void deliver(const csg_tape *tape, const csg_tape_node *node, float *values, float *slope,
                    float *flat, size_t count)
{
    float unused[CSG_BATCH], *restrict by = slope ? slope : unused;
    const float *delivery = delivery_of(tape, node);
    const int is_field = delivery[CSG_DELIVER_LOW] == 0;
    fields(tape, node, values, by, count);
    if (slope)
        for (size_t i = 0; i < count; i++) {
            float v = values[i]; /* beyond 1 a union is cut off */
            flat[i] = (v <= 0) | (v >= 1.0f) ? 1.0f : 0.0f;
            by[i] = is_field & (v >= 1.0f) ? 0.0f : by[i];
        }
    hand_over(delivery, values, count);
}

/* ---- intervals of deliveries ------------------------------------------------------------------
 */

/* Ends moved outwards; 0 is exact, and low ends from `full` on. */
static void widen(float *restrict low, float *restrict high, float full)
{
    for (int o = 0; o < CSG_OCTANTS; o++) {
        float rounding = low[o] >= full ? 0 : ROUNDING;
        low[o] -= absolute(low[o]) * rounding;
        high[o] += absolute(high[o]) * ROUNDING;
    }
}

static void deliver_intervals(const csg_tape *tape, const csg_tape_node *node, float *low,
                              float *high)
{
    float unused[CSG_OCTANTS];
    fields(tape, node, low, unused, CSG_OCTANTS);
    fields(tape, node, high, unused, CSG_OCTANTS);
    if (node->op == CSG_OP_SOFTEN || is_normalised(node))
        widen(low, high, 1.0f);
    const float *delivery = delivery_of(tape, node);
    hand_over(delivery, low, CSG_OCTANTS);
    hand_over(delivery, high, CSG_OCTANTS);
    if (delivery[CSG_DELIVER_LOW] != 0) {
        const float scale = delivery[CSG_DELIVER_SCALE], sign = scale < 0 ? -1.0f : 1.0f;
        const float room =
            VALUE_ROUNDING * (absolute(scale) + absolute(delivery[CSG_DELIVER_SHIFT]));
        for (int o = 0; o < CSG_OCTANTS; o++) {
            low[o] -= sign * room;
            high[o] += sign * room;
        }
    }
    for (int o = 0; o < CSG_OCTANTS && delivery[CSG_DELIVER_SCALE] < 0; o++) {
        float turned = low[o];
        low[o] = high[o];
        high[o] = turned;
    }
}

/* ---- joins ------------------------------------------------------------------------------------
 */

/* Each join's formula, of the union and of the intersection, in terms of x and y. */
#define EACH_RULE(X)                                                                               \
    X(RICCI, ricci_union(exponent, x, y), ricci_intersection(exponent, x, y))                      \
    X(PERLIN, perlin_union(x, y), perlin_intersection(x, y))                                       \
    X(SCALE_SET, scale(r1, r2, kappa, x, y), scale(r1, r2, kappa, x, y))                           \
    X(ARC, arc_union(angle_a, angle_b, x, y), arc_intersection(angle_a, angle_b, x, y))            \
    X(ARC_SHARP, sharp_union(x, y), sharp_intersection(x, y))                                      \
    X(FIELD_SHARP, field_union(x, y), field_intersection(x, y))

static inline mixture sum_of(float x, float y)
{
    return (mixture){x + y, 1.0f, 1.0f};
}
/* What plain joins are not: sums, blends of lengths, and TURNING (CSG_BLEND_END). */
#define CASES_OF_OTHERS                                                                            \
    case CSG_BLEND_SOFT_SUM:                                                                       \
    case CSG_BLEND_SOFT_SET:                                                                       \
    case CSG_BLEND_EXTERIOR:                                                                       \
    case CSG_BLEND_INTERIOR:                                                                       \
    case CSG_BLEND_PROFILE:                                                                        \
    case CSG_BLEND_ORTHOGONAL:                                                                     \
    case CSG_BLEND_END:

#define RULE_PARAMETERS                                                                            \
    const float exponent = parameters[CSG_RICCI_EXPONENT];                                         \
    const float r1 = parameters[CSG_SCALE_R1], r2 = parameters[CSG_SCALE_R2];                      \
    const float kappa = parameters[CSG_SCALE_KAPPA];                                               \
    const float angle_a = parameters[CSG_ARC_A], angle_b = parameters[CSG_ARC_B];                  \
    const int is_union = node->join == CSG_JOIN_UNION, is_sum = sums(node, parameters)

/* Ricci's union with n = 1 is the sum. */
static int sums(const csg_tape_node *node, const float *parameters)
{
    return node->join_blend == CSG_BLEND_SOFT_SUM || node->join_blend == CSG_BLEND_SOFT_SET ||
           (node->join_blend == CSG_BLEND_RICCI && node->join == CSG_JOIN_UNION &&
            parameters[CSG_RICCI_EXPONENT] == 1.0f);
}

static void plain_join(const csg_tape_node *node, const float *parameters, float *restrict a,
                       const float *restrict b, size_t count)
{
    RULE_PARAMETERS;
    if (is_sum) {
        for (size_t i = 0; i < count; i++)
            a[i] = a[i] + b[i];
        return;
    }
#define JOIN_LOOP(expression)                                                                      \
    for (size_t i = 0; i < count; i++) {                                                           \
        const float x = a[i], y = b[i];                                                            \
        a[i] = (expression).value;                                                                 \
    }
    switch ((csg_blend_kind)node->join_blend) {
#define CASE(NAME, united, met)                                                                    \
    case CSG_BLEND_##NAME:                                                                         \
        if (is_union)                                                                              \
            JOIN_LOOP(united)                                                                      \
        else                                                                                       \
            JOIN_LOOP(met)                                                                         \
        break;
        EACH_RULE(CASE)
#undef CASE
        CASES_OF_OTHERS
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
        break;
    }
}

static void plain_partials(const csg_tape_node *node, const float *parameters,
                           const float *restrict a, const float *restrict b, float *restrict by_a,
                           float *restrict by_b, size_t count)
{
    RULE_PARAMETERS;
#define PARTIAL_LOOP(expression)                                                                   \
    for (size_t i = 0; i < count; i++) {                                                           \
        const float x = a[i], y = b[i];                                                            \
        mixture m = (expression);                                                                  \
        by_a[i] = m.a;                                                                             \
        by_b[i] = m.b;                                                                             \
    }
    if (is_sum) {
        PARTIAL_LOOP(sum_of(x, y))
        return;
    }
    switch ((csg_blend_kind)node->join_blend) {
#define CASE(NAME, united, met)                                                                    \
    case CSG_BLEND_##NAME:                                                                         \
        if (is_union)                                                                              \
            PARTIAL_LOOP(united)                                                                   \
        else                                                                                       \
            PARTIAL_LOOP(met)                                                                      \
        break;
        EACH_RULE(CASE)
#undef CASE
        CASES_OF_OTHERS
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
        break;
    }
}

/* ---- profiles of arcs (5.5) -------------------------------------------------------------------
 */

static int has_profile(const csg_tape_node *node, const float *parameters)
{
    return node->join_blend == CSG_BLEND_ARC && parameters[CSG_ARC_KNOTS] > 0;
}

static void add_stretch(const float *stretch, const float *restrict angle, float *restrict factor,
                        float *restrict slope, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        curve part = profile_part(stretch, angle[i]);
        factor[i] += part.value;
        slope[i] += part.slope;
    }
}

/* The factor and its derivative by the angle atan2(y, x); 1 outside of the transition. */
static void profile(const float *parameters, const float *restrict x, const float *restrict y,
                    float *restrict factor, float *restrict slope, size_t count)
{
    float angle[CSG_BATCH];
    const float angle_a = parameters[CSG_ARC_A], angle_b = parameters[CSG_ARC_B];
    for (size_t i = 0; i < count; i++) {
        angle[i] = angle_of(y[i], x[i]);
        factor[i] = 1.0f;
        slope[i] = 0;
    }
    for (int k = 0; k + 1 < (int)parameters[CSG_ARC_KNOTS]; k++)
        add_stretch(parameters + CSG_ARC_STRETCHES + k * CSG_STRETCH_PARAMETERS, angle, factor,
                    slope, count);
    for (size_t i = 0; i < count; i++) {
        int inside = arc_blends(angle_a, angle_b, x[i], y[i]) & (x[i] > 0) & (y[i] > 0);
        factor[i] = inside ? factor[i] : 1.0f;
        slope[i] = inside ? slope[i] : 0;
    }
}

static void join_fields(const csg_tape_node *node, const float *parameters, float *a,
                        const float *b, size_t count)
{
    float factor[CSG_BATCH], slope[CSG_BATCH];
    bool shaped = has_profile(node, parameters);
    if (shaped)
        profile(parameters, a, b, factor, slope, count);
    plain_join(node, parameters, a, b, count);
    for (size_t i = 0; i < count && shaped; i++)
        a[i] *= factor[i];
}

static void partials(const csg_tape_node *node, const float *parameters, const float *a,
                     const float *b, float *by_a, float *by_b, size_t count)
{
    plain_partials(node, parameters, a, b, by_a, by_b, count);
    if (!has_profile(node, parameters))
        return;
    float factor[CSG_BATCH], slope[CSG_BATCH], g[CSG_BATCH];
    profile(parameters, a, b, factor, slope, count);
    memcpy(g, a, count * sizeof *g);
    plain_join(node, parameters, g, b, count);
    for (size_t i = 0; i < count; i++) {
        float turn = quotient(slope[i] * g[i], a[i] * a[i] + b[i] * b[i]);
        by_a[i] = factor[i] * by_a[i] - turn * b[i];
        by_b[i] = factor[i] * by_b[i] + turn * a[i];
    }
}

/* By the partial derivatives and what an operand adds to the result, so that one that is at the end
 * of its field, where pruning may have changed what it is made of, has no share. */
static void shares(const csg_tape_node *node, const float *restrict a, const float *restrict b,
                   float *restrict by_a, const float *restrict by_b, size_t count)
{
    const int is_union = node->join == CSG_JOIN_UNION, kind = node->join_blend;
    const int adds = kind == CSG_BLEND_RICCI || kind == CSG_BLEND_PERLIN;
    const int united =
        kind == CSG_BLEND_SOFT_SUM || kind == CSG_BLEND_SOFT_SET || (adds && is_union);
    const int met = kind == CSG_BLEND_PERLIN && !is_union;
    for (size_t i = 0; i < count; i++) {
        float first = absolute(by_a[i]), second = absolute(by_b[i]);
        int flat_a = (a[i] <= 0) | (a[i] >= 1.0f), flat_b = (b[i] <= 0) | (b[i] >= 1.0f);
        first *= united ? a[i] : met ? 1.0f - a[i] : flat_a ? 0 : 1.0f;
        second *= united ? b[i] : met ? 1.0f - b[i] : flat_b ? 0 : 1.0f;
        float all = absolute(by_a[i]) + absolute(by_b[i]), both = first + second;
        float share = all > 0 ? absolute(by_a[i]) / all : 1.0f;
        by_a[i] = both > 0 ? first / both : share;
    }
}

/* ---- bulge elimination (6.7) -------------------------------------------------------------------
 */

/* 1 - cos + omega for the angle between two gradients; a right one where either is 0. */
static inline float turn_of(float omega, float ax, float ay, float az, float bx, float by, float bz)
{
    float a = sqrtf(ax * ax + ay * ay + az * az), b = sqrtf(bx * bx + by * by + bz * bz);
    float dot = quotient(ax, a) * quotient(bx, b) + quotient(ay, a) * quotient(by, b) +
                quotient(az, a) * quotient(bz, b);
    return 1.0f - larger(smaller(dot, 1.0f), -1.0f) + omega;
}

static void turn(const float *parameters, float *restrict a, const float *restrict b,
                 float *const ga[3], float *const gb[3], float *restrict by_a, float *restrict by_b,
                 size_t count)
{
    const float r1 = parameters[CSG_SCALE_R1], r2 = parameters[CSG_SCALE_R2];
    const float kappa = parameters[CSG_SCALE_KAPPA], lift = parameters[CSG_SCALE_LIFT];
    const float omega = parameters[CSG_SCALE_OMEGA];
    const float *restrict ax = ga[0], *restrict ay = ga[1], *restrict az = ga[2];
    const float *restrict bx = gb[0], *restrict by = gb[1], *restrict bz = gb[2];
    for (size_t i = 0; i < count; i++) {
        float s = turn_of(omega, ax[i], ay[i], az[i], bx[i], by[i], bz[i]);
        mixture m = scale(r1 * s, r2 * s, kappa, a[i], b[i]);
        curve c = normalise_turned(lift, s, m.value);
        a[i] = c.value;
        by_a[i] = c.slope * m.a;
        by_b[i] = c.slope * m.b;
    }
}

/* ---- intervals of joins ------------------------------------------------------------------------
 */

/* N_S(B) rises with the operands, B falls with s and N_S with m, which falls with s. */
static void turning_intervals(const float *parameters, float *restrict a_low,
                              float *restrict a_high, const float *restrict b_low,
                              const float *restrict b_high)
{
    const float r1 = parameters[CSG_SCALE_R1], r2 = parameters[CSG_SCALE_R2];
    const float kappa = parameters[CSG_SCALE_KAPPA], lift = parameters[CSG_SCALE_LIFT];
    const float least = parameters[CSG_SCALE_OMEGA], most = 2.0f + least;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        float low = scale(r1 * most, r2 * most, kappa, a_low[o], b_low[o]).value;
        float high = scale(r1 * least, r2 * least, kappa, a_high[o], b_high[o]).value;
        a_low[o] = normalise_turned(lift, least, low * (1.0f - 2 * ROUNDING)).value;
        a_high[o] = normalise_turned(lift, most, high * (1.0f + 2 * ROUNDING)).value;
    }
}

/* The profile's factor where the angle can be: its values at the ends of the range, and everything
 * that a stretch in between can reach. */
static void factor_range(const float *parameters, const float *angle_low, const float *angle_high,
                         float *least, float *most)
{
    const float error = 4 * FUNCTION_ERROR;
    for (int o = 0; o < CSG_OCTANTS; o++)
        least[o] = most[o] = 1.0f;
    for (int k = 0; k + 1 < (int)parameters[CSG_ARC_KNOTS]; k++) {
        const float *s = parameters + CSG_ARC_STRETCHES + k * CSG_STRETCH_PARAMETERS;
        const float width = 1.0f / s[CSG_STRETCH_INVERSE], start = s[CSG_STRETCH_ANGLE];
        /* A Hermite cubic lies in the hull of its Bernstein coefficients. */
        const float first = s[CSG_STRETCH_FACTOR], last = first + s[CSG_STRETCH_RISE];
        const float second = first + s[CSG_STRETCH_SLOPE] / 3.0f;
        const float third = last - s[CSG_STRETCH_NEXT_SLOPE] / 3.0f;
        const float low = smaller(smaller(first, last), smaller(second, third));
        const float high = larger(larger(first, last), larger(second, third));
        for (int o = 0; o < CSG_OCTANTS; o++) {
            int meets = (angle_high[o] + error >= start) & (angle_low[o] - error <= start + width);
            least[o] = meets ? smaller(least[o], low) : least[o];
            most[o] = meets ? larger(most[o], high) : most[o];
        }
    }
}

static void shaped_intervals(const csg_tape_node *node, const float *parameters, float *a_low,
                             float *a_high, const float *b_low, const float *b_high)
{
    float first[CSG_OCTANTS], last[CSG_OCTANTS], least[CSG_OCTANTS], most[CSG_OCTANTS];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        first[o] = angle_of(b_low[o], a_high[o]);
        last[o] = angle_of(b_high[o], a_low[o]);
    }
    factor_range(parameters, first, last, least, most);
    plain_join(node, parameters, a_low, b_low, CSG_OCTANTS);
    plain_join(node, parameters, a_high, b_high, CSG_OCTANTS);
    for (int o = 0; o < CSG_OCTANTS; o++) {
        a_low[o] *= least[o];
        a_high[o] *= most[o];
    }
}

/* Joins that rise with their operands also as rounded. */
static int is_exact(const csg_tape_node *node, const float *parameters)
{
    return sums(node, parameters) || node->join_blend == CSG_BLEND_FIELD_SHARP ||
           (node->join_blend == CSG_BLEND_PERLIN && node->join == CSG_JOIN_INTERSECTION);
}

static void join_intervals(const csg_tape_node *node, const float *parameters, float *a_low,
                           float *a_high, const float *b_low, const float *b_high)
{
    if (node->join_blend == CSG_BLEND_TURNING) {
        turning_intervals(parameters, a_low, a_high, b_low, b_high);
    } else if (has_profile(node, parameters) && parameters[CSG_ARC_MONOTONE] == 0) {
        shaped_intervals(node, parameters, a_low, a_high, b_low, b_high);
    } else {
        join_fields(node, parameters, a_low, b_low, CSG_OCTANTS);
        join_fields(node, parameters, a_high, b_high, CSG_OCTANTS);
    }
    if (!is_exact(node, parameters))
        widen(a_low, a_high, INFINITY);
}

const csg_rule_kernel CSG_THIS_RULE_KERNEL = {
    .deliver = deliver,
    .deliver_intervals = deliver_intervals,
    .join = join_fields,
    .partials = partials,
    .shares = shares,
    .turn = turn,
    .join_intervals = join_intervals,
};
