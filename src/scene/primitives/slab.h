/* SPDX-License-Identifier: MIT
 * The points with |z| <= h. Parameters: h. In float: h.
 */
#ifndef CSG_SCENE_SLAB_H
#define CSG_SCENE_SLAB_H

#include "scene/primitives/primitive_kit.h"

enum { CSG_SLAB_OWN = 1 };

static inline bool csg_slab_check(csg_refusal *refusal, double *v)
{
    return csg_check_positive(refusal, v[0], "the height");
}

static inline csg_sample csg_slab_distance(const double *v, csg_vec3 p)
{
    return (csg_sample){v[0] - fabs(p.z), csg_vec3_make(0, 0, -csg_sign(p.z))};
}

static inline double csg_slab_support(const double *v, csg_vec3 n)
{
    return n.x == 0 && n.y == 0 ? v[0] * fabs(n.z) : INFINITY;
}

static inline bool csg_slab_has_face(const double *v, csg_vec3 n)
{
    return csg_is_along(n, 2);
}

static inline csg_term csg_slab_term(csg_terms *t, const double *v, const csg_term p[3])
{
    return csg_term_number_sub(t, v[0], csg_term_abs(t, p[2]));
}

static inline double csg_slab_depth(const double *v)
{
    return 0;
}

static inline bool csg_slab_balls(csg_ball_sink *to, const double *v)
{
    return false;
}

static inline void csg_slab_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_slab_pack(csg_leaf *l, const double *v, double k)
{
    l->own[0] = v[0] * k;
    l->magnitude = l->own[0];
}

static inline float csg_slab_value(const float *own, point q, point *g)
{
    *g = (point){0, 0, -sign_of(q.z)};
    return own[0] - absolute(q.z);
}

static inline int csg_slab_falls_outwards(const float *own)
{
    return 1;
}

static inline bool csg_slab_gradients(csg_cone_leaf *l)
{
    if (fabs(l->q[2]) <= l->rho)
        return false;
    l->bend = 0;
    return csg_cone_add(l, 0, 0, l->q[2] < 0 ? 1 : -1, 0);
}

static inline bool csg_slab_may_crease(const float *own, const float q[3], float reach, csg_band b)
{
    return csg_band_meets(b, own[0], INFINITY); /* in the middle plane */
}

static inline bool csg_slab_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    const csg_smooth *z = &l->p[2];
    *out = csg_smooth_line(l, (double)l->own[0], z->f.value < 0 ? 1 : -1, z);
    return csg_smooth_is_positive(l, z) || csg_smooth_is_negative(l, z);
}

static inline unsigned csg_slab_mirrors(const float *own)
{
    return CSG_MIRROR_TURNED | CSG_MIRROR_Z;
}

#endif
