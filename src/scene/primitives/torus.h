/* SPDX-License-Identifier: MIT
 * A ring around the z axis, or an arc of it on both sides of +x with balls at its ends. Parameters:
 * R, tube radius, half the opening angle in degrees. In float: R, r, cosine and sine of half the
 * opening angle.
 */
#ifndef CSG_SCENE_TORUS_H
#define CSG_SCENE_TORUS_H

#include "base/elementary.h"
#include "scene/primitives/primitive_kit.h"

enum { CSG_TORUS_OWN = 4 };

static inline bool csg_torus_check(csg_refusal *refusal, double *v)
{
    if (!csg_check_positive(refusal, v[0], "the radius") ||
        !csg_check_positive(refusal, v[1], "the tube radius"))
        return false;
    return (v[2] > 0 && v[2] <= 180) ||
           csg_refuse(refusal, "the angle must be above 0 and at most 360 degrees");
}

static inline csg_sample csg_torus_distance(const double *v, csg_vec3 p)
{
    double big = v[0], small = v[1], half = v[2];
    csg_affine turn = csg_affine_rotate(half, csg_vec3_make(0, 0, 1)); /* exact: quarter turns */
    double cosine = turn.m[0][0], sine = turn.m[1][0];
    if (half < 180 && sine * p.x - cosine * fabs(p.y) < 0) {
        double side = p.y < 0 ? -1 : 1;
        return csg_sample_ball(p, csg_vec3_make(big * cosine, side * big * sine, 0), small);
    }
    double rho = csg_hypot(p.x, p.y);
    if (!(rho > 0)) /* all points of the arc are nearest: the one on +x */
        return csg_sample_ball(p, csg_vec3_make(big, 0, 0), small);
    double distance = csg_hypot(rho - big, p.z);
    if (!(distance > 0))
        return (csg_sample){small, csg_vec3_make(0, 0, 0)};
    return csg_sample_revolve(p, rho, small - distance, -(rho - big) / distance, -p.z / distance);
}

static inline double csg_torus_support(const double *v, csg_vec3 n)
{
    double across = csg_hypot(n.x, n.y);
    csg_affine turn = csg_affine_rotate(v[2], csg_vec3_make(0, 0, 1));
    double cosine = turn.m[0][0], sine = turn.m[1][0];
    bool on_arc = v[2] >= 180 || sine * n.x - cosine * fabs(n.y) >= 0;
    double reach = on_arc ? across : cosine * n.x + sine * fabs(n.y);
    return v[0] * reach + v[1] * csg_vec3_norm(n);
}

static inline bool csg_torus_has_face(const double *v, csg_vec3 n)
{
    return false;
}

/* In the plane the squared distance to the arc is rho^2 + R^2 - 2 R g, where g is rho within the
 * arc's angle and the part of the point along its end elsewhere. */
static inline csg_term csg_torus_term(csg_terms *t, const double *v, const csg_term p[3])
{
    csg_term rho = csg_term_norm2(t, p[0], p[1]);
    csg_term away = csg_term_norm2(t, csg_term_sub_number(t, rho, v[0]), p[2]);
    if (v[2] < 180) {
        csg_affine turn = csg_affine_rotate(v[2], csg_vec3_make(0, 0, 1));
        double cosine = turn.m[0][0], sine = turn.m[1][0];
        csg_term y = csg_term_abs(t, p[1]);
        csg_term beyond =
            csg_term_sub(t, csg_term_mul_number(t, y, cosine), csg_term_mul_number(t, p[0], sine));
        csg_term end = csg_term_norm3(t, csg_term_sub_number(t, p[0], v[0] * cosine),
                                      csg_term_sub_number(t, y, v[0] * sine), p[2]);
        away = csg_term_mix(t, away, end, csg_term_step(t, beyond));
    }
    return csg_term_number_sub(t, v[1], away);
}

static inline double csg_torus_depth(const double *v)
{
    return v[1];
}

static inline bool csg_torus_balls(csg_ball_sink *to, const double *v)
{
    to->arc(to->user, v[0], 0, v[2], v[1]);
    return true;
}

static inline void csg_torus_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
    v[1] = csg_random_uniform(random, 0.05, 0.35);
    v[2] = csg_example_chance(random, 0.4) ? 180 : csg_random_uniform(random, 5, 180);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_torus_pack(csg_leaf *l, const double *v, double k)
{
    double half = v[2] * (3.14159265358979323846 / 180);
    bool whole = v[2] >= 180;
    double own[] = {v[0] * k, v[1] * k, whole ? -1 : csg_cos(half), whole ? 0 : csg_sin(half)};
    memcpy(l->own, own, sizeof own);
    l->magnitude = own[0] + own[1];
}

static inline float csg_torus_value(const float *own, point q, point *g)
{
    float rho = sqrtf(q.x * q.x + q.y * q.y);
    float ay = absolute(q.y);
    int on_arc = ay * own[2] - q.x * own[3] <= 0;
    float k = quotient(own[0], rho); /* nearest skeleton point: (k x, k y, 0), or the arc's end */
    float dx = on_arc ? q.x - k * q.x : q.x - own[0] * own[2];
    float dy = on_arc ? ay - k * ay : ay - own[0] * own[3];
    float ring = rho - own[0];
    float flat = on_arc ? ring * ring : dx * dx + dy * dy;
    float d = sqrtf(flat + q.z * q.z);
    float s = quotient(-1.0f, d);
    float radial = quotient(ring, rho) * s;
    *g = (point){on_arc ? q.x * radial : dx * s, on_arc ? q.y * radial : sign_of(q.y) * dy * s,
                 q.z * s};
    return own[1] - d;
}

static inline int csg_torus_falls_outwards(const float *own)
{
    return 0; /* it has a hole */
}

static inline bool csg_torus_gradients(csg_cone_leaf *l)
{
    const float *own = l->own;
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double radius = csg_hypot(l->q[0], l->q[1]) - l->rho;
    double d = (double)own[1] - (double)csg_torus_value(own, q, &g) - l->rho;
    bool is_arc = own[2] > -1;
    /* In the gap the nearer end changes from one side of y = 0 to the other. */
    if (is_arc && fabs(l->q[1]) <= l->rho && l->q[0] <= l->rho)
        return false;
    if (!(d > 0.7 * l->rho && radius > 0.7 * l->rho))
        return false;
    l->bend = 1 / fmin(d, radius);
    return csg_cone_add(l, (double)g.x, (double)g.y, (double)g.z, l->rho * l->bend + 1e-5);
}

/* At the core curve, and on the axis through the ring; an arc has more such places outside. */
static inline bool csg_torus_may_crease(const float *own, const float q[3], float reach, csg_band b)
{
    return csg_band_meets(b, own[1], own[1]) || csg_band_meets(b, -INFINITY, own[1] - own[0]) ||
           (own[2] > -1 && b.low < 0);
}

/* Where the ring is nearest, or one of an arc's ends. */
static inline bool csg_torus_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    const double big = (double)l->own[0], small = (double)l->own[1];
    const double cosine = (double)l->own[2], sine = (double)l->own[3];
    double side = l->p[1].f.value < 0 ? -1 : 1;
    csg_smooth turned = csg_smooth_scaled(l, side * cosine, &l->p[1]);
    csg_smooth past = csg_smooth_sum(l, &turned, -sine, &l->p[0]); /* the end, > 0 */
    csg_smooth rho, x, y;
    bool is_whole = !(cosine > -1);
    bool has_side = csg_smooth_is_positive(l, &l->p[1]) || csg_smooth_is_negative(l, &l->p[1]);
    if (is_whole || (has_side && csg_smooth_is_negative(l, &past))) {
        const csg_smooth *const to_ring[2] = {&x, &l->p[2]};
        if (!csg_smooth_radial(l, &rho))
            return false;
        x = csg_smooth_line(l, -big, 1, &rho);
        return csg_smooth_round(l, small, to_ring, 2, out);
    } else {
        const csg_smooth *const to_end[3] = {&x, &y, &l->p[2]};
        x = csg_smooth_line(l, -big * cosine, 1, &l->p[0]);
        y = csg_smooth_line(l, -big * sine, side, &l->p[1]);
        return has_side && csg_smooth_is_positive(l, &past) &&
               csg_smooth_round(l, small, to_end, 3, out);
    }
}

static inline unsigned csg_torus_mirrors(const float *own)
{
    bool is_arc = own[2] > -1;
    return CSG_MIRROR_Y | CSG_MIRROR_Z | (is_arc ? 0 : CSG_MIRROR_TURNED);
}

#endif
