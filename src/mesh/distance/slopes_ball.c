/* SPDX-License-Identifier: MIT
 * One ball around all gradients that have an axis in common; see slopes.h.
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
