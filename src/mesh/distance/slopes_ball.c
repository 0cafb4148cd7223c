/* SPDX-License-Identifier: MIT
 * One ball around gradients, and how far those of two operands are from each other; see slopes.h.
 */
#include <math.h>

#include "mesh/distance/slopes_private.h"

/* A ball around all gradients: in the balls' hull, or longer combinations of these of at most that
 * length. Those that have an axis in common are within a circular cone around it, as all they
 * combine to, and climb along it by no less than they do. */
bool csg_slopes_enclose_around(const csg_cone_balls *balls, const csg_cone *axis, double longest,
                               csg_cone_ball *out)
{
    csg_cone cone = *axis;
    double tangent = 0;
    for (uint32_t i = 0; i < balls->count; i++) {
        const csg_cone_ball *ball = &balls->items[i];
        double along = 0, square = 0;
        for (int k = 0; k < 3; k++) {
            along += cone.axis[k] * ball->at[k];
            square += ball->at[k] * ball->at[k];
        }
        double across = sqrt(fmax(square - along * along, 0)) + ball->spread;
        if (!(along - ball->spread >= 0.999 * cone.least))
            return false;
        tangent = fmax(tangent, across / (along - ball->spread));
    }
    double least = 0.999 * cone.least, most = fmax(longest, least);
    double sine = tangent / sqrt(1 + tangent * tangent);
    for (int k = 0; k < 3; k++)
        out->at[k] = 0.5 * (least + most) * cone.axis[k];
    out->spread =
        sqrt(sine * sine * most * most + 0.25 * (most - least) * (most - least)) + 1e-6 * most;
    return true;
}

bool csg_slopes_enclose(const csg_cone_balls *balls, double longest, csg_cone_ball *out)
{
    csg_cone cone;
    return csg_cone_find_axis(balls, &cone) &&
           csg_slopes_enclose_around(balls, &cone, longest, out);
}

csg_cone_ball csg_slopes_ball_around(const csg_cone_balls *balls)
{
    csg_cone_ball middle = {.at = {0, 0, 0}};
    double radius = 0;
    for (uint32_t i = 0; i < balls->count; i++)
        for (int k = 0; k < 3; k++)
            middle.at[k] += balls->items[i].at[k] / balls->count;
    for (uint32_t i = 0; i < balls->count; i++)
        radius = fmax(radius, csg_slopes_balls_apart(&middle, &balls->items[i]));
    middle.spread = radius;
    return middle;
}

/* Along the axis that all climb by `least` each weight is paid for. */
double csg_slopes_weight(const csg_cone_balls *balls, double longest)
{
    csg_cone cone;
    return csg_cone_find_axis(balls, &cone) ? fmax(1, longest / (0.999 * cone.least)) : INFINITY;
}

static double weight_of(const csg_slopes_operand *o)
{
    return csg_slopes_exceed_hull(o) ? csg_slopes_weight(&o->balls, o->longest) : 1;
}

/* What it changes by along a side of the triangle. weight: as above. */
static csg_slopes_range change_along(const csg_slopes_operand *o, double weight, csg_vec3 side)
{
    double length = csg_vec3_norm(side), longest = o->longest * length;
    csg_slopes_range r = {INFINITY, -INFINITY};
    if (!(weight < INFINITY))
        return (csg_slopes_range){-longest, longest};
    for (uint32_t i = 0; i < o->balls.count; i++) {
        const csg_cone_ball *ball = &o->balls.items[i];
        double along = ball->at[0] * side.x + ball->at[1] * side.y + ball->at[2] * side.z;
        r.low = fmin(r.low, along - ball->spread * length);
        r.high = fmax(r.high, along + ball->spread * length);
    }
    return (csg_slopes_range){fmin(r.low, weight * r.low), fmax(r.high, weight * r.high)};
}

double csg_slopes_parting(const csg_slopes_walker *w, const csg_slopes_operand *a,
                          const csg_slopes_operand *b)
{
    const csg_vec3 *v = w->region.triangle;
    double most = 0, weight_a = weight_of(a), weight_b = weight_of(b);
    if (!(w->flat > 0))
        return 0;
    for (int i = 0; i < 3; i++) {
        csg_vec3 side = csg_vec3_sub(v[(i + 1) % 3], v[i]);
        csg_slopes_range p = change_along(a, weight_a, side), q = change_along(b, weight_b, side);
        most = fmax(most, fmax(p.high - q.low, q.high - p.low));
    }
    return most;
}

double csg_slopes_sets_apart(const csg_cone_balls *a, const csg_cone_balls *b)
{
    double most = 0;
    for (uint32_t i = 0; i < a->count; i++)
        for (uint32_t k = 0; k < b->count; k++)
            most = fmax(most, csg_slopes_balls_apart(&a->items[i], &b->items[k]));
    return most;
}

double csg_gradients_steepest(const csg_gradients *gradients)
{
    double most = 0;
    if (!(gradients->stray < INFINITY))
        return INFINITY;
    if (gradients->exceeds)
        return sqrt(3.0) * gradients->longest;
    for (uint32_t i = 0; i < gradients->balls.count; i++) {
        const csg_cone_ball *ball = &gradients->balls.items[i];
        double steepest = fabs(ball->at[0]) + fabs(ball->at[1]) + fabs(ball->at[2]);
        most = fmax(most, steepest + sqrt(3.0) * ball->spread);
    }
    return most;
}
