/* SPDX-License-Identifier: MIT
 * Cones of normals; see normals.h. That two of them have nothing in common is shown by a plane
 * between them: it is looked for by a few steps, and what is found is then checked, so that it need
 * not be the best.
 */
#include "walls/normals.h"

#include <math.h>

/* Of products of unit vectors, and of lengths. */
static const double ROUNDING = 1e-9;

static bool normalize(double v[3])
{
    double length = csg_norm3(v);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return length > 1e-12;
}

static double cosine_of(double sine)
{
    return sqrt(fmax(1 - sine * sine, 0));
}

/* ---- one direction for all ---------------------------------------------------------------------
 */

typedef struct both {
    const csg_wall_normals *sets[2];
} both;

static uint32_t count_of(const both *w)
{
    return w->sets[0]->count + w->sets[1]->count;
}

static const csg_wall_cap *cap_of(const both *w, uint32_t i)
{
    return i < w->sets[0]->count ? &w->sets[0]->caps[i] : &w->sets[1]->caps[i - w->sets[0]->count];
}

/* Whether all normals are within less than 90 degrees less the angle of one direction: then any two
 * of them are less than 180 degrees less twice the angle apart, so none face each other. A cap
 * around that direction is convex, so that combinations are in it, too. */
static bool look_one_way(const both *w, csg_wall_angle angle)
{
    enum { STEPS = 32 };
    double e[3] = {0, 0, 0};
    for (uint32_t i = 0; i < count_of(w); i++)
        for (int k = 0; k < 3; k++)
            e[k] += cap_of(w, i)->at[k];
    for (int step = 0; step < STEPS; step++) {
        const csg_wall_cap *worst = NULL;
        double least = INFINITY;
        if (!normalize(e))
            return false;
        for (uint32_t i = 0; i < count_of(w); i++) {
            const csg_wall_cap *cap = cap_of(w, i);
            double cosine = cosine_of(cap->sine);
            if (!(angle.cosine * cosine - angle.sine * cap->sine > 0)) /* 90 degrees together */
                return false;
            double room = csg_dot3(e, cap->at) - (angle.sine * cosine + angle.cosine * cap->sine);
            if (room < least) {
                least = room;
                worst = cap;
            }
        }
        if (least > ROUNDING)
            return true;
        for (int k = 0; k < 3; k++) /* ever shorter steps come near the middle of a smallest ball */
            e[k] += (worst->at[k] - e[k]) / (step + 2);
    }
    return false;
}

/* ---- along a line ------------------------------------------------------------------------------
 */

/* Whether no combination is within the angle of the unit vector d: a plane has all caps behind it,
 * and what is within the angle of d before it. e, its normal, begins as d and turns away from one
 * cap after the other, by no more than need be. */
bool csg_wall_is_apart(const csg_wall_normals *n, const double d[3], csg_wall_angle angle)
{
    enum { ROUNDS = 12 };
    double e[3] = {d[0], d[1], d[2]};
    if (!n->count)
        return false;
    for (int round = 0; round < ROUNDS; round++) {
        double worst = -INFINITY;
        uint32_t at = 0;
        for (uint32_t i = 0; i < n->count; i++) {
            double over = csg_dot3(e, n->caps[i].at) + n->caps[i].sine + ROUNDING;
            if (over > worst) {
                worst = over;
                at = i;
            }
        }
        if (worst <= 0)
            return true;
        double sine = n->caps[at].sine + 2 * ROUNDING, along = csg_dot3(e, n->caps[at].at);
        if (!(sine < 1))
            return false;
        for (int k = 0; k < 3; k++)
            e[k] -= along * n->caps[at].at[k];
        if (!normalize(e))
            return false;
        for (int k = 0; k < 3; k++)
            e[k] = cosine_of(sine) * e[k] - sine * n->caps[at].at[k];
        if (!(csg_dot3(e, d) > angle.sine + ROUNDING))
            return false;
    }
    return false;
}

static csg_wall_angle angle_of(double degrees)
{
    csg_wall_angle angle;
    csg_sin_cos_deg(degrees, &angle.sine, &angle.cosine);
    return angle;
}

csg_wall_angles csg_wall_angles_make(double one_deg, double other_deg)
{
    return (csg_wall_angles){angle_of(one_deg), angle_of(other_deg),
                             angle_of((one_deg + other_deg) / 2)};
}

/* The sum of both. False: it is 90 degrees or more. */
static bool widen(csg_wall_angle *angle, double sine)
{
    double cosine = cosine_of(sine);
    *angle = (csg_wall_angle){angle->sine * cosine + angle->cosine * sine,
                              angle->cosine * cosine - angle->sine * sine};
    return angle->cosine > ROUNDING;
}

csg_wall_line csg_wall_line_make(csg_vec3 offset, double reach, const csg_wall_angles *angles)
{
    double length = csg_vec3_norm(offset), sine = reach / length * (1 + ROUNDING);
    csg_wall_line line = {.one = angles->one, .other = angles->other};
    line.is_known = sine < 1 && widen(&line.one, sine) && widen(&line.other, sine);
    line.d[0] = offset.x / length;
    line.d[1] = offset.y / length;
    line.d[2] = offset.z / length;
    return line;
}

bool csg_wall_may_oppose(const csg_wall_normals *a, const csg_wall_normals *b,
                         const csg_wall_angles *angles)
{
    const both all = {{a, b}};
    return !a->count || !b->count || !look_one_way(&all, angles->half);
}

bool csg_wall_has_near(const csg_wall_normals *n, csg_vec3 direction, csg_wall_angle angle)
{
    enum { SWEEPS = 40, MOST = 32 };
    const double d[3] = {direction.x, direction.y, direction.z};
    double weights[MOST] = {0}, rest[3] = {d[0], d[1], d[2]}, sum[3];
    uint32_t count = n->count < MOST ? n->count : MOST;
    for (int sweep = 0; sweep < SWEEPS; sweep++) /* the nearest combination, one weight at a time */
        for (uint32_t i = 0; i < count; i++) {
            double to = fmax(0, weights[i] + csg_dot3(rest, n->caps[i].at)), by = to - weights[i];
            weights[i] = to;
            for (int k = 0; k < 3; k++)
                rest[k] -= by * n->caps[i].at[k];
        }
    for (int k = 0; k < 3; k++)
        sum[k] = d[k] - rest[k];
    return normalize(sum) && csg_dot3(sum, d) >= angle.cosine;
}
