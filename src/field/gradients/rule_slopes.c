/* SPDX-License-Identifier: MIT
 * Slopes of rules in ranges; see rule_slopes.h. The formulas and their derivatives at a place are
 * those of soft_formulas.h; rounding is added here.
 */
#include "field/gradients/rule_slopes.h"

#include <math.h>

#include "field/kernels/soft_formulas.h"
#include "field/rule_layout.h"
#include "field/turning.h"

typedef csg_rule_range span;

static const double ROUNDING = 1e-5; /* of slopes, which are computed in float */

static span hull_of(double a, double b)
{
    return (span){fmin(a, b), fmax(a, b)};
}

static double size_of(span a)
{
    return fmax(fabs(a.low), fabs(a.high));
}

static span sum(span a, span b)
{
    return (span){a.low + b.low, a.high + b.high};
}

static span product(span a, span b)
{
    span first = hull_of(a.low * b.low, a.low * b.high);
    span second = hull_of(a.high * b.low, a.high * b.high);
    return (span){fmin(first.low, second.low), fmax(first.high, second.high)};
}

static span unit(span a)
{
    return (span){fmax(0, a.low), fmin(1, a.high)};
}

/* ---- joins at a place --------------------------------------------------------------------------
 */

/* Without a profile. */
static mixture join_at(const csg_tape_node *node, const float *own, float x, float y)
{
    bool is_union = node->join == CSG_JOIN_UNION;
    switch ((csg_blend_kind)node->join_blend) {
    case CSG_BLEND_RICCI:
        return is_union ? ricci_union(own[CSG_RICCI_EXPONENT], x, y)
                        : ricci_intersection(own[CSG_RICCI_EXPONENT], x, y);
    case CSG_BLEND_PERLIN:
        return is_union ? perlin_union(x, y) : perlin_intersection(x, y);
    case CSG_BLEND_SCALE_SET:
        return scale(own[CSG_SCALE_R1], own[CSG_SCALE_R2], own[CSG_SCALE_KAPPA], x, y);
    case CSG_BLEND_ARC:
        return is_union ? arc_union(own[CSG_ARC_A], own[CSG_ARC_B], x, y)
                        : arc_intersection(own[CSG_ARC_A], own[CSG_ARC_B], x, y);
    case CSG_BLEND_ARC_SHARP:
        return is_union ? sharp_union(x, y) : sharp_intersection(x, y);
    case CSG_BLEND_FIELD_SHARP:
        return is_union ? field_union(x, y) : field_intersection(x, y);
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
        return (mixture){x + y, 1, 1};
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
        break; /* no fields, or TURNING */
    }
    return (mixture){NAN, NAN, NAN};
}

/* ---- profiles of arcs --------------------------------------------------------------------------
 */

/* The factor at an angle, and its slope. */
static curve profile_at(const float *own, float angle)
{
    curve all = {1, 0};
    for (int k = 0; k + 1 < (int)own[CSG_ARC_KNOTS]; k++) {
        curve part = profile_part(own + CSG_ARC_STRETCHES + k * CSG_STRETCH_PARAMETERS, angle);
        all.value += part.value;
        all.slope += part.slope;
    }
    return all;
}

/* No less than the size of the second derivative anywhere in these angles: it is linear on each
 * stretch. The profile is level at its ends and beyond. */
static double bend_of_profile(const float *own, span angle)
{
    double most = 0;
    for (int k = 0; k + 1 < (int)own[CSG_ARC_KNOTS]; k++) {
        const float *s = own + CSG_ARC_STRETCHES + k * CSG_STRETCH_PARAMETERS;
        double inverse = (double)s[CSG_STRETCH_INVERSE], from = (double)s[CSG_STRETCH_ANGLE];
        double rise = (double)s[CSG_STRETCH_RISE];
        double first = (double)s[CSG_STRETCH_SLOPE], last = (double)s[CSG_STRETCH_NEXT_SLOPE];
        if (angle.high < from || angle.low > from + 1 / inverse)
            continue;
        double at_first = 6 * rise - 4 * first - 2 * last,
               at_last = 2 * first + 4 * last - 6 * rise;
        most = fmax(most, inverse * inverse * size_of((span){at_first, at_last}));
    }
    return most * (1 + ROUNDING);
}

/* The angle atan2(y, x) over a box of the quadrant. */
static span angles_of(span x, span y)
{
    const double error = 4 * (double)FUNCTION_ERROR;
    return (span){(double)angle_of((float)y.low, (float)x.high) - error,
                  (double)angle_of((float)y.high, (float)x.low) + error};
}

/* F g of a factor F of the angle: its partial derivatives are F g_x - F' g y / (x^2 + y^2) and F
 * g_y + F' g x / (x^2 + y^2). */
static void shape_slopes(const csg_tape_node *node, const float *own, span x, span y,
                         csg_join_slopes *out)
{
    span angle = angles_of(x, y);
    double half = 0.5 * (angle.high - angle.low), bend = bend_of_profile(own, angle);
    curve middle = profile_at(own, (float)(angle.low + half));
    span steep = {(double)middle.slope - bend * half - ROUNDING,
                  (double)middle.slope + bend * half + ROUNDING};
    double change = size_of(steep) * half + ROUNDING;
    span factor = {(double)middle.value - change, (double)middle.value + change};
    double least = x.low * x.low + y.low * y.low, most = x.high * x.high + y.high * y.high;
    span g = {(double)join_at(node, own, (float)x.low, (float)y.low).value,
              (double)join_at(node, own, (float)x.high, (float)y.high).value};
    /* x, y and the root of x^2 + y^2 are in the proportions of 1 at most, g and the root of K */
    double far = 1.41421357 * size_of(steep);
    span by_x = {-far, far}, by_y = {-far, far};
    if (least > 0) {
        span turn = product(steep, product(g, (span){1 / most, 1 / least}));
        by_x = product((span){-turn.high, -turn.low}, y);
        by_y = product(turn, x);
    }
    out->by[0] = sum(product(factor, out->by[0]), by_x);
    out->by[1] = sum(product(factor, out->by[1]), by_y);
    for (int k = 0; k < 3; k++)
        out->bend[k] = INFINITY;
}

/* ---- joins over ranges -------------------------------------------------------------------------
 */

/* What rises with one operand and falls with the other. */
static void take_corners(const csg_tape_node *node, const float *own, span x, span y,
                         csg_join_slopes *out)
{
    mixture a = join_at(node, own, (float)x.low, (float)y.high);
    mixture b = join_at(node, own, (float)x.high, (float)y.low);
    out->by[0] = hull_of((double)a.a, (double)b.a);
    out->by[1] = hull_of((double)a.b, (double)b.b);
}

/* From the number that y^2, -x y, x^2 are times. */
static void take_bend(span x, span y, double number, csg_join_slopes *out)
{
    bool is_known = number < INFINITY;
    out->bend[0] = is_known ? number * y.high * y.high : INFINITY;
    out->bend[1] = is_known ? number * x.high * y.high : INFINITY;
    out->bend[2] = is_known ? number * x.high * x.high : INFINITY;
}

/* 1 / cube of a root, whose square is this at least. */
static double over_cube(double square)
{
    return square > 0 ? 1 / (square * sqrt(square)) : INFINITY;
}

/* A whole number n > 0 of times. */
static double to_power(double a, double n)
{
    double all = 1;
    for (int k = 0; k < (int)n; k++)
        all *= a;
    return all;
}

/* (n - 1) (x y)^(n - 2) / G^(2 n - 1), or with -n of an intersection: (n + 1) (x y)^(-n - 2) G^(2 n
 * + 1), for whole n of 2 and more. */
static double number_of_ricci(const csg_tape_node *node, const float *own, span x, span y)
{
    enum { MOST = 16 };
    double n = (double)own[CSG_RICCI_EXPONENT], least = x.low * y.low, most = x.high * y.high;
    double low = (double)join_at(node, own, (float)x.low, (float)y.low).value;
    double high = (double)join_at(node, own, (float)x.high, (float)y.high).value;
    if (n == 1 && node->join == CSG_JOIN_UNION)
        return 0;
    if (!(n >= 2 && n <= MOST && n == floor(n)))
        return INFINITY;
    if (node->join == CSG_JOIN_UNION)
        return low > 0 ? (n - 1) * to_power(most, n - 2) / to_power(low, 2 * n - 1) : INFINITY;
    return least > 0 ? (n + 1) * to_power(high, 2 * n + 1) / to_power(least, n + 2) : INFINITY;
}

/* al be / root^3 of an arc (soft_formulas.h), of an intersection times a^2 b^2. */
static double number_of_arc(const csg_tape_node *node, const float *own, span x, span y)
{
    double a = (double)own[CSG_ARC_A], b = (double)own[CSG_ARC_B];
    bool is_union = node->join == CSG_JOIN_UNION;
    double al = is_union ? 1 - a : 1 - b, be = is_union ? 1 - b : 1 - a;
    double p = is_union ? 1 : b, q = is_union ? 1 : a;
    double w = size_of(hull_of(a * y.low - b * x.high, a * y.high - b * x.low));
    double square = be * be * p * p * x.low * x.low + al * al * q * q * y.low * y.low - w * w;
    return al * be * p * p * q * q * over_cube(square);
}

/* 2 L^2 (r1 r2)^2 / root^3 of the scale function, L = 2 (r1 r2 - p). */
static double number_of_scale(const float *own, span x, span y)
{
    double r1 = (double)own[CSG_SCALE_R1], r2 = (double)own[CSG_SCALE_R2], area = r1 * r2;
    double bend = 2 * area * (1 - (double)own[CSG_SCALE_KAPPA]), reach = r1 + r2 + area;
    double d = fmax(0, fmax(x.low - y.high, y.low - x.high));
    double far = fmax(x.high - y.low, y.high - x.low), least = fmin(x.low, y.low);
    double q = fmax(0, fmin(r1 * (r2 * least - far), r2 * (r1 * least - far)));
    double square = bend * (bend * d * d + 4 * reach * q * d + 4 * q * q);
    return 2 * bend * bend * area * area * over_cube(square);
}

/* Partial derivatives of an arc that is sharp at 1/2: c_x / (1 + m' (c_x + c_y - 1)) with the unit
 * vector c from the centre (m, m) of its circle, of radius r. */
static void slopes_of_sharp(const csg_tape_node *node, const float *own, span x, span y,
                            csg_join_slopes *out)
{
    bool is_union = node->join == CSG_JOIN_UNION;
    span c = {(double)join_at(node, own, (float)x.low, (float)y.low).value * (1 - ROUNDING),
              (double)join_at(node, own, (float)x.high, (float)y.high).value * (1 + ROUNDING)};
    bool is_below = c.high<0.5, is_above = c.low> 0.5, is_square = is_below == is_union;
    for (int k = 0; k < 3; k++)
        out->bend[k] = INFINITY;
    out->by[0] = out->by[1] = (span){0, 1};
    if (!(c.low > 0) || (!is_below && !is_above))
        return;
    span root = {sqrt(c.low / 2), sqrt(c.high / 2)};
    span m = is_square ? (span){2 * c.low * c.low, 2 * c.high * c.high} : root;
    span slope =
        is_square ? (span){4 * c.low, 4 * c.high} : (span){0.25 / root.high, 0.25 / root.low};
    double turn = is_union ? 1 : -1;
    span radius = {turn * ((is_union ? c.low : c.high) - (is_union ? m.high : m.low)),
                   turn * ((is_union ? c.high : c.low) - (is_union ? m.low : m.high))};
    if (!(radius.low > 0))
        return;
    span along[2];
    for (int k = 0; k < 2; k++) {
        span at = k ? y : x;
        span over = is_union ? (span){at.low - m.high, at.high - m.low}
                             : (span){m.low - at.high, m.high - at.low};
        along[k] = unit(product((span){fmax(0, over.low), fmax(0, over.high)},
                                (span){1 / radius.high, 1 / radius.low}));
    }
    span other = along[0];
    for (int k = 0; k < 2; k++) { /* they are a cosine and a sine */
        span rest = k ? other : along[1];
        along[k].low = fmax(along[k].low, sqrt(fmax(0, 1 - rest.high * rest.high)));
        along[k].high = fmin(along[k].high, sqrt(fmax(0, 1 - rest.low * rest.low)));
    }
    span both = sum(along[0], along[1]);
    span under = {1 + slope.low * fmax(0, both.low - 1),
                  1 + slope.high * fmax(0, fmin(both.high, 1.41421357) - 1)};
    for (int k = 0; k < 2; k++)
        out->by[k] = unit((span){along[k].low / under.high, along[k].high / under.low});
}

static bool has_profile(const csg_tape_node *node, const float *own)
{
    return node->join_blend == CSG_BLEND_ARC && own[CSG_ARC_KNOTS] > 0;
}

bool csg_join_find_slopes(const csg_tape *tape, const csg_tape_node *node, span x, span y,
                          csg_join_slopes *out)
{
    const float *own = tape->parameters + node->join_parameters;
    x.low = fmax(x.low, 0);
    y.low = fmax(y.low, 0);
    *out = (csg_join_slopes){.bend = {0, 0, 0}};
    switch ((csg_blend_kind)node->join_blend) {
    case CSG_BLEND_RICCI:
        take_corners(node, own, x, y, out);
        take_bend(x, y, number_of_ricci(node, own, x, y), out);
        break;
    case CSG_BLEND_SCALE_SET:
        take_corners(node, own, x, y, out);
        take_bend(x, y, number_of_scale(own, x, y), out);
        break;
    case CSG_BLEND_ARC:
        take_corners(node, own, x, y, out);
        take_bend(x, y, number_of_arc(node, own, x, y), out);
        if (has_profile(node, own))
            shape_slopes(node, own, x, y, out);
        break;
    case CSG_BLEND_PERLIN:
        take_corners(node, own, x, y, out);
        out->bend[1] = 1;
        break;
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_SOFT_SET:
        out->by[0] = out->by[1] = (span){1, 1};
        return true;
    case CSG_BLEND_FIELD_SHARP:
        take_corners(node, own, x, y, out);
        for (int k = 0; k < 3 && out->by[0].low < out->by[0].high; k++)
            out->bend[k] = INFINITY;
        break;
    case CSG_BLEND_ARC_SHARP:
        slopes_of_sharp(node, own, x, y, out);
        break;
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END: /* TURNING */
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
        return false;
    }
    for (int k = 0; k < 2; k++) {
        if (out->by[k].low == 0 && out->by[k].high == 0) { /* it does not count */
            out->bend[0] = out->bend[1] = out->bend[2] = 0;
            continue;
        }
        double room = ROUNDING * (1 + size_of(out->by[k]));
        bool rises = !has_profile(node, own); /* with its operands */
        out->by[k].low = fmax(out->by[k].low - room, rises ? 0 : -INFINITY);
        out->by[k].high += room;
    }
    return size_of(out->by[0]) < INFINITY && size_of(out->by[1]) < INFINITY;
}

double csg_join_value(const csg_tape *tape, const csg_tape_node *node, double x, double y)
{
    const float *own = tape->parameters + node->join_parameters;
    float a = (float)fmax(x, 0), b = (float)fmax(y, 0);
    double value = (double)join_at(node, own, a, b).value;
    bool blends = has_profile(node, own) && arc_blends(own[CSG_ARC_A], own[CSG_ARC_B], a, b);
    return blends && a > 0 && b > 0 ? value * (double)profile_at(own, angle_of(b, a)).value : value;
}

/* ---- deliveries --------------------------------------------------------------------------------
 */

/* Of a function whose slope rises to one place and falls again. */
typedef struct hump {
    double from, to;               /* slopes at the ends */
    double low, high, top, at_top; /* the range of the argument; where the slope is largest */
} hump;

static void range_of_hump(hump h, csg_curve_slopes *out)
{
    out->least = fmin(h.from, h.to);
    out->most = fmax(h.from, h.to);
    if (h.low <= h.top && h.top <= h.high)
        out->most = fmax(out->most, h.at_top);
}

/* Of |c_0 + c_1 s + c_2 s^2|, s = d^2. */
static double most_of_bend(const float c[3], double from, double to)
{
    double s[3] = {from * from, to * to, 0}, most = 0;
    s[2] = c[2] != 0 ? fmax(s[0], fmin(s[1], -0.5 * (double)c[1] / (double)c[2])) : s[0];
    for (int k = 0; k < 3; k++)
        most = fmax(most, fabs((double)c[0] + s[k] * ((double)c[1] + s[k] * (double)c[2])));
    return most;
}

/* -P'(d) for d in low..high within 0..1. */
static csg_curve_slopes slopes_of_falloff(uint8_t curve_kind, float low, float high)
{
    csg_curve_slopes out = {.bend = INFINITY};
    hump h = {.low = (double)low, .high = (double)high};
    switch ((csg_tape_curve)curve_kind) {
#define CSG_FALLOFF(NAME, name, iso, steepest, steepest_at, doc)                                   \
    case CSG_CURVE_##NAME:                                                                         \
        h.from = -(double)falloff_##name(low).slope;                                               \
        h.to = -(double)falloff_##name(high).slope;                                                \
        h.at_top = (double)(steepest) + 1e-5;                                                      \
        h.top = steepest_at;                                                                       \
        out.bend = most_of_bend(bend_of_##name, h.low, h.high);                                    \
        break;
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
    case CSG_CURVE_STEP:
    case CSG_CURVE_CLAMP:
        break;
    }
    if (curve_kind == CSG_CURVE_QUADRATIC && high >= 1) /* creased there */
        out.bend = low >= 1 ? 0 : INFINITY;
    h.low -= 1e-4;
    h.high += 1e-4;
    range_of_hump(h, &out);
    return out;
}

/* Of H_3 from t = low to high: its second derivative rises by 27/4 up to 1/3 and falls from there
 * to 0 at 1. */
static csg_curve_slopes slopes_of_step(float low, float high)
{
    csg_curve_slopes out;
    double from = (double)low, to = (double)high, nearest = fmax(0, fmax(from, -to));
    double farthest = fmax(fabs(from), fabs(to)), top = fmin(fmax(nearest, 1.0 / 3), farthest);
    range_of_hump(
        (hump){(double)step_cubic(low).slope, (double)step_cubic(high).slope, from, to, 0, 1.125},
        &out);
    out.bend = fmin(6.75 * top, 3.375 * (1 - top));
    return out;
}

/* dF / dv of SOFTEN for v in low..high. */
static csg_curve_slopes slopes_of_soften(const csg_tape_node *node, const float *own, span at)
{
    float rate = own[CSG_SOFTEN_RATE], iso = own[CSG_SOFTEN_ISO];
    float low = (float)at.low, high = (float)at.high;
    csg_curve_slopes out = {.bend = 0};
    if (node->blend == CSG_CURVE_CLAMP) {
        float from = 0.5f + rate * low, to = 0.5f + rate * high;
        out.least = from > 1e-6f && to < 1 - 1e-6f ? 1 : 0;
        out.most = to >= 0 && from <= 1 ? 1 : 0;
        out.bend = out.least < out.most ? INFINITY : 0;
    } else if (node->blend == CSG_CURVE_STEP) {
        out = slopes_of_step(larger(smaller(rate * low, 1.0f), -1.0f),
                             larger(smaller(rate * high, 1.0f), -1.0f));
    } else {
        out = slopes_of_falloff(node->blend, distance_of(iso, rate, high),
                                distance_of(iso, rate, low));
    }
    if (!(out.most > 0)) /* all beyond an end */
        return (csg_curve_slopes){0, 0, 0};
    out.least = fmax(0, out.least - ROUNDING) * (double)rate;
    out.most = (out.most + ROUNDING) * (double)rate;
    out.bend = (out.bend + ROUNDING) * (double)rate * (double)rate;
    return out;
}

/* What brings an operator's field back to 0..1. */
typedef enum normal { NORMAL_NONE, NORMAL_SUM, NORMAL_SCALE } normal;

/* top, bend: of N_S (soft_formulas.h). */
static normal normal_of(const csg_tape_node *node, const float *own, float *top, float *bend)
{
    const float lift = own[CSG_SCALE_LIFT], right = 1.0f + own[CSG_SCALE_OMEGA];
    switch ((csg_blend_kind)node->blend) {
    case CSG_BLEND_SOFT_SET:
        return NORMAL_SUM;
    case CSG_BLEND_SCALE_SET:
        *top = own[CSG_SCALE_TOP];
        *bend = own[CSG_SCALE_BEND];
        return NORMAL_SCALE;
    case CSG_BLEND_END: /* TURNING: of two its join has done it, one alone turns by a right angle */
        *top = top_of_turned(lift, right);
        *bend = bend_of_turned(lift, right);
        return node->arity == 1 ? NORMAL_SCALE : NORMAL_NONE;
    case CSG_BLEND_SOFT_SUM:
    case CSG_BLEND_RICCI:
    case CSG_BLEND_PERLIN:
    case CSG_BLEND_ARC:
    case CSG_BLEND_ARC_SHARP:
    case CSG_BLEND_FIELD_SHARP:
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
    case CSG_BLEND_PROFILE:
    case CSG_BLEND_ORTHOGONAL:
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
        break;
    }
    return NORMAL_NONE;
}

/* dN / du of a rule for u in low..high. */
static csg_curve_slopes slopes_of_normal(const csg_tape_node *node, const float *own, span at)
{
    float low = (float)at.low, high = (float)at.high, top, bend;
    csg_curve_slopes out = {1, 1, 0};
    switch (normal_of(node, own, &top, &bend)) {
    case NORMAL_NONE:
        return out;
    case NORMAL_SUM:
        range_of_hump((hump){(double)normalise_sum(low).slope, (double)normalise_sum(high).slope,
                             at.low, at.high, 2.0 / 3, 4.0 / 3},
                      &out);
        double from = fmax(at.low, 0.5), to = fmin(at.high, 1);
        out.bend = from <= to ? fmax(fabs(16 - 24 * from), fabs(16 - 24 * to)) : 0;
        break;
    case NORMAL_SCALE: {
        bool is_full = low >= top, reaches = high >= top;
        out.least = reaches ? 0 : (double)normalise_scale(top, bend, low).slope;
        out.most = is_full ? 0 : 1 + 2 * (double)bend * fmax(0, (double)smaller(high, top) - 0.5);
        out.bend = is_full ? 0 : reaches ? INFINITY : high > 0.5f ? 2 * (double)bend : 0;
        break;
    }
    }
    out.least *= 1 - ROUNDING;
    out.most *= 1 + ROUNDING;
    out.bend *= 1 + ROUNDING;
    return out;
}

static const float *delivery_of(const csg_tape *tape, const csg_tape_node *node)
{
    const float *own = tape->parameters + node->parameters;
    return node->op == CSG_OP_SOFTEN ? own : own + CSG_RULE_DELIVER;
}

void csg_deliver_find_slopes(const csg_tape *tape, const csg_tape_node *node, span at,
                             csg_curve_slopes *out)
{
    const float *own = tape->parameters + node->parameters, *delivery = delivery_of(tape, node);
    if (node->op == CSG_OP_SOFTEN)
        *out = slopes_of_soften(node, own, at);
    else
        *out = slopes_of_normal(node, own, at);
    if (node->op != CSG_OP_SOFTEN && delivery[CSG_DELIVER_LOW] == 0 && at.high >= 1 &&
        out->most > 0) {
        out->least = 0; /* a field that is cut off */
        out->bend = INFINITY;
    }
    double scale = (double)delivery[CSG_DELIVER_SCALE];
    span turned = hull_of(scale * out->least, scale * out->most);
    *out = (csg_curve_slopes){turned.low, turned.high, fabs(scale) * out->bend};
}

/* F of SOFTEN, or N. */
static float field_at(const csg_tape_node *node, const float *own, float v)
{
    if (node->op == CSG_OP_SOFTEN) {
        float rate = own[CSG_SOFTEN_RATE];
        switch ((csg_tape_curve)node->blend) {
#define CSG_FALLOFF(NAME, name, iso, steepest, steepest_at, doc)                                   \
    case CSG_CURVE_##NAME:                                                                         \
        return falloff_##name(distance_of(own[CSG_SOFTEN_ISO], rate, v)).value;
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
        case CSG_CURVE_STEP:
            return step_cubic(larger(smaller(rate * v, 1.0f), -1.0f)).value;
        case CSG_CURVE_CLAMP:
            return clamped(0.5f + rate * v).value;
        }
    }
    float top, bend;
    switch (normal_of(node, own, &top, &bend)) {
    case NORMAL_SUM:
        return normalise_sum(v).value;
    case NORMAL_SCALE:
        return normalise_scale(top, bend, v).value;
    case NORMAL_NONE:
        break;
    }
    return v;
}

double csg_deliver_value(const csg_tape *tape, const csg_tape_node *node, double at)
{
    const float *own = tape->parameters + node->parameters, *delivery = delivery_of(tape, node);
    double f = (double)field_at(node, own, (float)at);
    double value = (double)delivery[CSG_DELIVER_SCALE] * (f - (double)delivery[CSG_DELIVER_LEVEL]) +
                   (double)delivery[CSG_DELIVER_SHIFT];
    return fmin(fmax(value, (double)delivery[CSG_DELIVER_LOW]), (double)delivery[CSG_DELIVER_HIGH]);
}
