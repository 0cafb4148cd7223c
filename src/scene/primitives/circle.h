/* SPDX-License-Identifier: MIT
 * A disc around the origin, a figure of the plane. Parameters: r. In float: r.
 */
#ifndef CSG_SCENE_CIRCLE_H
#define CSG_SCENE_CIRCLE_H

#include "base/elementary.h"
#include "scene/primitives/primitive_kit.h"

enum { CSG_CIRCLE_OWN = 1 };

static inline bool csg_circle_check(csg_refusal *refusal, double *v)
{
    return csg_check_positive(refusal, v[0], "the radius");
}

static inline csg_sample csg_circle_distance(const double *v, csg_vec3 p)
{
    double rho = csg_hypot(p.x, p.y);
    return csg_sample_revolve(p, rho, v[0] - rho, -1, 0);
}

static inline double csg_circle_support(const double *v, csg_vec3 n)
{
    return n.z == 0 ? v[0] * csg_hypot(n.x, n.y) : INFINITY;
}

static inline bool csg_circle_has_face(const double *v, csg_vec3 n)
{
    return false;
}

static inline csg_term csg_circle_term(csg_terms *t, const double *v, const csg_term p[3])
{
    return csg_term_number_sub(t, v[0], csg_term_norm2(t, p[0], p[1]));
}

static inline double csg_circle_depth(const double *v)
{
    return v[0];
}

static inline bool csg_circle_balls(csg_ball_sink *to, const double *v)
{
    to->ball(to->user, csg_vec3_make(0, 0, 0), v[0]);
    return true;
}

static inline void csg_circle_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_circle_pack(csg_leaf *l, const double *v, double k)
{
    l->own[0] = v[0] * k;
    l->magnitude = l->own[0];
}

static inline float csg_circle_value(const float *own, point q, point *g)
{
    float d = sqrtf(q.x * q.x + q.y * q.y);
    float s = quotient(-1.0f, d);
    *g = (point){q.x * s, q.y * s, 0};
    return own[0] - d;
}

static inline int csg_circle_falls_outwards(const float *own)
{
    return 1;
}

static inline bool csg_circle_gradients(csg_cone_leaf *l)
{
    return csg_cone_add_away(l, l->q[0], l->q[1], 0);
}

static inline bool csg_circle_may_crease(const float *own, const float q[3], float reach,
                                         csg_band b)
{
    return csg_band_meets(b, own[0], own[0]); /* on the axis */
}

static inline bool csg_circle_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    csg_smooth rho;
    if (!csg_smooth_radial(l, &rho))
        return false;
    *out = csg_smooth_line(l, (double)l->own[0], -1, &rho);
    return true;
}

static inline unsigned csg_circle_mirrors(const float *own)
{
    return CSG_MIRROR_TURNED | CSG_MIRROR_Z;
}

#endif
