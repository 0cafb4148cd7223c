/* SPDX-License-Identifier: MIT
 * A ball around the origin. Parameters: r. In float: r.
 */
#ifndef CSG_SCENE_SPHERE_H
#define CSG_SCENE_SPHERE_H

#include "scene/primitives/primitive_kit.h"

enum { CSG_SPHERE_OWN = 1 };

static inline bool csg_sphere_check(csg_refusal *refusal, double *v)
{
    return csg_check_positive(refusal, v[0], "the radius");
}

static inline csg_sample csg_sphere_distance(const double *v, csg_vec3 p)
{
    return csg_sample_ball(p, csg_vec3_make(0, 0, 0), v[0]);
}

static inline double csg_sphere_support(const double *v, csg_vec3 n)
{
    return v[0] * csg_vec3_norm(n);
}

static inline bool csg_sphere_has_face(const double *v, csg_vec3 n)
{
    return false;
}

static inline csg_term csg_sphere_term(csg_terms *t, const double *v, const csg_term p[3])
{
    return csg_term_number_sub(t, v[0], csg_term_norm3(t, p[0], p[1], p[2]));
}

static inline double csg_sphere_depth(const double *v)
{
    return v[0];
}

static inline bool csg_sphere_balls(csg_ball_sink *to, const double *v)
{
    to->ball(to->user, csg_vec3_make(0, 0, 0), v[0]);
    return true;
}

static inline void csg_sphere_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_sphere_pack(csg_leaf *l, const double *v, double k)
{
    l->own[0] = v[0] * k;
    l->magnitude = l->own[0];
}

static inline float csg_sphere_value(const float *own, point q, point *g)
{
    float d = sqrtf(q.x * q.x + q.y * q.y + q.z * q.z);
    float s = quotient(-1.0f, d);
    *g = (point){q.x * s, q.y * s, q.z * s};
    return own[0] - d;
}

static inline int csg_sphere_falls_outwards(const float *own)
{
    return 1;
}

static inline bool csg_sphere_gradients(csg_cone_leaf *l)
{
    return csg_cone_add_away(l, l->q[0], l->q[1], l->q[2]);
}

static inline bool csg_sphere_may_crease(const float *own, const float q[3], float reach,
                                         csg_band b)
{
    return csg_band_meets(b, own[0], own[0]); /* at the centre */
}

static inline bool csg_sphere_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    const csg_smooth *const p[3] = {&l->p[0], &l->p[1], &l->p[2]};
    return csg_smooth_round(l, (double)l->own[0], p, 3, out);
}

static inline unsigned csg_sphere_mirrors(const float *own)
{
    return CSG_MIRROR_ALL;
}

#endif
