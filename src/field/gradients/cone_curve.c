/* SPDX-License-Identifier: MIT
 * See cone_curve.h. The gradient at q' is the direction from there to the centre of its nearest
 * ball. Where q' is within rho of q, that ball reaches q to within 2 rho as deep as the nearest one
 * of q. So stretches of the curve are looked at, halved while they are long compared with rho:
 * those that reach so deep may hold it, and the directions to them, from anywhere in the ball, are
 * in a cone each.
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

/* Stretches that may hold nearest balls; 0: too many. */
static int find_stretches(const curve *c, double rho, stretch out[MOST])
{
    stretch waiting[DEEPEST + 2];
    double to[3], length, least = deepest(c) - 2 * rho;
    int count = 0, left = 0;
    waiting[left++] = (stretch){0, 1};
    while (left) {
        stretch now = waiting[--left];
        double reach = now.half * (c->speed + c->growth);
        if (depth_at(c, now.s, to, &length) + reach < least)
            continue;
        if (now.half * c->speed > 0.25 * rho && now.half > ldexp(1.5, -DEEPEST)) {
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

bool csg_cone_curve(const float *own, const double q[3], double rho, double gradient[3],
                    double *spread)
{
    curve c = curve_of(own, q);
    stretch found[MOST];
    double to[MOST][3], turn[MOST], sum[3] = {0, 0, 0}, length;
    int count = find_stretches(&c, rho, found);
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
    *spread = most < 1.5 ? 2 * csg_sin(most / 2) + 1e-5 : 2; /* the chord */
    return *spread < 1.4;
}
