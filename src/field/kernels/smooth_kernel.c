/* SPDX-License-Identifier: MIT
 * Smooth maxima by smooth unit steps (operators.md 7). Built once per instruction set, as kernel.c
 * is.
 *
 * Both are max(a, b) + e(t), t = |a - b|, with one value of the step that depends on which operand
 * is larger (R_n is not even). With mu = 1 - mu(u) or mu(-u), as the first or the second is larger:
 *   exterior  e = mu (t - delta)^2 / (4 delta), u = (t - delta) / eps
 *   interior  e = -(the other one of the two) t, u = t / eps
 * An exterior blend with eps > delta, or of a sigmoid, which never ends, needs the steps at delta
 * and at -delta (7.2). Neither blend is monotone; intervals are the enclosures of 7.2 and 7.3.
 */
#include "field/kernels/smooth_kernel.h"

#include "field/kernels/functions.h"
#include "field/rule_layout.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/steps.h"

/* ---- steps: mu and its derivative over a batch ------------------------------------------------
 */

#define PI 3.14159265f
#define ROUNDING 0x1p-19f

typedef struct step_at {
    float value, slope;
} step_at;

/* H_n by its truncated powers, from the nearer end: (1/n!) sum (-1)^j C(n, j) (tau - j)^n. */
static inline step_at polynomial(int n, float t)
{
    static const float binomials[9][5] = {
        {1},        {1, 1},         {1, 2, 1},      {1, 3, 3},         {1, 4, 6},
        {1, 5, 10}, {1, 6, 15, 20}, {1, 7, 21, 35}, {1, 8, 28, 56, 70}};
    static const float factorials[9] = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};
    float tau = larger(0.5f * (float)n * (1.0f - absolute(t)), 0);
    float value = 0, slope = 0, sign = 1.0f;
    for (int j = 0; 2 * j < n; j++) {
        float rest = larger(tau - (float)j, 0);
        float power = 1.0f;
        for (int k = 1; k < n; k++)
            power *= rest;
        power = n == 1 && rest <= 0 ? 0 : power;
        slope += sign * binomials[n][j] * power;
        value += sign * binomials[n][j] * (power * rest);
        sign = -sign;
    }
    value = value / factorials[n];
    slope = slope * (0.5f * (float)n * (float)n / factorials[n]);
    return (step_at){t > 0 ? 1.0f - value : value, slope};
}

/* R_n: sines of sines; flat beyond its ends. */
static inline step_at rising(int n, float t)
{
    float u = t, chain = PI / 4;
    for (int i = 1; i < n; i++) {
        chain *= 0.5f * PI * value_cos(0.5f * PI * u, 0);
        u = value_sin(0.5f * PI * u, 0);
    }
    float a = 0.25f * PI * (1.0f + u), end = t > 0 ? 1.0f : 0.0f;
    int inside = (t > -1.0f) & (t < 1.0f);
    float value = larger(smaller(value_sin(a, 0), 1.0f), 0), slope = value_cos(a, 0) * chain;
    return (step_at){inside ? value : end, inside ? larger(slope, 0) : 0};
}

static inline step_at rising_square(int n, float t)
{
    step_at r = rising(n, -absolute(t));
    float low = r.value * r.value;
    return (step_at){t > 0 ? 1.0f - low : low, 2.0f * r.value * r.slope};
}

static inline step_at sigmoid(float alpha, float end, float t)
{
    float x = alpha * absolute(t), e = value_exp(-x, 0), rest = 1.0f / (1.0f + e);
    int inside = absolute(t) < end;
    float low = inside ? e * rest : 0;
    return (step_at){t > 0 ? 1.0f - low : low, inside ? alpha * low * rest : 0};
}

#define STEP_LOOP(expression)                                                                      \
    for (size_t i = 0; i < count; i++) {                                                           \
        step_at s = (expression);                                                                  \
        value[i] = s.value;                                                                        \
        slope[i] = s.slope;                                                                        \
    }                                                                                              \
    break;
#define EACH_DEGREE(X) X(1) X(2) X(3) X(4) X(5) X(6) X(7) X(8)
#define EACH_RISE(X) X(1) X(2) X(3) X(4) X(5) X(6)

static void polynomials(int n, const float *restrict t, float *restrict value,
                        float *restrict slope, size_t count)
{
    switch (n) {
#define CASE(n)                                                                                    \
    case n:                                                                                        \
        STEP_LOOP(polynomial(n, t[i]))
        EACH_DEGREE(CASE)
#undef CASE
    default:
        break;
    }
}

static void risings(int n, const float *restrict t, float *restrict value, float *restrict slope,
                    size_t count)
{
    switch (n) {
#define CASE(n)                                                                                    \
    case n:                                                                                        \
        STEP_LOOP(rising(n, t[i]))
        EACH_RISE(CASE)
#undef CASE
    default:
        break;
    }
}

static void rising_squares(int n, const float *restrict t, float *restrict value,
                           float *restrict slope, size_t count)
{
    switch (n) {
#define CASE(n)                                                                                    \
    case n:                                                                                        \
        STEP_LOOP(rising_square(n, t[i]))
        EACH_RISE(CASE)
#undef CASE
    default:
        break;
    }
}

static void sigmoids(float alpha, float end, const float *restrict t, float *restrict value,
                     float *restrict slope, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        step_at s = sigmoid(alpha, end, t[i]);
        value[i] = s.value;
        slope[i] = s.slope;
    }
}

static void steps(const float *parameters, const float *t, float *value, float *slope, size_t count)
{
    int n = (int)parameters[CSG_SMOOTH_DEGREE];
    switch ((csg_step_kind)parameters[CSG_SMOOTH_STEP]) {
    case CSG_STEP_RISING:
        risings(n, t, value, slope, count);
        break;
    case CSG_STEP_RISING2:
        rising_squares(n, t, value, slope, count);
        break;
    case CSG_STEP_SIGMOID:
        sigmoids(parameters[CSG_SMOOTH_DEGREE], parameters[CSG_SMOOTH_REACH], t, value, slope,
                 count);
        break;
    case CSG_STEP_POLY:
    case CSG_STEP_BSPLINE:
        polynomials(n, t, value, slope, count);
        break;
    case CSG_STEP_COUNT:
        break;
    }
}

/* ---- e(t) and its derivative ------------------------------------------------------------------
 */

/* A batch's differences: t = |x - y|, and whether x is the larger one. */
typedef struct gaps {
    float t[CSG_BATCH], first[CSG_BATCH], excess[CSG_BATCH], slope[CSG_BATCH];
} gaps;

static int is_sigmoid(const float *parameters)
{
    return parameters[CSG_SMOOTH_STEP] == (float)CSG_STEP_SIGMOID;
}

static int is_wide(const float *parameters)
{
    return !is_sigmoid(parameters) && parameters[CSG_SMOOTH_EPS] > parameters[CSG_SMOOTH_DELTA];
}

/* 7.2 with g1 and g2 as printed, t >= 0: a sigmoid is even. */
static void exterior_sigmoid(const float *parameters, gaps *g, size_t count)
{
    const float delta = parameters[CSG_SMOOTH_DELTA], eps = parameters[CSG_SMOOTH_EPS];
    const float alpha = parameters[CSG_SMOOTH_DEGREE], end = parameters[CSG_SMOOTH_REACH];
    for (size_t i = 0; i < count; i++) {
        float t = g->t[i], p = t * t / (2.0f * delta) + 0.5f * delta;
        step_at below = sigmoid(alpha, end, -(t + delta) / eps); /* 1 - g1 */
        step_at above = sigmoid(alpha, end, -(t - delta) / eps); /* 1 - g2 */
        float g1 = 1.0f - below.value, s1 = below.slope / eps, s2 = above.slope / eps;
        g->excess[i] = 0.5f * (above.value * (g1 * p - t) - below.value * t);
        float rise = (s1 + s2) * t - below.value - above.value + (s1 * above.value - g1 * s2) * p +
                     g1 * above.value * (t / delta);
        g->slope[i] = 0.5f * rise;
    }
}

static void exterior(const float *parameters, gaps *g, size_t count)
{
    const float delta = parameters[CSG_SMOOTH_DELTA], eps = parameters[CSG_SMOOTH_EPS];
    float at[CSG_BATCH] = {0}, value[CSG_BATCH], slope[CSG_BATCH];
    if (is_sigmoid(parameters)) {
        exterior_sigmoid(parameters, g, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        float u = (g->t[i] - delta) / eps;
        at[i] = g->first[i] > 0 ? u : -u;
    }
    steps(parameters, at, value, slope, count);
    for (size_t i = 0; i < count; i++) {
        float past = g->t[i] - delta, weight = g->first[i] > 0 ? 1.0f - value[i] : value[i];
        g->excess[i] = weight * (past * past) / (4.0f * delta);
        g->slope[i] = (2.0f * weight * past - slope[i] / eps * (past * past)) / (4.0f * delta);
    }
}

/* eps > delta: the steps at delta and at -delta overlap, and 7.2 needs both, as printed. */
static void exterior_wide(const float *parameters, gaps *g, size_t count)
{
    const float delta = parameters[CSG_SMOOTH_DELTA], eps = parameters[CSG_SMOOTH_EPS];
    float at[CSG_BATCH] = {0}, above[CSG_BATCH], above_slope[CSG_BATCH];
    float below[CSG_BATCH], below_slope[CSG_BATCH];
    for (size_t i = 0; i < count; i++) {
        float u = (g->t[i] - delta) / eps;
        at[i] = g->first[i] > 0 ? u : -u;
    }
    steps(parameters, at, above, above_slope, count);
    for (size_t i = 0; i < count; i++) {
        float u = (g->t[i] + delta) / eps;
        at[i] = g->first[i] > 0 ? u : -u;
    }
    steps(parameters, at, below, below_slope, count);
    for (size_t i = 0; i < count; i++) {
        float t = g->t[i], past = t - delta, p = 0.5f * (t * t / delta + delta);
        float a = g->first[i] > 0 ? 1.0f - above[i] : above[i]; /* 1 - g2 */
        float b = g->first[i] > 0 ? 1.0f - below[i] : below[i]; /* 1 - g1 */
        float da = -above_slope[i] / eps, db = -below_slope[i] / eps;
        g->excess[i] = 0.5f * (a * (past * past) / (2.0f * delta) - b * (t + a * p));
        g->slope[i] = 0.5f * (da * (past * past) / (2.0f * delta) + a * past / delta -
                              db * (t + a * p) - b * (1.0f + da * p + a * t / delta));
    }
}

static void interior(const float *parameters, gaps *g, size_t count)
{
    const float eps = parameters[CSG_SMOOTH_EPS];
    float at[CSG_BATCH] = {0}, value[CSG_BATCH], slope[CSG_BATCH];
    for (size_t i = 0; i < count; i++) {
        float u = g->t[i] / eps;
        at[i] = g->first[i] > 0 ? -u : u;
    }
    steps(parameters, at, value, slope, count);
    for (size_t i = 0; i < count; i++) {
        float weight = g->first[i] > 0 ? value[i] : 1.0f - value[i];
        g->excess[i] = -weight * g->t[i];
        g->slope[i] = slope[i] * (g->t[i] / eps) - weight;
    }
}

/* Beyond the support the larger operand, bit for bit. turn = -1 mirrors an intersection. */
static void find_gaps(const csg_tape_node *node, const float *parameters, const float *restrict a,
                      const float *restrict b, gaps *restrict g, size_t count)
{
    const float turn = node->join == CSG_JOIN_UNION ? 1.0f : -1.0f;
    const float chi = parameters[CSG_OPERATOR_SUPPORT];
    for (size_t i = 0; i < count; i++) {
        float t = turn * (a[i] - b[i]), far = absolute(t);
        g->first[i] = t >= 0 ? 1.0f : 0.0f;
        g->t[i] = far < chi ? far : chi; /* infinite operands too */
    }
    if (node->join_blend == CSG_BLEND_EXTERIOR)
        (is_wide(parameters) ? exterior_wide : exterior)(parameters, g, count);
    else
        interior(parameters, g, count);
    for (size_t i = 0; i < count; i++) {
        int inside = g->t[i] < chi;
        g->excess[i] = inside ? g->excess[i] : 0;
        g->slope[i] = inside ? g->slope[i] : 0;
    }
}

static void values(const csg_tape_node *node, const float *parameters, float *restrict a,
                   const float *restrict b, size_t count)
{
    gaps g;
    find_gaps(node, parameters, a, b, &g, count);
    if (node->join == CSG_JOIN_UNION)
        for (size_t i = 0; i < count; i++)
            a[i] = larger(a[i], b[i]) + g.excess[i];
    else
        for (size_t i = 0; i < count; i++)
            a[i] = smaller(a[i], b[i]) - g.excess[i];
}

static void shares(const csg_tape_node *node, const float *parameters, const float *restrict a,
                   const float *restrict b, float *restrict share, size_t count)
{
    gaps g;
    find_gaps(node, parameters, a, b, &g, count);
    for (size_t i = 0; i < count; i++)
        share[i] = g.first[i] > 0 ? 1.0f + g.slope[i] : -g.slope[i];
}

/* ---- intervals --------------------------------------------------------------------------------
 */

/* e at one distance, with the first or the second operand the larger one. */
static float excess_at(const csg_tape_node *node, const float *parameters, float t, int first)
{
    csg_tape_node united = *node;
    gaps g;
    float a[CSG_OCTANTS] = {0}, b[CSG_OCTANTS] = {0};
    united.join = CSG_JOIN_UNION;
    a[0] = first ? t : 0;
    b[0] = first ? 0 : t;
    find_gaps(&united, parameters, a, b, &g, CSG_OCTANTS);
    return g.excess[0];
}

/* Of e over low..high, 0 <= low <= high, for one of the sides. */
static range exterior_range(const csg_tape_node *node, const float *parameters, float low,
                            float high, int first)
{
    const float delta = parameters[CSG_SMOOTH_DELTA], eps = parameters[CSG_SMOOTH_EPS];
    float p = excess_at(node, parameters, low, first), q = excess_at(node, parameters, high, first);
    if (is_sigmoid(parameters) || is_wide(parameters)) { /* only how fast it changes is known */
        float reach = 0.5f * (parameters[CSG_SMOOTH_K] + 1.0f) * (high - low);
        return (range){smaller(p, q) - 0.5f * reach, larger(p, q) + 0.5f * reach};
    }
    /* Falls on [0, delta], then 0, one bump, and 0. */
    const float *bump = parameters + CSG_SMOOTH_BUMP + !first;
    float peak = delta + eps * bump[CSG_SMOOTH_BUMP_AT - CSG_SMOOTH_BUMP];
    float top = *bump * (eps * eps) / (4.0f * delta);
    int at_peak = (low <= peak) & (peak <= high), at_zero = (low <= delta) & (delta <= high);
    float least = smaller(p, q), most = larger(p, q);
    return (range){at_zero ? smaller(least, 0) : least, at_peak ? larger(most, top) : most};
}

/* -e / eps rises from 0 to its peak and falls to 0 at the end of the step. */
static range interior_range(const csg_tape_node *node, const float *parameters, float low,
                            float high, int first)
{
    const float eps = parameters[CSG_SMOOTH_EPS];
    const float *dent = parameters + CSG_SMOOTH_DENT + first;
    float peak = eps * dent[CSG_SMOOTH_DENT_AT - CSG_SMOOTH_DENT], bottom = -eps * *dent;
    float p = excess_at(node, parameters, low, first), q = excess_at(node, parameters, high, first);
    int at_peak = (low <= peak) & (peak <= high);
    float least = smaller(p, q);
    return (range){at_peak ? smaller(least, bottom) : least, larger(p, q)};
}

/* Of e where the operands differ by low..high, whose signs tell which is the larger one. */
static range excess_range(const csg_tape_node *node, const float *parameters, float low, float high)
{
    range r = {INFINITY, -INFINITY};
    for (int first = 0; first < 2; first++) {
        float near = first ? low : -high, far = first ? high : -low;
        if (far < 0)
            continue;
        near = larger(near, 0);
        far = smaller(far, parameters[CSG_OPERATOR_SUPPORT]);
        near = smaller(near, far);
        range s = node->join_blend == CSG_BLEND_EXTERIOR
                      ? exterior_range(node, parameters, near, far, first)
                      : interior_range(node, parameters, near, far, first);
        r.low = smaller(r.low, s.low);
        r.high = larger(r.high, s.high);
    }
    return r;
}

/* max(x, y) + e(|x - y|) rises with both where |x - y| <= delta and the step is even: then its
 * corner is the tighter lower bound (7.2). */
static float corner(const csg_tape_node *node, const float *parameters, float x, float y)
{
    float t = absolute(x - y);
    int known = node->join_blend == CSG_BLEND_EXTERIOR && parameters[CSG_SMOOTH_EVEN] != 0 &&
                !is_sigmoid(parameters) && !is_wide(parameters) && t < parameters[CSG_SMOOTH_DELTA];
    return larger(x, y) + (known ? excess_at(node, parameters, t, x >= y) : 0);
}

/* A union G(x, y) for x in x and y in y. */
static range enclose(const csg_tape_node *node, const float *parameters, range x, range y)
{
    range e = excess_range(node, parameters, x.low - y.high, x.high - y.low);
    float low = larger(x.low, y.low) + e.low, high = larger(x.high, y.high) + e.high;
    if (node->join_blend == CSG_BLEND_INTERIOR)
        low = larger(low, smaller(x.low, y.low));
    else if (!is_sigmoid(parameters))
        low = larger(low, corner(node, parameters, x.low, y.low));
    const float length = parameters[CSG_SMOOTH_DELTA] + parameters[CSG_SMOOTH_EPS];
    low = low - ROUNDING * (absolute(low) + length);
    high = high + ROUNDING * (absolute(high) + length);
    /* Too far apart to blend: exactly the larger one. */
    int apart = (x.low - y.high >= parameters[CSG_OPERATOR_SUPPORT]) |
                (y.low - x.high >= parameters[CSG_OPERATOR_SUPPORT]);
    return (range){apart ? larger(x.low, y.low) : low, apart ? larger(x.high, y.high) : high};
}

static void intervals(const csg_tape_node *node, const float *parameters, float *a_low,
                      float *a_high, const float *b_low, const float *b_high)
{
    const int is_union = node->join == CSG_JOIN_UNION;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        range x = {is_union ? a_low[o] : -a_high[o], is_union ? a_high[o] : -a_low[o]};
        range y = {is_union ? b_low[o] : -b_high[o], is_union ? b_high[o] : -b_low[o]};
        range g = enclose(node, parameters, x, y);
        a_low[o] = is_union ? g.low : -g.high;
        a_high[o] = is_union ? g.high : -g.low;
    }
}

const csg_smooth_kernel CSG_THIS_SMOOTH_KERNEL = {
    .values = values,
    .shares = shares,
    .intervals = intervals,
};
