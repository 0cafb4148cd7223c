/* SPDX-License-Identifier: MIT
 * Operators on fields in [0, 1] in double precision (operators.md 5 and 6): values and partial
 * derivatives. An operand that alone matters is given back as it is, bit for bit.
 */
#include <assert.h>
#include <math.h>

#include "base/elementary.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/choice.h"
#include "scene/operators/rule.h"
#include "scene/operators/rule_private.h"

#define DEGREE 0.017453292519943295
#define C 0.5

static double sharp(bool is_union, const double *values, size_t count, double *partials)
{
    size_t at = is_union ? csg_largest_of(values, count) : csg_smallest_of(values, count);
    return csg_choose(values, count, at, partials);
}

/* ---- n-ary ------------------------------------------------------------------------------------
 */

static double ricci_union(double n, const double *values, size_t count, double *partials)
{
    double most = values[csg_largest_of(values, count)], sum = 0;
    for (size_t i = 0; i < count; i++)
        partials[i] = n == 1;
    if (most <= 0)
        return 0;
    for (size_t i = 0; i < count; i++)
        sum += csg_pow(values[i] / most, n);
    double value = most * csg_pow(sum, 1 / n);
    for (size_t i = 0; i < count && n != 1; i++)
        partials[i] = csg_pow(values[i] / value, n - 1);
    return value;
}

static double ricci_intersection(double n, const double *values, size_t count, double *partials)
{
    double least = values[csg_smallest_of(values, count)], sum = 0;
    for (size_t i = 0; i < count; i++)
        partials[i] = 0;
    if (least <= 0)
        return 0;
    for (size_t i = 0; i < count; i++)
        sum += csg_pow(least / values[i], n);
    double share = csg_pow(sum, -1 / n);
    for (size_t i = 0; i < count; i++)
        partials[i] = csg_pow(share * least / values[i], n + 1);
    return least * share;
}

double csg_normalise_soft(double u, double *slope)
{
    *slope = u < 0.5 ? 1 : u < 1 ? -4 * (u - 1) * (3 * u - 1) : 0;
    return u < 0.5 ? u : u < 1 ? 1 - 4 * u * (u - 1) * (u - 1) : 1;
}

/* Sums of the operands, or of their complements, as they are or normalised. */
static double summed(bool is_union, bool normalised, const double *values, size_t count,
                     double *partials)
{
    double sum = 0, slope = 1;
    for (size_t i = 0; i < count; i++)
        sum += is_union ? values[i] : 1 - values[i];
    if (normalised)
        sum = csg_normalise_soft(sum, &slope);
    for (size_t i = 0; i < count; i++)
        partials[i] = slope;
    return is_union ? sum : 1 - sum;
}

/* The union step by step as u + x - u x, which leaves a lone operand as it is. */
static double product(bool is_union, const double *values, size_t count, double *partials)
{
    double before = 1, after = 1, united = 0;
    for (size_t i = 0; i < count; i++) {
        partials[i] = before;
        before *= is_union ? 1 - values[i] : values[i];
        united = united + values[i] - united * values[i];
    }
    for (size_t i = count; i-- > 0;) {
        partials[i] *= after;
        after *= is_union ? 1 - values[i] : values[i];
    }
    return is_union ? united : before;
}

/* ---- scale functions --------------------------------------------------------------------------
 */

double csg_scale_top(double r1, double r2, double kappa)
{
    double s = sqrt(2 * r1 * r2 * (1 - kappa));
    return (r1 + r2 + s) / (r1 + r2 + r1 * r2 + s);
}

/* The polynomial through (1/2, 1/2) with slope 1 and through (m, 1). */
double csg_normalise_scale(double u, double m, double *slope)
{
    double a = (1 - m) / ((m - 0.5) * (m - 0.5)), x = u - 0.5;
    *slope = u < 0.5 ? 1 : u <= m ? 1 + 2 * a * x : 0;
    return u < 0.5 ? u : u < m ? u + a * x * x : 1;
}

double csg_scale_function(double r1, double r2, double kappa, const double x[2], double partials[2])
{
    bool first = x[0] <= x[1];
    double mn = first ? x[0] : x[1], mx = first ? x[1] : x[0];
    double ra = first ? r1 : r2, rb = first ? r2 : r1;
    partials[!first] = 1; /* outside of the blending range the smaller operand */
    partials[first] = 0;
    if (!(mn > 0) || ra * (rb - (mx - mn) / mn) <= 0)
        return mn;
    double d = (mx - mn) / mn, q = ra * (rb - d), P = r1 + r2 + r1 * r2;
    double L = 2 * r1 * r2 * (1 - kappa);
    double drop =
        2 * q * q / (2 * P * q + L * d + sqrt(L * (L * d * d + 4 * P * q * d + 4 * q * q)));
    double h = 1 - drop; /* all lengths are parts of the smaller operand */
    double u = fmax(x[0] / mn - h, 0) / (r1 * h), v = fmax(x[1] / mn - h, 0) / (r2 * h);
    double root = sqrt(L / (r1 * r2)), w = 2 * sqrt(u * v);
    double w1 = (w + root * v) / r1, w2 = (w + root * u) / r2;
    double N = (1 + r1 * u) * w1 + (1 + r2 * v) * w2;
    if (N > 0) {
        partials[0] = w1 / N;
        partials[1] = w2 / N;
    }
    return mn * h;
}

double csg_scale_set(const csg_rule *rule, bool is_union, double turn, double top_turn,
                     const double *values, double *partials)
{
    const double *v = rule->parameters;
    double kappa = v[2] / (v[0] * v[1]), slope;
    double x[2] = {is_union ? 1 - values[0] : values[0], is_union ? 1 - values[1] : values[1]};
    double h = csg_scale_function(v[0] * turn, v[1] * turn, kappa, x, partials);
    double m = csg_scale_top(v[0] * top_turn, v[1] * top_turn, kappa);
    double value = csg_normalise_scale(fmin(h, m), m, &slope); /* m is B(1, 1) */
    partials[0] *= slope;
    partials[1] *= slope;
    return is_union ? 1 - value : value;
}

static double scale_set(const csg_rule *rule, bool is_union, double cosine, const double *values,
                        double *partials)
{
    double debulge = rule->parameters[3], turn = debulge > 0 ? 1 - cosine + debulge : 1;
    return csg_scale_set(rule, is_union, turn, turn, values, partials);
}

/* ---- arcs of ellipses -------------------------------------------------------------------------
 */

/* Both are homogeneous: (x, y) is divided by its larger part before, so that nothing underflows. */
static double arc_union(double a, double b, double x, double y, double partials[2])
{
    double al = 1 - a, be = 1 - b, w = a * y - b * x, nu = be * be * x * x + al * al * y * y;
    double root = sqrt(fmax(nu - w * w, 0));
    double g = nu / (be * be * a * x + al * al * b * y + al * be * root);
    double nx = be * be * (x - a * g), ny = al * al * (y - b * g), D = x * nx + y * ny;
    partials[0] = nx * g / D;
    partials[1] = ny * g / D;
    return g;
}

/* a = 1 / A, b = 1 / B of operators.md 5.3, multiplied through by a^2 b^2. */
static double arc_intersection(double a, double b, double x, double y, double partials[2])
{
    double al = 1 - a, be = 1 - b, w = b * y - a * x;
    double under = be * be * a * a * x * x + al * al * b * b * y * y - w * w;
    double g = (be * be * a * x + al * al * b * y + al * be * sqrt(fmax(under, 0))) /
               (be * be + al * al - al * al * be * be);
    double nx = be * be * a * (g - a * x), ny = al * al * b * (g - b * y), D = x * nx + y * ny;
    partials[0] = nx * g / D;
    partials[1] = ny * g / D;
    return g;
}

static double tangent(double degrees)
{
    return degrees == 45 ? 1 : csg_tan(degrees * DEGREE);
}

/* Of angles theta1, theta2; without the profile. */
double csg_plain_arc(const csg_rule *rule, bool is_union, const double *values, double *partials)
{
    double t1 = tangent(rule->parameters[0]), t2 = tangent(90 - rule->parameters[1]);
    double x = values[0], y = values[1], most = fmax(x, y);
    bool below = y <= t1 * x, above = x <= t2 * y;
    if (below || above)
        return csg_choose(values, 2, is_union ? !below : below, partials);
    if (t1 == 1 || t2 == 1)
        return sharp(is_union, values, 2, partials);
    return most * (is_union ? arc_union(t2, t1, x / most, y / most, partials)
                            : arc_intersection(t1, t2, x / most, y / most, partials));
}

static double arc(const csg_rule *rule, bool is_union, const double *values, double *partials)
{
    double g = csg_plain_arc(rule, is_union, values, partials), x = values[0], y = values[1], slope;
    if (!rule->spline.count || !(x > 0 && y > 0))
        return g;
    double factor = csg_spline_at(&rule->spline, csg_atan2(y, x), &slope);
    double square = x * x + y * y;
    partials[0] = factor * partials[0] - slope * g * (y / square);
    partials[1] = factor * partials[1] + slope * g * (x / square);
    return factor * g;
}

/* ---- sharp at the surface, smooth around it ----------------------------------------------------
 */

/* A root of phi in [low, high] from `at`, where phi changes sign once: Newton's method, halving
 * where it leaves the bracket. phi falls (sign 1) or rises (-1). */
typedef double arc_phi(double c, double x, double y, double *slope);

static double bracketed_root(arc_phi *phi, double x, double y, double low, double high, double at,
                             double sign)
{
    for (int i = 0; i < 80; i++) {
        double slope, value = phi(at, x, y, &slope);
        if (sign * value > 0)
            low = at;
        else
            high = at;
        double next = at - value / slope;
        if (!(next >= low && next <= high))
            next = (low + high) / 2;
        if (fabs(next - at) <= 1e-16 * fabs(at))
            return next;
        at = next;
    }
    return at;
}

/* r = |(x - m, y - m)|, *growth = dr / dm */
static double radius(double m, double x, double y, double *growth)
{
    double r = csg_hypot(x - m, y - m);
    *growth = r > 0 ? (2 * m - x - y) / r : sqrt(2);
    return r;
}

static double union_square(double c, double x, double y, double *slope)
{
    double growth, m = c * c / C, r = radius(m, x, y, &growth);
    *slope = 2 * c / C * (growth + 1) - 1;
    return r - (c - m);
}

static double union_root(double c, double x, double y, double *slope)
{
    double growth, m = sqrt(C * c), r = radius(m, x, y, &growth);
    *slope = sqrt(C / c) / 2 * (growth + 1) - 1;
    return r - (c - m);
}

/* In the centre m, which is sqrt(C c). */
static double intersection_root(double m, double x, double y, double *slope)
{
    double growth, r = radius(m, x, y, &growth);
    *slope = 1 - 2 * m / C - growth;
    return m - m * m / C - r;
}

static double intersection_square(double c, double x, double y, double *slope)
{
    double growth, m = c * c / C, r = radius(m, x, y, &growth);
    *slope = 2 * c / C * (1 - growth) - 1;
    return (m - c) - r;
}

/* Partial derivatives on the circle around (m, m); `speed` = dm / dc. */
static void on_circle(const double *values, double m, double speed, double *partials)
{
    double dx = fabs(values[0] - m), dy = fabs(values[1] - m), r = csg_hypot(dx, dy);
    if (!(r > 0)) { /* at the crease any mixture is a gradient */
        partials[0] = partials[1] = 0.5;
        return;
    }
    double D = 1 + speed * ((dx + dy) / r - 1);
    partials[0] = dx / r / D;
    partials[1] = dy / r / D;
}

static double arc_sharp(bool is_union, const double *values, double *partials)
{
    double x = values[0], y = values[1], mx = fmax(x, y), mn = fmin(x, y), c;
    bool square_below = C * mn > mx * mx, above = mn * mn > C * mx;
    if (!square_below && !above)
        return sharp(is_union, values, 2, partials);
    if (is_union)
        c = square_below ? bracketed_root(union_square, x, y, mx, sqrt(C * mn), mx, 1)
                         : bracketed_root(union_root, x, y, mx, mn * mn / C, mx, 1);
    else if (above)
        c = bracketed_root(intersection_square, x, y, sqrt(C * mx), mn, mn, 1);
    else {
        double m = bracketed_root(intersection_root, x, y, mx, sqrt(C * mn), sqrt(C * mn), 1);
        c = m * m / C;
    }
    bool square = is_union == square_below;
    on_circle(values, square ? c * c / C : sqrt(C * c), square ? 2 * c / C : sqrt(C / c) / 2,
              partials);
    return c;
}

/* ---- all of them ------------------------------------------------------------------------------
 */

double csg_rule_apply(const csg_rule *rule, bool is_union, const double *values, size_t count,
                      double cosine, double *partials)
{
    const double *v = rule->parameters;
    if (count == 1)
        return csg_choose(values, 1, 0, partials);
    switch ((csg_blend_kind)rule->kind) {
    case CSG_BLEND_EXTERIOR:
    case CSG_BLEND_INTERIOR:
        return csg_rule_lengths(rule, values, partials);
    case CSG_BLEND_RICCI:
        return is_union ? ricci_union(v[0], values, count, partials)
                        : ricci_intersection(v[0], values, count, partials);
    case CSG_BLEND_SOFT_SUM:
        return summed(is_union, false, values, count, partials);
    case CSG_BLEND_SOFT_SET:
        return summed(is_union, true, values, count, partials);
    case CSG_BLEND_PERLIN:
        return product(is_union, values, count, partials);
    case CSG_BLEND_SCALE_SET:
        return scale_set(rule, is_union, cosine, values, partials);
    case CSG_BLEND_ARC:
        return arc(rule, is_union, values, partials);
    case CSG_BLEND_ARC_SHARP:
        return arc_sharp(is_union, values, partials);
    case CSG_BLEND_FIELD_SHARP:
        return sharp(is_union, values, count, partials);
    case CSG_BLEND_PROFILE: /* a combine node */
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME:
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        assert(!"a rule that is applied");
    }
    return NAN;
}
