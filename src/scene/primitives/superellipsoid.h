/* SPDX-License-Identifier: MIT
 * Barr's superellipsoid, f = (1 - d) / L with his gauge d and its Lipschitz constant L. Parameters:
 * semi-axes a, b, c, exponents q within x y and p with z, L (found by the check). In float: a, b,
 * c, q, p, 1 / L; its float formula, csg_superellipsoid_value, is Ricci's operator twice and stands
 * with that one in field/kernels/soft_formulas.h.
 */
#ifndef CSG_SCENE_SUPERELLIPSOID_H
#define CSG_SCENE_SUPERELLIPSOID_H

#include <float.h>

#include "base/elementary.h"
#include "scene/primitives/primitive_kit.h"

enum { CSG_SUPERELLIPSOID_OWN = 6 };

/* Of the gauge of an ellipse-like figure with exponent p whose axes have constants a and b. */
static inline double csg_gauge_slope_of_two(double a, double b, double p)
{
    double most = fmax(a, b), s = 2 * p / (2 - p);
    return p >= 2 ? most : most * csg_pow(csg_pow(a / most, s) + csg_pow(b / most, s), 1 / s);
}

/* Lipschitz constant of the gauge. */
static inline double csg_gauge_slope(const double *v)
{
    return csg_gauge_slope_of_two(csg_gauge_slope_of_two(1 / v[0], 1 / v[1], v[3]), 1 / v[2], v[4]);
}

static inline bool csg_superellipsoid_check(csg_refusal *refusal, double *v)
{
    const double most = 64;
    for (int i = 0; i < 3; i++)
        if (!csg_check_positive(refusal, v[i], "the semi-axis"))
            return false;
    for (int i = 3; i < 5; i++)
        if (!(v[i] >= 1 && v[i] <= most))
            return csg_refuse(refusal, "an exponent must be 1 to %g, not %g", most, v[i]);
    v[5] = csg_gauge_slope(v);
    return true;
}

/* (|x|^p + |y|^p)^(1/p) for x, y >= 0 and its derivatives: the larger in front, so that no power
 * overflows. */
static inline double csg_power_norm(double x, double y, double p, double *dx, double *dy)
{
    double most = fmax(x, y);
    *dx = *dy = 0;
    if (!(most > 0))
        return 0;
    double d = most * csg_pow(csg_pow(x / most, p) + csg_pow(y / most, p), 1 / p);
    *dx = csg_pow(x / d, p - 1);
    *dy = csg_pow(y / d, p - 1);
    return d;
}

static inline csg_sample csg_superellipsoid_distance(const double *v, csg_vec3 p)
{
    double dx, dy, dxy, dz;
    double across = csg_power_norm(fabs(p.x) / v[0], fabs(p.y) / v[1], v[3], &dx, &dy);
    double d = csg_power_norm(across, fabs(p.z) / v[2], v[4], &dxy, &dz);
    csg_vec3 gradient =
        csg_vec3_make(-csg_sign(p.x) * dx * dxy / v[0] / v[5],
                      -csg_sign(p.y) * dy * dxy / v[1] / v[5], -csg_sign(p.z) * dz / v[2] / v[5]);
    return (csg_sample){(1 - d) / v[5], gradient};
}

/* Largest x u + y w where |u|^p + |w|^p <= 1 (Hoelder). */
static inline double csg_dual_norm(double x, double y, double p)
{
    double most = fmax(fabs(x), fabs(y)), q = p / (p - 1);
    if (p == 1 || most == 0)
        return most;
    return most * csg_pow(csg_pow(fabs(x) / most, q) + csg_pow(fabs(y) / most, q), 1 / q);
}

static inline double csg_superellipsoid_support(const double *v, csg_vec3 n)
{
    double across = csg_dual_norm(v[0] * n.x, v[1] * n.y, v[3]);
    return csg_dual_norm(across, v[2] * n.z, v[4]) * (1 + 16 * DBL_EPSILON);
}

static inline bool csg_superellipsoid_has_face(const double *v, csg_vec3 n)
{
    return false;
}

/* (|x|^n + |y|^n)^(1/n) */
static inline csg_term csg_power_norm_term(csg_terms *t, csg_term x, csg_term y, double n)
{
    csg_term sum = csg_term_add(t, csg_term_pow_number(t, csg_term_abs(t, x), n),
                                csg_term_pow_number(t, csg_term_abs(t, y), n));
    return csg_term_pow_number(t, sum, 1 / n);
}

static inline csg_term csg_superellipsoid_term(csg_terms *t, const double *v, const csg_term p[3])
{
    csg_term across = csg_power_norm_term(t, csg_term_mul_number(t, p[0], 1 / v[0]),
                                          csg_term_mul_number(t, p[1], 1 / v[1]), v[3]);
    csg_term whole = csg_power_norm_term(t, across, csg_term_mul_number(t, p[2], 1 / v[2]), v[4]);
    return csg_term_mul_number(t, csg_term_number_sub(t, 1, whole), 1 / v[5]);
}

static inline double csg_superellipsoid_depth(const double *v)
{
    return 1 / v[5];
}

static inline bool csg_superellipsoid_balls(csg_ball_sink *to, const double *v)
{
    return false;
}

static inline void csg_superellipsoid_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
    v[3] = csg_random_uniform(random, 1, 6);
    v[4] = csg_example_chance(random, 0.5) ? v[3] : csg_random_uniform(random, 1, 6);
    v[5] = 0;
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_superellipsoid_pack(csg_leaf *l, const double *v, double k)
{
    for (int i = 0; i < 5; i++)
        l->own[i] = i < 3 ? v[i] * k : v[i];
    l->own[5] = k / v[5];
    l->magnitude = fmax(v[0], fmax(v[1], v[2])) * k + l->own[5];
}

static inline int csg_superellipsoid_falls_outwards(const float *own)
{
    return 1;
}

static inline bool csg_superellipsoid_gradients(csg_cone_leaf *l)
{
    return false; /* none is known */
}

static inline bool csg_superellipsoid_may_crease(const float *own, const float q[3], float reach,
                                                 csg_band b)
{
    return true;
}

/* Its formula, in powers; it is no distance, and nobody asks for its derivatives. */
static inline bool csg_superellipsoid_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    const double q = (double)l->own[3], p = (double)l->own[4];
    csg_taylor parts[3], across, sum;
    if (l->with_slopes)
        return false;
    for (int i = 0; i < 3; i++) {
        csg_taylor share = csg_taylor_scaled(&l->p[i].f, 1 / (double)l->own[i]);
        if (!csg_taylor_power(&share, i < 2 ? q : p, l->radius, &parts[i]))
            return false;
    }
    across = csg_taylor_sum(&parts[0], 1, &parts[1]);
    if (p != q && !csg_taylor_power(&across, p / q, l->radius, &across))
        return false;
    sum = csg_taylor_sum(&across, 1, &parts[2]);
    if (!csg_taylor_power(&sum, 1 / p, l->radius, &sum))
        return false;
    out->f = csg_taylor_scaled(&sum, -(double)l->own[5]);
    out->f.value += (double)l->own[5];
    return true;
}

static inline unsigned csg_superellipsoid_mirrors(const float *own)
{
    return CSG_MIRROR_SIGNS | (own[0] == own[1] ? CSG_MIRROR_XY : 0);
}

#endif
