/* SPDX-License-Identifier: MIT
 * The balls of radius r1 + (r2 - r1) z / h around (0, 0, z), 0 <= z <= h. Parameters: h, r1, r2. In
 * float: h, 1 / h, r1, r2 - r1, s / c with s = (r1 - r2) / h, c = sqrt(1 - s^2).
 */
#ifndef CSG_SCENE_CAPSULE_H
#define CSG_SCENE_CAPSULE_H

#include "base/elementary.h"
#include "scene/primitives/primitive_kit.h"

enum { CSG_CAPSULE_OWN = 5 };

static inline bool csg_capsule_check(csg_refusal *refusal, double *v)
{
    if (!csg_check_positive(refusal, v[0], "the length") || !csg_check_radii(refusal, v[1], v[2]))
        return false;
    return fabs(v[1] - v[2]) < v[0] ||
           csg_refuse(refusal, "one end of the capsule swallows the other");
}

/* With k = (r1 - r2) / h and a = sqrt(1 - k k) the ball that reaches deepest has its centre at
 * z - k rho / a. */
static inline csg_sample csg_capsule_distance(const double *v, csg_vec3 p)
{
    double h = v[0], r1 = v[1], r2 = v[2];
    double k = (r1 - r2) / h, a = sqrt((1 - k) * (1 + k)), rho = csg_hypot(p.x, p.y);
    double center = p.z - k * rho / a;
    if (center <= 0)
        return csg_sample_ball(p, csg_vec3_make(0, 0, 0), r1);
    if (center >= h)
        return csg_sample_ball(p, csg_vec3_make(0, 0, h), r2);
    double value = r1 - k * p.z - a * rho;
    return rho > 0 ? csg_sample_revolve(p, rho, value, -a, -k)
                   : (csg_sample){value, csg_vec3_make(0, 0, 0)};
}

static inline double csg_capsule_support(const double *v, csg_vec3 n)
{
    double length = csg_vec3_norm(n);
    return fmax(v[1] * length, v[2] * length + v[0] * n.z);
}

static inline bool csg_capsule_has_face(const double *v, csg_vec3 n)
{
    return false;
}

static inline csg_term csg_capsule_term(csg_terms *t, const double *v, const csg_term p[3])
{
    double k = (v[1] - v[2]) / v[0], a = sqrt((1 - k) * (1 + k));
    csg_term rho = csg_term_norm2(t, p[0], p[1]);
    csg_term center = csg_term_sub(t, p[2], csg_term_mul_number(t, rho, k / a));
    center = csg_term_clamp(t, center, 0, v[0]);
    csg_term radius = csg_term_number_sub(t, v[1], csg_term_mul_number(t, center, k));
    return csg_term_sub(t, radius, csg_term_norm2(t, rho, csg_term_sub(t, p[2], center)));
}

static inline double csg_capsule_depth(const double *v)
{
    return v[1] == v[2] ? v[1] : 0;
}

static inline bool csg_capsule_balls(csg_ball_sink *to, const double *v)
{
    to->ball(to->user, csg_vec3_make(0, 0, 0), v[1]);
    to->ball(to->user, csg_vec3_make(0, 0, v[0]), v[2]);
    return true;
}

static inline void csg_capsule_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
    v[0] = fabs(v[1] - v[2]) + csg_random_uniform(random, 0.05, 1);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_capsule_pack(csg_leaf *l, const double *v, double k)
{
    double h = v[0] * k, r1 = v[1] * k, r2 = v[2] * k;
    double s = (r1 - r2) / h;
    double own[] = {h, 1 / h, r1, r2 - r1, s / sqrt(1 - s * s)};
    memcpy(l->own, own, sizeof own);
    l->magnitude = h + fmax(r1, r2);
}

/* The farthest-reaching ball in closed form. */
static inline float csg_capsule_value(const float *own, point q, point *g)
{
    float rho = sqrtf(q.x * q.x + q.y * q.y);
    float t = smaller(larger((q.z - rho * own[4]) * own[1], 0), 1.0f);
    float dz = q.z - t * own[0];
    float d = sqrtf(q.x * q.x + q.y * q.y + dz * dz);
    float s = quotient(-1.0f, d);
    *g = (point){q.x * s, q.y * s, dz * s};
    return own[2] + t * own[3] - d;
}

static inline int csg_capsule_falls_outwards(const float *own)
{
    return 0; /* it does not stand in the middle of its frame */
}

/* d changes by at most rho (1 + taper) within the ball. */
static inline bool csg_capsule_gradients(csg_cone_leaf *l)
{
    const float *own = l->own;
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double t = (l->q[2] - csg_hypot(l->q[0], l->q[1]) * (double)own[4]) * (double)own[1];
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double z = l->q[2] - t * (double)own[0];
    double d = sqrt(l->q[0] * l->q[0] + l->q[1] * l->q[1] + z * z);
    if (own[3] == 0)
        return csg_cone_add_away(l, l->q[0], l->q[1], z);
    double taper = fabs((double)own[3]) * (double)own[1], least = d - l->rho * (1 + taper);
    if (!(least > 0.7 * l->rho))
        return false;
    csg_capsule_value(own, q, &g);
    l->bend = 1 / least;
    return csg_cone_add(l, (double)g.x, (double)g.y, (double)g.z, l->rho * l->bend + 1e-5);
}

static inline bool csg_capsule_may_crease(const float *own, const float q[3], float reach,
                                          csg_band b)
{
    return csg_band_meets(b, fminf(own[2], own[2] + own[3]), INFINITY); /* on the axis */
}

/* Where a ball's end begins: of both the distance is one from the axis' segment. */
static inline bool csg_capsule_choose(const csg_smooth_leaf *l, bool is_first, csg_smooth *out)
{
    const double h = (double)l->own[0], r1 = (double)l->own[2], slant = (double)l->own[4];
    const double cosine = 1 / sqrt(1 + slant * slant);
    static const bool BOTH[2] = {true, true};
    csg_smooth rho, z = l->p[2], beyond;
    int way = csg_smooth_choose(l, BOTH, 2);
    if (!csg_smooth_radial(l, &rho))
        return false;
    beyond = csg_smooth_line(l, is_first ? 0 : -h, 1, &z);
    beyond = csg_smooth_sum(l, &beyond, -slant, &rho);
    csg_smooth_require(l, is_first == (way == 0) ? 1 : -1, &beyond);
    if (way == 0) {
        csg_smooth side = csg_smooth_line(l, r1, -cosine, &rho);
        *out = csg_smooth_sum(l, &side, -slant * cosine, &z);
        return true;
    }
    const csg_smooth *const p[3] = {&l->p[0], &l->p[1], &z};
    z.f.value -= is_first ? 0 : h;
    return csg_smooth_round(l, is_first ? r1 : r1 + (double)l->own[3], p, 3, out);
}

/* Between the ends a cone's mantle, beyond them a ball. */
static inline bool csg_capsule_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    const double h = (double)l->own[0], r1 = (double)l->own[2], slant = (double)l->own[4];
    csg_smooth rho, z = l->p[2];
    double across = csg_hypot(l->p[0].f.value, l->p[1].f.value);
    double center = z.f.value - slant * across, room = l->reach * (1 + fabs(slant)) * (1 + 1e-9);
    if (center - room > 0 && center + room < h) {
        double cosine = 1 / sqrt(1 + slant * slant);
        if (!csg_smooth_radial(l, &rho))
            return false;
        csg_smooth side = csg_smooth_line(l, r1, -cosine, &rho);
        *out = csg_smooth_sum(l, &side, -slant * cosine, &z);
        return true;
    }
    bool is_first = center + room < 0;
    if (l->choice && center - room <= h && center + room >= 0 &&
        (center - room > 0 || center + room < h))
        return csg_capsule_choose(l, center + room < h, out);
    const csg_smooth *const p[3] = {&l->p[0], &l->p[1], &z};
    z.f.value -= is_first ? 0 : h;
    return (is_first || center - room > h) &&
           csg_smooth_round(l, is_first ? r1 : r1 + (double)l->own[3], p, 3, out);
}

static inline unsigned csg_capsule_mirrors(const float *own)
{
    return CSG_MIRROR_TURNED; /* its middle is not that of its frame */
}

#endif
