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
 * 0 unless the step reaches beyond delta, as a sigmoid's. */
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
