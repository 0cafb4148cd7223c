/* SPDX-License-Identifier: MIT
 * What the files of the primitives are written with.
 */
#ifndef CSG_SCENE_PRIMITIVE_KIT_H
#define CSG_SCENE_PRIMITIVE_KIT_H

#include <string.h>

#include "scene/formula/terms.h"
#include "scene/primitives/point.h"
#include "scene/primitives/primitive.h"
#include "scene/primitives/smooth.h"

static inline double csg_sign(double x)
{
    return (x > 0) - (x < 0);
}

/* Whether n, of any length, has that axis's direction, or the opposite one, but for rounding. */
static inline bool csg_is_along(csg_vec3 n, int axis)
{
    const double v[3] = {fabs(n.x), fabs(n.y), fabs(n.z)};
    return v[(axis + 1) % 3] + v[(axis + 2) % 3] < 1e-9 * v[axis];
}

/* ---- samples: value and gradient ------------------------------------------------------------ */

/* A ball of radius r around `center`. */
static inline csg_sample csg_sample_ball(csg_vec3 p, csg_vec3 center, double r)
{
    csg_vec3 v = csg_vec3_sub(p, center);
    double distance = csg_vec3_norm(v);
    csg_vec3 away = distance > 0 ? csg_vec3_scale(v, -1 / distance) : csg_vec3_make(0, 0, 0);
    return (csg_sample){r - distance, away};
}

/* A field of (rho, z) turned about the z axis; d_rho, d_z: its gradient there. */
static inline csg_sample csg_sample_revolve(csg_vec3 p, double rho, double value, double d_rho,
                                            double d_z)
{
    double k = rho > 0 ? d_rho / rho : 0;
    return (csg_sample){value, csg_vec3_make(k * p.x, k * p.y, d_z)};
}

/* ---- terms ---------------------------------------------------------------------------------- */

/* Distance in the half plane of a convex solid of revolution, or of any convex figure, from
 * `behind`, the largest of its half planes (below 0 inside, where it is the distance), and
 * `outside`, the distance to its boundary. */
static inline csg_term csg_term_convex(csg_terms *t, csg_term behind, csg_term outside)
{
    return csg_term_add(t, csg_term_min_number(t, behind, 0),
                        csg_term_mul(t, csg_term_step(t, behind), outside));
}

/* round - distance to a box of `axes` dimensions with these half sizes. */
static inline csg_term csg_term_box(csg_terms *t, const double *half, double round,
                                    const csg_term *p, int axes)
{
    csg_term widest = 0, squares = 0;
    for (int i = 0; i < axes; i++) {
        csg_term q = csg_term_sub_number(t, csg_term_abs(t, p[i]), half[i] - round);
        csg_term square = csg_term_square(t, csg_term_max_number(t, q, 0));
        widest = i ? csg_term_max(t, widest, q) : q;
        squares = i ? csg_term_add(t, squares, square) : square;
    }
    csg_term distance =
        csg_term_add(t, csg_term_sqrt(t, squares), csg_term_min_number(t, widest, 0));
    return csg_term_number_sub(t, round, distance);
}

/* ---- the solid ------------------------------------------------------------------------------ */

static inline void csg_balls_of_box(csg_ball_sink *to, const double *half, double round, int axes)
{
    for (int i = 0; i < 1 << axes; i++)
        to->ball(to->user,
                 csg_vec3_make((i & 1 ? 1 : -1) * (half[0] - round),
                               (i & 2 ? 1 : -1) * (half[1] - round),
                               axes < 3 ? 0 : (i & 4 ? 1 : -1) * (half[2] - round)),
                 round);
}

/* ---- random parameters ---------------------------------------------------------------------- */

static inline bool csg_example_chance(csg_random *random, double probability)
{
    return csg_random_uniform(random, 0, 1) < probability;
}

/* Four sizes. */
static inline void csg_example_sizes(csg_random *random, double *v)
{
    for (int i = 0; i < 4; i++)
        v[i] = csg_random_uniform(random, 0.15, 0.7);
}

/* ---- gradients in a ball, and creases ------------------------------------------------------- */

/* Faces of a box over the first `axes` axes, half sizes and rounding in own. */
bool csg_cone_add_box(csg_cone_leaf *l, int axes);
/* Distance from the nearest edge of a box with half sizes own[0..]: of two coordinates at once. */
float csg_box_edge_distance(const float *own, const float q[3], int axes);

#endif
