/* SPDX-License-Identifier: MIT
 * See cone_curve.h. The gradient at q' is the direction from there to the centre of its nearest
 * ball. Where q' is within rho of q, that ball reaches q to within 2 rho as deep as the nearest one
 * of q. So stretches of the curve are looked at, halved while they are long compared with rho:
 * those that reach so deep may hold it, and the directions to them, from anywhere in the ball, are
 * in a cone each.
 *
 * These stretches are as long as the root of rho. Mostly the ball's depth D(s, q') = r - |Q - q'| is
 * concave over all of them, with -D'' >= m: then its one maximum moves by no more than
 * |d D' / d q'| / m <= |Q' across the way| / (|Q - q'| m) times what q' does.
 */
#include "field/gradients/cone_curve.h"

#include <math.h>

#include "base/elementary.h"
#include "scene/primitives/tube.h"

enum { MOST = 64, DEEPEST = 14, SAMPLES = 17 };

typedef struct curve {
    double q[3][4]; /* coefficients of s for x, y, z */
    double r[4];
    double speed, growth; /* bounds on |Q'| and |r'| */
    double turning;       /* on |Q''| */
} curve;

typedef struct stretch {
    double s, half;
} stretch;

static double at(const double c[4], double s)
{
    return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

static curve curve_of(const float *own, const double q[3])
{
    curve c = {.speed = 0};
    for (int i = 0; i < 4; i++) {
        double square = 0;
        c.r[i] = (double)own[CSG_TUBE_RADII + i];
        for (int k = 0; k < 3; k++) {
            c.q[k][i] = i ? (double)own[CSG_TUBE_FIRST + 3 * (i - 1) + k] : -q[k];
            square += c.q[k][i] * c.q[k][i];
        }
        c.speed += i * sqrt(square);
        c.turning += i * (i - 1) * sqrt(square);
        c.growth += i * fabs(c.r[i]);
    }
    return c;
}

/* How deep the ball at s reaches q; to: the way to its centre. */
static double depth_at(const curve *c, double s, double to[3], double *length)
{
    double square = 0;
    for (int k = 0; k < 3; k++) {
        to[k] = at(c->q[k], s);
        square += to[k] * to[k];
    }
    *length = sqrt(square);
    return at(c->r, s) - *length;
}

/* A lower bound on the depth of the nearest ball, mostly a good one. */
static double deepest(const curve *c)
{
    double to[3], length, best = -INFINITY, step = 2.0 / (SAMPLES - 1), where = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double s = -1 + step * i, depth = depth_at(c, s, to, &length);
        where = depth > best ? s : where;
        best = fmax(best, depth);
    }
    for (int i = 0; i < 14; i++) {
        step /= 2;
        for (int side = -1; side <= 1; side += 2) {
            double s = fmin(fmax(where + side * step, -1), 1);
            double depth = depth_at(c, s, to, &length);
            if (depth > best) {
                best = depth;
                where = s;
                break;
            }
        }
    }
    return best;
}

/* Stretches that may hold nearest balls, no longer than 2 `most`; 0: too many. deepest: how deep
 * one of them reaches q at least. */
static int find_stretches(const curve *c, double rho, double deepest, double most,
                          stretch out[MOST])
{
    stretch waiting[DEEPEST + 2];
    double to[3], length, least = deepest - 2 * rho;
    int count = 0, left = 0;
    waiting[left++] = (stretch){0, 1};
    while (left) {
        stretch now = waiting[--left];
        double reach = now.half * (c->speed + c->growth);
        if (depth_at(c, now.s, to, &length) + reach < least)
            continue;
        if (now.half * c->speed > most && now.half > ldexp(1.5, -DEEPEST)) {
            waiting[left++] = (stretch){now.s - now.half / 2, now.half / 2};
            waiting[left++] = (stretch){now.s + now.half / 2, now.half / 2};
        } else if (count == MOST) {
            return 0;
        } else {
            out[count++] = now;
        }
    }
    return count;
}

/* ---- one maximum -------------------------------------------------------------------------------
 */

/* Of stretches side by side, which come from the curve's end to its beginning. */
static bool are_joined(const stretch *found, int count)
{
    for (int i = 1; i < count; i++)
        if (found[i].s + found[i].half != found[i - 1].s - found[i - 1].half)
            return false;
    return true;
}

static double slope(const double c[4], double s)
{
    return c[1] + s * (2 * c[2] + s * 3 * c[3]);
}

static double second_slope(const double c[4], double s)
{
    return 2 * c[2] + s * 6 * c[3];
}

/* What holds for all centres on a stretch and all points of the ball. */
typedef struct reach {
    double concavity; /* -D'' is no less */
    double across;    /* |Q' across the way| is no more */
    double length;    /* |Q - q'| is no less */
} reach;

static reach reach_of(const curve *c, const stretch *on, double rho)
{
    double to[3], length, along = 0, square = 0, turn = 0, turning = 0, third = 0;
    depth_at(c, on->s, to, &length);
    double shift = on->half * c->speed + rho;
    if (!(shift < length))
        return (reach){0, 0, 0};
    double chord = 1.42 * shift / length; /* of the turn to any other */
    for (int k = 0; k < 3; k++) {
        double way = to[k] / length, first = slope(c->q[k], on->s);
        double second = second_slope(c->q[k], on->s);
        along += way * first;
        square += first * first;
        turn += way * second;
        turning += second * second;
        third += 36 * c->q[k][3] * c->q[k][3];
    }
    double across = sqrt(fmax(square - along * along, 0));
    double off = on->half * c->turning + chord * sqrt(square); /* by that across may differ */
    double least = fmax(across - off, 0);
    double jerk = sqrt(third) * on->half;
    double swelling = second_slope(c->r, on->s) + 6 * fabs(c->r[3]) * on->half;
    return (reach){.concavity = turn - chord * sqrt(turning) - jerk +
                                least * least / (length + shift) - swelling,
                   .across = across + off,
                   .length = length - shift};
}

/* Where the depth is largest, between the ends of stretches over which it is concave. */
static double find_deepest(const curve *c, double low, double high)
{
    enum { HALVINGS = 40 };
    for (int i = 0; i < HALVINGS; i++) {
        double s = 0.5 * (low + high), to[3], length, along = 0;
        depth_at(c, s, to, &length);
        for (int k = 0; k < 3; k++)
            along += to[k] / length * slope(c->q[k], s);
        if (slope(c->r, s) - along > 0)
            low = s;
        else
            high = s;
    }
    return 0.5 * (low + high);
}

/* By stretches that are short compared with their distance. False: there may be several maxima. */
static bool follow_deepest(const curve *c, double rho, double deepest, double gradient[3],
                           double *bend)
{
    static const double SHORT = 0.04; /* of the distance to the nearest centre */
    stretch found[MOST];
    reach all = {INFINITY, 0, INFINITY};
    double to[3], length = at(c->r, 0) - deepest;
    int count = find_stretches(c, rho, deepest, fmax(SHORT * length, 0.25 * rho), found);
    for (int i = 0; i < count; i++) {
        reach own = reach_of(c, &found[i], rho);
        all.concavity = fmin(all.concavity, own.concavity);
        all.across = fmax(all.across, own.across);
        all.length = fmin(all.length, own.length);
    }
    if (!count || !are_joined(found, count) || !(all.concavity > 0) || !(all.length > 0))
        return false;
    const stretch *last = &found[count - 1];
    depth_at(c, find_deepest(c, last->s - last->half, found[0].s + found[0].half), to, &length);
    for (int k = 0; k < 3; k++)
        gradient[k] = to[k] / length;
    double move = all.across / (all.length * all.concavity);
    *bend = (1 + move * all.across) / all.length;
    return *bend * rho < 1;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

bool csg_cone_curve(const float *own, const double q[3], double rho, double gradient[3],
                    double *spread, double *bend)
{
    static const double ROUNDING = 1e-5;
    curve c = curve_of(own, q);
    stretch found[MOST];
    double to[MOST][3], turn[MOST], sum[3] = {0, 0, 0}, length, depth = deepest(&c);
    if (follow_deepest(&c, rho, depth, gradient, bend)) {
        *spread = *bend * rho + ROUNDING;
        return true;
    }
    int count = find_stretches(&c, rho, depth, 0.25 * rho, found);
    *bend = INFINITY;
    for (int i = 0; i < count; i++) {
        depth_at(&c, found[i].s, to[i], &length);
        double shift = found[i].half * c.speed + rho;
        if (!(shift < length))
            return false;
        turn[i] = csg_asin(shift / length);
        for (int k = 0; k < 3; k++) {
            to[i][k] /= length;
            sum[k] += to[i][k];
        }
    }
    double norm = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]), most = 0;
    if (count == 0 || !(norm > 0))
        return false;
    for (int k = 0; k < 3; k++)
        gradient[k] = sum[k] / norm;
    for (int i = 0; i < count; i++) {
        double cosine = to[i][0] * gradient[0] + to[i][1] * gradient[1] + to[i][2] * gradient[2];
        most = fmax(most, csg_acos(fmin(fmax(cosine, -1), 1)) + turn[i]);
    }
    *spread = most < 1.5 ? 2 * csg_sin(most / 2) + ROUNDING : 2; /* the chord */
    return *spread < 1.4;
}
