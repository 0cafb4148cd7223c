/* SPDX-License-Identifier: MIT
 * Smooth unit steps in double precision (operators.md 7.1): mu, its derivative, and the extreme
 * values that bounds of the two smooth maxima need, found numerically.
 */
#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "base/elementary.h"

#include "scene/operators/steps.h"

#define PI 3.14159265358979323846

enum { MOST_DEGREE = 8 };

const char *csg_step_name(csg_step_kind kind)
{
    static const char *const names[] = {
#define CSG_STEP(NAME, name, standard, least, most, whole, even, doc) #name,
#include "scene/operators/steps.def"
#undef CSG_STEP
    };
    assert((unsigned)kind < CSG_STEP_COUNT);
    return names[kind];
}

/* f_0 .. f_n at tau, tau - 1, ...: distribution functions of sums of uniform variables, of which
 * the last two give value and derivative. tau <= n / 2, so that nothing cancels. */
static double polynomial(int n, double tau, double *slope)
{
    double f[MOST_DEGREE + 1];
    for (int j = 0; j <= n; j++)
        f[j] = tau - j > 0 ? 1 : tau - j < 0 ? 0 : 0.5;
    for (int k = 1; k < n; k++)
        for (int j = 0; j + k <= n; j++)
            f[j] = (tau - j) / k * f[j] + (1 - (tau - j) / k) * f[j + 1];
    *slope = 0.5 * n * (f[0] - f[1]);
    return tau / n * f[0] + (1 - tau / n) * f[1];
}

static double even_polynomial(int n, double t, double *slope)
{
    if (t >= 1 || t <= -1)
        return t >= 1;
    double value = polynomial(n, n * (1 - fabs(t)) / 2, slope);
    return t > 0 ? 1 - value : value;
}

/* R_n and its derivative by the chain rule. */
static double rising(int n, double t, double *slope)
{
    if (t >= 1 || t <= -1)
        return t >= 1;
    double u = t, chain = 1;
    for (int i = 1; i < n; i++) {
        chain *= PI / 2 * csg_cos(PI * u / 2);
        u = csg_sin(PI * u / 2);
    }
    *slope = PI / 4 * csg_cos(PI / 4 * (1 + u)) * chain;
    return csg_sin(PI / 4 * (1 + u));
}

/* (1 + sin(pi u / 2)) / 2, which is R_n^2, keeps its digits where R_n is small. */
static double rising_square(int n, double t, double *slope)
{
    double root_slope = 0, root = rising(n, -fabs(t), &root_slope);
    *slope = 2 * root * root_slope;
    return t > 0 ? 1 - root * root : root * root;
}

/* Exactly 0 and 1 from where rounding would make it so. */
static double sigmoid(double alpha, double t, double *slope)
{
    double x = alpha * fabs(t);
    if (x >= CSG_SIGMOID_END)
        return t > 0;
    double e = csg_exp(-x), small = e / (1 + e);
    *slope = alpha * small / (1 + e);
    return t > 0 ? 1 - small : small;
}

double csg_step_at(csg_step step, double t, double *slope)
{
    *slope = 0;
    int n = (int)step.parameter;
    switch (step.kind) {
    case CSG_STEP_POLY:
    case CSG_STEP_BSPLINE:
        return even_polynomial(n, t, slope);
    case CSG_STEP_RISING:
        return rising(n, t, slope);
    case CSG_STEP_RISING2:
        return rising_square(n, t, slope);
    case CSG_STEP_SIGMOID:
        return sigmoid(step.parameter, t, slope);
    case CSG_STEP_COUNT:
        break;
    }
    assert(!"a step");
    return NAN;
}

double csg_step_reach(csg_step step)
{
    return step.kind == CSG_STEP_SIGMOID ? fmax(1, CSG_SIGMOID_END / step.parameter) : 1;
}

/* ---- extreme values ---------------------------------------------------------------------------
 */

typedef enum measure {
    DENT_RIGHT,  /* s (1 - mu(s)) */
    DENT_LEFT,   /* s mu(-s) */
    BUMP_RIGHT,  /* u^2 (1 - mu(u)) */
    BUMP_LEFT,   /* u^2 mu(-u) */
    RISE,        /* mu(s) + s mu'(s) */
    FALL,        /* minus that */
    BULGE_RIGHT, /* d/du (1 - mu(u)) u^2 / 2 */
    BULGE_LEFT   /* d/du mu(-u) u^2 / 2 */
} measure;

static double measured(csg_step step, measure what, double s)
{
    double slope, value;
    bool left = what == DENT_LEFT || what == BUMP_LEFT || what == BULGE_LEFT;
    value = csg_step_at(step, left ? -s : s, &slope);
    double rest = left ? value : 1 - value;
    switch (what) {
    case DENT_RIGHT:
    case DENT_LEFT:
        return s * rest;
    case BUMP_RIGHT:
    case BUMP_LEFT:
        return s * s * rest;
    case RISE:
        return value + s * slope;
    case FALL:
        return -value - s * slope;
    case BULGE_RIGHT:
    case BULGE_LEFT:
        break;
    }
    return s * rest - s * s / 2 * slope;
}

/* The largest on [low, high]: the best of many samples, then golden sections around it. */
static double largest_of(csg_step step, measure what, double low, double high, double *at)
{
    enum { SAMPLES = 512, SECTIONS = 70 };
    const double golden = 0.61803398874989485;
    double best = -INFINITY, width = (high - low) / SAMPLES;
    *at = low;
    for (int i = 0; i <= SAMPLES; i++) {
        double s = low + width * i, value = measured(step, what, s);
        if (value > best) {
            best = value;
            *at = s;
        }
    }
    double a = fmax(low, *at - width), b = fmin(high, *at + width);
    for (int i = 0; i < SECTIONS; i++) {
        double c = b - golden * (b - a), d = a + golden * (b - a);
        if (measured(step, what, c) > measured(step, what, d))
            b = d;
        else
            a = c;
    }
    double value = measured(step, what, (a + b) / 2);
    if (value > best) {
        best = value;
        *at = (a + b) / 2;
    }
    return best;
}

/* The sigmoid's extremes lie a few 1 / alpha from its middle. */
csg_step_facts csg_step_find_facts(csg_step step)
{
    csg_step_facts f;
    double reach = step.kind == CSG_STEP_SIGMOID ? fmax(1, 8 / step.parameter) : 1, at = 0;
    f.dent[0] = largest_of(step, DENT_RIGHT, 0, reach, &f.dent_at[0]);
    f.dent[1] = largest_of(step, DENT_LEFT, 0, reach, &f.dent_at[1]);
    f.bump[0] = largest_of(step, BUMP_RIGHT, 0, reach, &f.bump_at[0]);
    f.bump[1] = largest_of(step, BUMP_LEFT, 0, reach, &f.bump_at[1]);
    double rise = largest_of(step, RISE, -reach, reach, &at);
    double fall = largest_of(step, FALL, -reach, reach, &at);
    f.interior = fmax(2 * rise - 1, 1 + 2 * fall);
    f.exterior = fmax(largest_of(step, BULGE_RIGHT, 0, reach, &at),
                      largest_of(step, BULGE_LEFT, 0, reach, &at));
    return f;
}
