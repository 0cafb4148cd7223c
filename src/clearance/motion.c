/* SPDX-License-Identifier: MIT
 * See motion.h. On a screw by the angle t at the distance r from its axis, a point's way is an arc
 * (with what it goes along the axis, a helix) whose second derivative by the share of the way is
 * r t^2, so it is r t^2 / 8 at most from the point of the chord at the same share, by the error of
 * linear interpolation. The chord is 2 r sin(t / 2) long at least. How far a point is from where it
 * was, (2 r sin(u t / 2))^2 + (u h)^2, grows with the share u of the way while t <= 180 degrees: on
 * its way no point is farther from where it is than at the other end.
 */
#include "clearance/motion.h"

#include <math.h>

#include "base/elementary.h"
#include "scene/tree/placement.h"

/* No less than the arc sine, and nearly it: up to 0.5 its series, whose terms are all positive,
 * stays below this. */
static double above_asin(double x)
{
    return x <= 0.5 ? x * (1 + 0.189 * x * x) : csg_asin(x);
}

csg_motion csg_motion_between(const csg_affine *mover_back, const csg_affine *other_forth,
                              double reach)
{
    static const double OUTWARD = 1e-10; /* of the matrix, rounded and not quite a rotation */
    csg_motion out = {.back = csg_affine_multiply(*other_forth, *mover_back)};
    double square = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double e = out.back.m[i][k] - (i == k);
            square += e * e;
        }
    double sine = fmin(sqrt(square / 8) + OUTWARD, 1), half = above_asin(sine);
    out.turn = 2 * sine;
    out.bend = half * half / (4 * sine);
    out.slack = 4 * CSG_MOTION_ROUNDING * reach;
    return out;
}

double csg_motion_most(const csg_motion *motion, csg_vec3 center, double radius)
{
    csg_vec3 moved = csg_affine_point(&motion->back, center);
    return csg_vec3_norm(csg_vec3_sub(moved, center)) + motion->turn * radius + motion->slack;
}
