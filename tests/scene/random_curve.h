/* SPDX-License-Identifier: MIT
 * Seeded random tubes along Bezier curves: tame, wild, straight, with cusps, loops, sides of no
 * length and control points that coincide; of one radius, with changing radii, pointed.
 */
#ifndef TEST_RANDOM_CURVE_H
#define TEST_RANDOM_CURVE_H

#include "base/random.h"
#include "scene/primitives/curve.h"

/* Control points within about [-1, 1]^3; v has room for four. */
static inline void test_random_curve(csg_random *random, csg_node_kind kind, double *v)
{
    int count = (int)csg_primitive_parameter_count(kind) / CSG_CURVE_AXES;
    uint32_t shape = csg_random_below(random, 8), radii = csg_random_below(random, 4);
    double reach = shape < 3 ? 0.3 : 1, r = csg_random_uniform(random, 0.02, 0.5);
    for (int i = 0; i < count; i++) {
        double *p = v + CSG_CURVE_AXES * i, along = 2.0 * i / (count - 1) - 1;
        for (int k = 0; k < 3; k++)
            p[k] = csg_random_uniform(random, -reach, reach);
        if (shape < 3) /* tame */
            p[0] += along;
        if (shape == 3) { /* straight */
            p[0] = along * 0.8;
            p[1] = p[2] = 0;
        }
        if (shape == 4 && i > 0 && csg_random_below(random, 2)) /* some coincide */
            for (int k = 0; k < 3; k++)
                p[k] = p[k - CSG_CURVE_AXES];
        if (shape == 5) /* in a plane: cusps and loops when crossed */
            p[2] = 0;
        p[CSG_CURVE_RADIUS] = radii == 0   ? csg_random_uniform(random, 0.02, 0.5)
                              : radii == 1 ? fmax(csg_random_uniform(random, -0.1, 0.3), 0)
                                           : r;
    }
    if (shape == 5 && count == 4) /* a cusp in the middle, or nearly */
        for (int k = 0; k < 2; k++) {
            v[4 + k] = v[12 + k] + csg_random_uniform(random, -0.05, 0.05);
            v[8 + k] = v[k];
        }
    if (radii == 1)
        v[CSG_CURVE_RADIUS] = 0.2;
}

#endif
