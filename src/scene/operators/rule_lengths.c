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
