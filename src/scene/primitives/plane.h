/* SPDX-License-Identifier: MIT
 * The half-space of the points p with n . p <= d. Parameters: n, a unit vector, d. In float: n and
 * d, with all of its place and scale in them.
 */
#ifndef CSG_SCENE_PLANE_H
#define CSG_SCENE_PLANE_H

#include <float.h>

#include "scene/primitives/primitive_kit.h"

enum { CSG_PLANE_OWN = 4 };

/* A normal that is of unit length already, to the last bits, is left alone: printing and parsing
 * a scene again must not move its planes. */
static inline bool csg_plane_check(csg_refusal *refusal, double *v)
{
    for (int i = 0; i < 3; i++)
        if (!csg_check_range(refusal, v[i], "the normal"))
            return false;
    if (!csg_check_range(refusal, v[3], "the distance"))
        return false;
    double length = csg_vec3_norm(csg_vec3_make(v[0], v[1], v[2]));
    if (length < CSG_SMALLEST_LENGTH)
        return csg_refuse(refusal, "the normal must not be zero");
    if (fabs(length - 1) > 1e-15)
        for (int i = 0; i < 3; i++)
            v[i] /= length;
    return true;
}

static inline csg_sample csg_plane_distance(const double *v, csg_vec3 p)
{
    csg_vec3 normal = csg_vec3_make(v[0], v[1], v[2]);
    return (csg_sample){v[3] - csg_vec3_dot(normal, p), csg_vec3_scale(normal, -1)};
}

/* Bounded only along the plane's own normal, as nearly as it can be told. */
static inline double csg_plane_support(const double *v, csg_vec3 n)
{
    csg_vec3 normal = csg_vec3_make(v[0], v[1], v[2]);
    double along = csg_vec3_dot(n, normal), across = csg_vec3_norm(csg_vec3_cross(n, normal));
    return along > 0 && across <= 2 * DBL_EPSILON * along ? along * v[3] : INFINITY;
}

static inline bool csg_plane_has_face(const double *v, csg_vec3 n)
{
    csg_vec3 own = csg_vec3_make(v[0], v[1], v[2]);
    return csg_vec3_dot(own, n) > 0 &&
           csg_vec3_norm(csg_vec3_cross(own, n)) < 1e-9 * csg_vec3_norm(n);
}

static inline csg_term csg_plane_term(csg_terms *t, const double *v, const csg_term p[3])
{
    csg_term sum = csg_term_mul_number(t, p[0], v[0]);
    sum = csg_term_add(t, sum, csg_term_mul_number(t, p[1], v[1]));
    sum = csg_term_add(t, sum, csg_term_mul_number(t, p[2], v[2]));
    return csg_term_number_sub(t, v[3], sum);
}

static inline double csg_plane_depth(const double *v)
{
    return 0;
}

static inline bool csg_plane_balls(csg_ball_sink *to, const double *v)
{
    return false;
}

static inline void csg_plane_example(csg_random *random, double *v)
{
    const double axes[3][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    csg_example_sizes(random, v);
    double length;
    do { /* in a ball */
        for (int i = 0; i < 3; i++)
            v[i] = csg_random_uniform(random, -1, 1);
        length = csg_vec3_norm(csg_vec3_make(v[0], v[1], v[2]));
    } while (!(length > 0.1 && length < 1));
    for (int i = 0; i < 3; i++)
        v[i] *= 1 / length;
    if (csg_example_chance(random, 0.3))
        memcpy(v, axes[csg_random_below(random, 3)], sizeof axes[0]);
    v[3] = csg_random_uniform(random, -0.3, 0.5);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_plane_pack(csg_leaf *l, const double *v, double k)
{
    double factor = fabs(l->sigma);
    csg_vec3 n = {v[0], v[1], v[2]};
    csg_vec3 b = {l->to_own.t[0], l->to_own.t[1], l->to_own.t[2]};
    csg_vec3 normal = csg_vec3_scale(csg_affine_covector(&l->to_own, n), factor);
    l->own[0] = normal.x;
    l->own[1] = normal.y;
    l->own[2] = normal.z;
    l->own[3] = factor * (v[3] - csg_vec3_dot(n, b));
    l->frame = CSG_FRAME_OFFSET;
    l->offset = csg_vec3_make(0, 0, 0);
    l->sigma = l->sigma < 0 ? -1 : 1;
    l->magnitude = fabs(l->own[3]);
}

static inline float csg_plane_value(const float *own, point q, point *g)
{
    *g = (point){-own[0], -own[1], -own[2]};
    return own[3] - (own[0] * q.x + own[1] * q.y + own[2] * q.z);
}

static inline int csg_plane_falls_outwards(const float *own)
{
    return 0;
}

static inline bool csg_plane_gradients(csg_cone_leaf *l)
{
    const float *n = l->own;
    l->bend = 0;
    return csg_cone_add(l, -(double)n[0], -(double)n[1], -(double)n[2], 0);
}

static inline bool csg_plane_may_crease(const float *own, const float q[3], float reach, csg_band b)
{
    return false;
}

static inline bool csg_plane_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    *out = csg_smooth_line(l, (double)l->own[3], -(double)l->own[0], &l->p[0]);
    for (int k = 1; k < 3; k++)
        *out = csg_smooth_sum(l, out, -(double)l->own[k], &l->p[k]);
    return true;
}

static inline unsigned csg_plane_mirrors(const float *own)
{
    return 0; /* its place is in its own parameters */
}

#endif
