/* SPDX-License-Identifier: MIT
 * A box around the origin, its edges rounded. Parameters: half sizes with the rounding, rounding.
 * In float: half sizes without it, rounding.
 */
#ifndef CSG_SCENE_BOX_H
#define CSG_SCENE_BOX_H

#include "scene/primitives/primitive_kit.h"

enum { CSG_BOX_OWN = 4 };

static inline bool csg_box_check(csg_refusal *refusal, double *v)
{
    return csg_check_positive(refusal, v[0], "the size") &&
           csg_check_positive(refusal, v[1], "the size") &&
           csg_check_positive(refusal, v[2], "the size") &&
           csg_check_rounding(refusal, v[3], fmin(v[0], fmin(v[1], v[2])));
}

static inline csg_sample csg_box_distance(const double *v, csg_vec3 p)
{
    double round = v[3];
    const double at[3] = {p.x, p.y, p.z};
    double q[3], outside[3], square = 0;
    int widest = 0;
    for (int i = 0; i < 3; i++) {
        q[i] = fabs(at[i]) - (v[i] - round);
        outside[i] = fmax(q[i], 0);
        square += outside[i] * outside[i];
        if (q[i] > q[widest])
            widest = i;
    }
    double distance = sqrt(square), gradient[3] = {0};
    if (!(distance > 0)) {
        gradient[widest] = -csg_sign(at[widest]);
        return (csg_sample){round - q[widest],
                            csg_vec3_make(gradient[0], gradient[1], gradient[2])};
    }
    for (int i = 0; i < 3; i++)
        gradient[i] = -csg_sign(at[i]) * outside[i] / distance;
    return (csg_sample){round - distance, csg_vec3_make(gradient[0], gradient[1], gradient[2])};
}

static inline double csg_box_support(const double *v, csg_vec3 n)
{
    return fabs(n.x) * (v[0] - v[3]) + fabs(n.y) * (v[1] - v[3]) + fabs(n.z) * (v[2] - v[3]) +
           v[3] * csg_vec3_norm(n);
}

static inline bool csg_box_has_face(const double *v, csg_vec3 n)
{
    for (int k = 0; k < 3; k++)
        if (csg_is_along(n, k))
            return v[(k + 1) % 3] > v[3] && v[(k + 2) % 3] > v[3];
    return false;
}

static inline csg_term csg_box_term(csg_terms *t, const double *v, const csg_term p[3])
{
    return csg_term_box(t, v, v[3], p, 3);
}

static inline double csg_box_depth(const double *v)
{
    return 0;
}

static inline bool csg_box_balls(csg_ball_sink *to, const double *v)
{
    csg_balls_of_box(to, v, v[3], 3);
    return true;
}

static inline void csg_box_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
    v[3] = csg_example_chance(random, 0.5)
               ? 0
               : csg_random_uniform(random, 0, fmin(v[0], fmin(v[1], v[2])));
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_box_pack(csg_leaf *l, const double *v, double k)
{
    for (int i = 0; i < 3; i++)
        l->own[i] = (v[i] - v[3]) * k;
    l->own[3] = v[3] * k;
    l->magnitude = k * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static inline float csg_box_value(const float *own, point q, point *g)
{
    float ax = absolute(q.x) - own[0], ay = absolute(q.y) - own[1], az = absolute(q.z) - own[2];
    float ox = larger(ax, 0), oy = larger(ay, 0), oz = larger(az, 0);
    float outside = sqrtf(ox * ox + oy * oy + oz * oz);
    float inside = larger(ax, larger(ay, az));
    int is_out = inside > 0;
    float s = quotient(-1.0f, outside);
    float fx = ax >= larger(ay, az) ? -1.0f : 0;
    float fy = (ay >= az) & (fx == 0) ? -1.0f : 0;
    float fz = (fx == 0) & (fy == 0) ? -1.0f : 0;
    *g = (point){sign_of(q.x) * (is_out ? ox * s : fx), sign_of(q.y) * (is_out ? oy * s : fy),
                 sign_of(q.z) * (is_out ? oz * s : fz)};
    return own[3] - (is_out ? outside : inside);
}

static inline int csg_box_falls_outwards(const float *own)
{
    return 1;
}

static inline bool csg_box_gradients(csg_cone_leaf *l)
{
    return csg_cone_add_box(l, 3);
}

/* Near its edges, and inside, where folds go on from there to the middle. */
static inline bool csg_box_may_crease(const float *own, const float q[3], float reach, csg_band b)
{
    return b.high > own[3] || csg_box_edge_distance(own, q, 3) <= reach + 2 * own[3];
}

static inline bool csg_box_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    return csg_smooth_of_box(l, l->own, (double)l->own[3], 3, out);
}

static inline unsigned csg_box_mirrors(const float *own)
{
    return CSG_MIRROR_SIGNS | (own[0] == own[1] ? CSG_MIRROR_XY : 0) |
           (own[1] == own[2] ? CSG_MIRROR_YZ : 0);
}

#endif
