/* SPDX-License-Identifier: MIT
 * See curve.h. The nearest ball (operators.md 1.1) is found by branch and bound: v is the least
 * |p - Q(t)| - r(t) known, and over a piece of the curve nothing is less than v where the Bernstein
 * coefficients of F = |p - Q|^2 - (r + v)^2 are not below 0, since with d = |p - Q| this is
 * (d - r - v) (d + r + v). The ends and a few Newton steps in each piece that is left make v small
 * soon.
 */
#include "scene/primitives/curve.h"

#include <float.h>
#include <string.h>

#include "scene/primitives/kinds.h"

csg_curve csg_curve_make(csg_primitive_kind kind, const double *parameters)
{
    csg_curve curve = {.degree = kind == CSG_NODE_QUADRATIC_TUBE ? 2 : 3};
    memcpy(curve.at, parameters, (size_t)(curve.degree + 1) * sizeof curve.at[0]);
    return curve;
}

void csg_curve_halve(const csg_curve *curve, csg_curve *low, csg_curve *high)
{
    int n = curve->degree;
    csg_curve left = {.degree = n}, right = *curve;
    for (int step = 0; step <= n; step++) {
        memcpy(left.at[step], right.at[0], sizeof left.at[0]);
        for (int i = 0; i < n - step; i++)
            for (int k = 0; k < CSG_CURVE_AXES; k++)
                right.at[i][k] = 0.5 * (right.at[i][k] + right.at[i + 1][k]);
    }
    *low = left;
    *high = right;
}

void csg_curve_at(const csg_curve *curve, double t, double out[CSG_CURVE_AXES])
{
    csg_curve c = *curve;
    for (int step = curve->degree; step > 0; step--)
        for (int i = 0; i < step; i++)
            for (int k = 0; k < CSG_CURVE_AXES; k++)
                c.at[i][k] = (1 - t) * c.at[i][k] + t * c.at[i + 1][k];
    memcpy(out, c.at[0], sizeof c.at[0]);
}

/* n . Q + r length is a polynomial: largest at an end or where its derivative is 0. */
double csg_curve_support(const csg_curve *curve, csg_vec3 n, double length)
{
    double w[CSG_CURVE_MOST] = {0}, d[3] = {0, 0, 0}, best = -INFINITY;
    for (int i = 0; i <= curve->degree; i++) {
        const double *at = curve->at[i];
        w[i] = n.x * at[0] + n.y * at[1] + n.z * at[2] + length * at[CSG_CURVE_RADIUS];
        if (i > 0)
            d[i - 1] = w[i] - w[i - 1];
    }
    best = fmax(w[0], w[curve->degree]);
    if (curve->degree == 2) /* as a cubic's derivative: twice the same */
        d[2] = d[1], d[1] = 0.5 * (d[0] + d[1]);
    /* d0 (1-t)^2 + 2 d1 t (1-t) + d2 t^2 = 0 */
    double root = d[1] * d[1] - d[0] * d[2];
    if (!(root >= 0))
        return best;
    double q = -(d[1] - d[0] + copysign(sqrt(root), d[1] - d[0])), a = d[0] - 2 * d[1] + d[2];
    const double roots[2] = {q / a, d[0] / q};
    for (int i = 0; i < 2; i++) {
        double at[CSG_CURVE_AXES];
        if (!(roots[i] > 0 && roots[i] < 1))
            continue;
        csg_curve_at(curve, roots[i], at);
        best = fmax(best, n.x * at[0] + n.y * at[1] + n.z * at[2] + length * at[CSG_CURVE_RADIUS]);
    }
    return best;
}

double csg_curve_only_radius(const csg_curve *curve)
{
    double r = curve->at[0][CSG_CURVE_RADIUS];
    for (int i = 1; i <= curve->degree; i++)
        if (curve->at[i][CSG_CURVE_RADIUS] != r)
            return 0;
    return r;
}

/* |second difference| n (n - 1) / 8 of a chord over the whole; it falls with the square. */
double csg_curve_chords(const csg_curve *curve, double within)
{
    double bend = 0;
    for (int i = 0; i + 2 <= curve->degree; i++) {
        double s[CSG_CURVE_AXES];
        for (int k = 0; k < CSG_CURVE_AXES; k++)
            s[k] = curve->at[i][k] - 2 * curve->at[i + 1][k] + curve->at[i + 2][k];
        bend = fmax(bend, sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) + fabs(s[3]));
    }
    double whole = curve->degree * (curve->degree - 1) * bend / 8;
    return fmax(ceil(sqrt(whole / within)), 1);
}

/* ---- the nearest ball ---------------------------------------------------------------------- */

enum { DEEPEST = 30, MOST_VISITS = 4000, SQUARE = 2 * (CSG_CURVE_MOST - 1) };

typedef struct piece {
    csg_curve curve; /* relative to the point */
    double low, width;
} piece;

typedef struct search {
    const csg_curve *curve; /* relative to the point */
    double least;           /* |Q| - r */
    double t, at[CSG_CURVE_AXES];
    bool settled; /* a minimum: Newton's step there is as good as 0 */
} search;

static void try_ball(search *s, double t, const double at[CSG_CURVE_AXES])
{
    double d = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) - at[CSG_CURVE_RADIUS];
    if (d < s->least) {
        s->least = d;
        s->t = t;
        s->settled = false;
        memcpy(s->at, at, sizeof s->at);
    }
}

/* Newton's step for Q . Q' = r' |Q| from the ball at t; NaN where that is no minimum. */
static double newton_step(const csg_curve *c, double t, const double at[CSG_CURVE_AXES])
{
    double first[CSG_CURVE_AXES], second[CSG_CURVE_AXES], n = c->degree;
    for (int k = 0; k < CSG_CURVE_AXES; k++) {
        double d[3], e[2];
        for (int i = 0; i < c->degree; i++)
            d[i] = n * (c->at[i + 1][k] - c->at[i][k]);
        for (int i = 0; i + 1 < c->degree; i++)
            e[i] = (n - 1) * (d[i + 1] - d[i]);
        bool cubic = c->degree == 3;
        double mid = cubic ? (1 - t) * d[1] + t * d[2] : d[1];
        first[k] =
            cubic ? (1 - t) * ((1 - t) * d[0] + t * d[1]) + t * mid : (1 - t) * d[0] + t * mid;
        second[k] = cubic ? (1 - t) * e[0] + t * e[1] : e[0];
    }
    double length = csg_norm3(at), radius = first[CSG_CURVE_RADIUS];
    double inner = length > 0 ? csg_dot3(at, first) / length : 0;
    double climb = csg_dot3(at, first) - radius * length;
    double steep = csg_dot3(first, first) + csg_dot3(at, second) -
                   second[CSG_CURVE_RADIUS] * length - radius * inner;
    return steep > 0 ? -climb / steep : NAN;
}

/* Down to the next minimum, within the piece. */
static void polish(search *s, double low, double high)
{
    double t = 0.5 * (low + high), at[CSG_CURVE_AXES];
    for (int i = 0; i < 8; i++) {
        csg_curve_at(s->curve, t, at);
        try_ball(s, t, at);
        double step = newton_step(s->curve, t, at), next = fmin(fmax(t + step, low), high);
        if (fabs(step) <= 1e-7) { /* settle() goes on */
            s->settled |= s->t == t;
            return;
        }
        if (!(step < 0 || step > 0) || next == t) /* no minimum */
            return;
        t = next;
    }
}

/* What is left of t counts with its square in the value, but not in the gradient. */
static void settle(search *s)
{
    search now = *s;
    for (int i = 0; i < 3; i++) {
        double step = newton_step(s->curve, now.t, now.at);
        if (!(fabs(step) < 1e-4))
            return;
        now.t = fmin(fmax(now.t + step, 0), 1);
        csg_curve_at(s->curve, now.t, now.at);
    }
    double away = csg_norm3(now.at);
    now.least = away - now.at[CSG_CURVE_RADIUS];
    if (now.least <= s->least + 4 * DBL_EPSILON * away)
        *s = now;
}

/* Bernstein coefficients of F over the piece. */
static void coefficients(const csg_curve *c, double v, double out[SQUARE + 1])
{
    static const double choose[2][4] = {{1, 2, 1, 0}, {1, 3, 3, 1}};
    static const double whole[2][7] = {{1, 4, 6, 4, 1, 0, 0}, {1, 6, 15, 20, 15, 6, 1}};
    int n = c->degree;
    for (int k = 0; k <= SQUARE; k++)
        out[k] = 0;
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= n; j++) {
            double a = c->at[i][CSG_CURVE_RADIUS] + v, b = c->at[j][CSG_CURVE_RADIUS] + v;
            double weight = choose[n - 2][i] * choose[n - 2][j] / whole[n - 2][i + j];
            out[i + j] += weight * (csg_dot3(c->at[i], c->at[j]) - a * b);
        }
}

/* Nothing in the piece is less than v, but for a part of 1e-14; or F is convex there and touches 0
 * where the least known is, which has settled. */
static bool is_beaten(const search *s, const piece *now, bool settled)
{
    const csg_curve *c = &now->curve;
    double f[SQUARE + 1], radius = INFINITY, largest = 0, least = INFINITY, bend = INFINITY;
    coefficients(c, s->least, f);
    for (int i = 0; i <= c->degree; i++) {
        radius = fmin(radius, c->at[i][CSG_CURVE_RADIUS]);
        largest = fmax(largest, c->at[i][CSG_CURVE_RADIUS]);
    }
    if (largest + s->least <= 0) /* not even balls around the point would do */
        return true;
    for (int k = 0; k <= 2 * c->degree; k++)
        least = fmin(least, f[k]);
    double reach = fmax(radius + s->least, 0);
    if (least >= -2e-14 * reach * reach)
        return true;
    if (!settled || !(s->t > now->low && s->t < now->low + now->width))
        return false;
    for (int k = 1; k < 2 * c->degree; k++)
        bend = fmin(bend, f[k - 1] - 2 * f[k] + f[k + 1]);
    return bend > 0;
}

double csg_curve_nearest(const csg_curve *curve, csg_vec3 p, csg_vec3 *to)
{
    piece stack[DEEPEST + 2];
    csg_curve moved = *curve;
    const double by[3] = {p.x, p.y, p.z};
    for (int i = 0; i <= curve->degree; i++)
        for (int k = 0; k < 3; k++)
            moved.at[i][k] -= by[k];
    search s = {.curve = &moved, .least = INFINITY};
    memcpy(s.at, moved.at[0], sizeof s.at);
    try_ball(&s, 0, moved.at[0]);
    try_ball(&s, 1, moved.at[curve->degree]);
    int count = 0, visits = 0;
    stack[count++] = (piece){moved, 0, 1};
    while (count > 0 && visits++ < MOST_VISITS) {
        piece now = stack[--count];
        if (is_beaten(&s, &now, false))
            continue;
        polish(&s, now.low, now.low + now.width);
        if (now.width < ldexp(1.5, -DEEPEST) || is_beaten(&s, &now, s.settled))
            continue;
        bool low_first = s.t < now.low + 0.5 * now.width;
        piece *low = &stack[count + low_first], *high = &stack[count + !low_first];
        csg_curve_halve(&now.curve, &low->curve, &high->curve);
        low->width = high->width = 0.5 * now.width;
        low->low = now.low;
        high->low = now.low + low->width;
        count += 2;
    }
    settle(&s);
    *to = csg_vec3_make(s.at[0], s.at[1], s.at[2]);
    return -s.least;
}
