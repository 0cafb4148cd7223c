/* SPDX-License-Identifier: MIT
 * The two smooth maxima of smooth unit steps in double precision (operators.md 7.2, 7.3): written
 * as the larger operand plus an excess or minus a dent, so that it stays bit for bit where they do
 * not blend.
 */
#include <math.h>

#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/rule_private.h"

/* 1 - mu(s) on the right, mu(-s) on the left, and its derivative by s. */
static double rest_of(csg_step step, bool right, double s, double *slope)
{
    double value = csg_step_at(step, right ? s : -s, slope);
    *slope = -*slope;
    return right ? 1 - value : value;
}

/* (S_abs(t) - |t|) / 2 with A = 1 - g2, B = 1 - g1: A (t - delta)^2 / (2 delta) - B (t + A p). B is
 * 0 unless the step reaches beyond delta, as a sigmoid's, or one with eps > delta. */
double csg_rule_exterior_excess(const csg_rule *rule, bool right, double t, double *slope)
{
    double delta = rule->parameters[0], eps = rule->parameters[1], da, db;
    double a = rest_of(rule->step, right, (t - delta) / eps, &da);
    double b = rest_of(rule->step, right, (t + delta) / eps, &db);
    double p = t * t / (2 * delta) + delta / 2, x = t - delta;
    da /= eps;
    db /= eps;
    *slope = (da * x * x / (2 * delta) + a * x / delta - db * (t + a * p) -
              b * (1 + da * p + a * t / delta)) /
             2;
    return (a * x * x / (2 * delta) - b * (t + a * p)) / 2;
}

bool csg_rule_is_wide(const csg_rule *rule)
{
    return rule->kind == CSG_BLEND_EXTERIOR && rule->step.kind != CSG_STEP_SIGMOID &&
           rule->parameters[1] > rule->parameters[0];
}

static void scan_stretch(const csg_rule *rule, bool right, double from, double to,
                         csg_exterior_facts *facts)
{
    enum { SAMPLES = 1024 };
    const double within = 1e-9; /* slopes jump at the ends of some steps */
    for (int i = 0; i <= SAMPLES; i++) {
        double part = fmin(fmax((double)i / SAMPLES, within), 1 - within), slope;
        double t = from + (to - from) * part;
        double excess = csg_rule_exterior_excess(rule, right, t, &slope) / rule->parameters[0];
        facts->least = fmin(facts->least, excess);
        facts->most = fmax(facts->most, excess);
        facts->k = fmax(facts->k, fabs(1 + slope) + fabs(slope));
    }
}

csg_exterior_facts csg_rule_scan_exterior(const csg_rule *rule)
{
    double delta = rule->parameters[0], eps = rule->parameters[1];
    double least_at = fmin(delta, eps - delta); /* there it is lost first */
    csg_exterior_facts facts = {0, 0, 1};
    for (int right = 0; right < 2; right++) {
        scan_stretch(rule, right, 0, least_at, &facts);
        scan_stretch(rule, right, least_at, eps - delta, &facts);
        scan_stretch(rule, right, eps - delta, eps + delta, &facts);
    }
    return facts;
}

/* eps s (1 - mu(s)); the first operand is the larger where s < 0 in operators.md. */
double csg_rule_interior_dent(const csg_rule *rule, bool right, double t, double *slope)
{
    double eps = rule->parameters[0], s = t / eps, fall;
    double rest = rest_of(rule->step, !right, s, &fall);
    *slope = rest + s * fall;
    return t * rest;
}

double csg_rule_lengths(const csg_rule *rule, const double *values, double *partials)
{
    bool right = values[0] >= values[1];
    double most = values[!right], t = most - values[right], slope = 0, value = most;
    if (t < csg_rule_support(rule)) { /* not where one is infinite */
        if (rule->kind == CSG_BLEND_EXTERIOR) {
            value = most + csg_rule_exterior_excess(rule, right, t, &slope);
        } else {
            value = most - csg_rule_interior_dent(rule, right, t, &slope);
            slope = -slope;
        }
    }
    partials[!right] = 1 + slope;
    partials[right] = -slope;
    return value;
}

/* ---- slopes over a range of leads --------------------------------------------------------------
 */

typedef struct step_range {
    double low, high, least_slope, most_slope; /* of mu and mu' */
} step_range;

/* mu rises; mu' of an even step rises up to 0 and falls from there. */
static step_range step_over(csg_step step, double from, double to)
{
    double first, last, middle = 0;
    step_range r = {.low = csg_step_at(step, from, &first), .high = csg_step_at(step, to, &last)};
    if (from <= 0 && to >= 0)
        csg_step_at(step, 0, &middle);
    r.least_slope = fmin(first, last);
    r.most_slope = fmax(fmax(first, last), middle);
    return r;
}

static double least_product(double a, double b, double c, double d)
{
    return fmin(fmin(a * c, a * d), fmin(b * c, b * d));
}

/* 1 - w, w = mu(s) + s mu'(s) with s = -t / eps. */
static void bound_interior(const csg_rule *rule, double low, double high, double out[2])
{
    double eps = rule->parameters[0], from = -high / eps, to = -low / eps;
    step_range mu = step_over(rule->step, from, to);
    double least = least_product(from, to, mu.least_slope, mu.most_slope);
    double most = -least_product(-to, -from, mu.least_slope, mu.most_slope);
    out[0] = 1 - mu.high - most;
    out[1] = 1 - mu.low - least;
}

/* S' of leads t >= 0: 1 + eps / delta ((1 - mu) u - mu' u^2 / 2), u = (t - delta) / eps. */
static void bound_exterior(const csg_rule *rule, double low, double high, double out[2])
{
    double delta = rule->parameters[0], eps = rule->parameters[1], by = eps / delta;
    double from = (low - delta) / eps, to = (high - delta) / eps;
    step_range mu = step_over(rule->step, from, to);
    double least = least_product(from, to, 1 - mu.high, 1 - mu.low);
    double most = -least_product(-to, -from, 1 - mu.high, 1 - mu.low);
    double square = fmax(from * from, to * to);
    double least_square = from <= 0 && to >= 0 ? 0 : fmin(from * from, to * to);
    out[0] = 1 + by * (least - 0.5 * mu.most_slope * square);
    out[1] = 1 + by * (most - 0.5 * mu.least_slope * least_square);
}

void csg_rule_bound_share(const csg_rule *rule, double k, double low, double high, double out[2])
{
    double support = csg_rule_support(rule);
    bool is_local = rule->step.kind != CSG_STEP_SIGMOID;
    bool is_even = rule->step.kind != CSG_STEP_RISING;
    out[0] = (1 - k) / 2;
    out[1] = (1 + k) / 2;
    if (low >= support || high <= -support) {
        out[0] = out[1] = low > 0;
    } else if (rule->kind == CSG_BLEND_INTERIOR && is_even) {
        double bound[2];
        bound_interior(rule, low, high, bound);
        out[0] = fmax(out[0], bound[0]);
        out[1] = fmin(out[1], bound[1]);
    } else if (rule->kind == CSG_BLEND_EXTERIOR && is_even && is_local && !csg_rule_is_wide(rule)) {
        double right[2] = {INFINITY, -INFINITY}, left[2] = {INFINITY, -INFINITY};
        if (high >= 0)
            bound_exterior(rule, fmax(low, 0), high, right);
        if (low <= 0)
            bound_exterior(rule, fmax(-high, 0), -low, left);
        out[0] = fmax(out[0], (1 + fmin(right[0], -left[1])) / 2);
        out[1] = fmin(out[1], (1 + fmax(right[1], -left[0])) / 2);
    }
}
