/* SPDX-License-Identifier: MIT
 * A rectangle around the origin, its corners rounded, a figure of the plane. Parameters: half sizes
 * with the rounding, rounding. In float: half sizes without it, rounding.
 */
#ifndef CSG_SCENE_RECTANGLE_H
#define CSG_SCENE_RECTANGLE_H

#include "base/elementary.h"
#include "scene/primitives/primitive_kit.h"

enum { CSG_RECTANGLE_OWN = 3 };

static inline bool csg_rectangle_check(csg_refusal *refusal, double *v)
{
    return csg_check_positive(refusal, v[0], "the size") &&
           csg_check_positive(refusal, v[1], "the size") &&
           csg_check_rounding(refusal, v[2], fmin(v[0], v[1]));
}

static inline csg_sample csg_rectangle_distance(const double *v, csg_vec3 p)
{
    double qx = fabs(p.x) - (v[0] - v[2]), qy = fabs(p.y) - (v[1] - v[2]);
    double sx = -csg_sign(p.x), sy = -csg_sign(p.y);
    if (qx > 0 && qy > 0) {
        double corner = csg_hypot(qx, qy);
        return (csg_sample){v[2] - corner, csg_vec3_make(sx * qx / corner, sy * qy / corner, 0)};
    }
    return (csg_sample){v[2] - fmax(qx, qy),
                        qx >= qy ? csg_vec3_make(sx, 0, 0) : csg_vec3_make(0, sy, 0)};
}

static inline double csg_rectangle_support(const double *v, csg_vec3 n)
{
    if (n.z != 0)
        return INFINITY;
    return fabs(n.x) * (v[0] - v[2]) + fabs(n.y) * (v[1] - v[2]) + v[2] * csg_hypot(n.x, n.y);
}

static inline bool csg_rectangle_has_face(const double *v, csg_vec3 n)
{
    return (csg_is_along(n, 0) && v[1] > v[2]) || (csg_is_along(n, 1) && v[0] > v[2]);
}

static inline csg_term csg_rectangle_term(csg_terms *t, const double *v, const csg_term p[3])
{
    return csg_term_box(t, v, v[2], p, 2);
}

static inline double csg_rectangle_depth(const double *v)
{
    return 0;
}

static inline bool csg_rectangle_balls(csg_ball_sink *to, const double *v)
{
    csg_balls_of_box(to, v, v[2], 2);
    return true;
}

static inline void csg_rectangle_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
    v[2] = csg_example_chance(random, 0.5) ? 0 : csg_random_uniform(random, 0, fmin(v[0], v[1]));
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_rectangle_pack(csg_leaf *l, const double *v, double k)
{
    double own[] = {(v[0] - v[2]) * k, (v[1] - v[2]) * k, v[2] * k};
    memcpy(l->own, own, sizeof own);
    l->magnitude = k * csg_hypot(v[0], v[1]);
}

static inline float csg_rectangle_value(const float *own, point q, point *g)
{
    float ax = absolute(q.x) - own[0], ay = absolute(q.y) - own[1];
    float ox = larger(ax, 0), oy = larger(ay, 0);
    float outside = sqrtf(ox * ox + oy * oy), inside = larger(ax, ay);
    int is_out = inside > 0;
    float s = quotient(-1.0f, outside);
    float fx = ax >= ay ? -1.0f : 0, fy = ax >= ay ? 0 : -1.0f;
    *g = (point){sign_of(q.x) * (is_out ? ox * s : fx), sign_of(q.y) * (is_out ? oy * s : fy), 0};
    return own[2] - (is_out ? outside : inside);
}

static inline int csg_rectangle_falls_outwards(const float *own)
{
    return 1;
}

static inline bool csg_rectangle_gradients(csg_cone_leaf *l)
{
    return csg_cone_add_box(l, 2);
}

/* Near its corners, and inside, where folds go on from there to the middle. */
static inline bool csg_rectangle_may_crease(const float *own, const float q[3], float reach,
                                            csg_band b)
{
    return b.high > own[2] || csg_box_edge_distance(own, q, 2) <= reach + 2 * own[2];
}

static inline bool csg_rectangle_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    return csg_smooth_of_box(l, l->own, (double)l->own[2], 2, out);
}

static inline unsigned csg_rectangle_mirrors(const float *own)
{
    return CSG_MIRROR_SIGNS | (own[0] == own[1] ? CSG_MIRROR_XY : 0);
}

#endif
