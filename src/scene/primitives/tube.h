/* SPDX-License-Identifier: MIT
 * Tubes along Bezier curves of two degrees (curve.h). Parameters: x y z r of each control point.
 * Their leaves in the tape are pieces of the curve: packed by field/compile/compile_curve.h, run by
 * field/kernels/curve_kernel.c, with gradients by field/gradients/cone_curve.h.
 */
#ifndef CSG_SCENE_TUBE_H
#define CSG_SCENE_TUBE_H

#include "scene/primitives/capsule.h"
#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"

/* Own parameters of a piece, s = -1 to 1 along it, its middle the origin: coefficients of Q for s,
 * s^2, s^3, of r for 1, s, s^2, s^3, and of Q . Q' for s to s^5; whether r varies. */
enum {
    CSG_TUBE_FIRST,
    CSG_TUBE_RADII = CSG_TUBE_FIRST + 9,
    CSG_TUBE_PRODUCTS = CSG_TUBE_RADII + 4,
    CSG_TUBE_VARIES = CSG_TUBE_PRODUCTS + 5,
    CSG_TUBE_OWN
};

static inline bool csg_tube_check(csg_primitive_kind kind, csg_refusal *refusal, const double *v)
{
    double most = 0;
    for (uint32_t i = 0; i < csg_primitive_parameter_count(kind); i++) {
        bool is_radius = i % CSG_CURVE_AXES == CSG_CURVE_RADIUS;
        if (!(is_radius ? csg_check_not_negative(refusal, v[i], "the radius")
                        : csg_check_range(refusal, v[i], "a control point")))
            return false;
        most = is_radius ? fmax(most, v[i]) : most;
    }
    return most >= CSG_SMALLEST_LENGTH || csg_refuse(refusal, "one of the radii must be positive");
}

static inline csg_sample csg_tube_distance(csg_primitive_kind kind, const double *v, csg_vec3 p)
{
    csg_curve bezier = csg_curve_make(kind, v);
    csg_vec3 to;
    double value = csg_curve_nearest(&bezier, p, &to);
    return (csg_sample){value, csg_vec3_normalize(to)};
}

static inline double csg_tube_support(csg_primitive_kind kind, const double *v, csg_vec3 n)
{
    csg_curve bezier = csg_curve_make(kind, v);
    return csg_curve_support(&bezier, n, csg_vec3_norm(n));
}

/* The balls between two of a curve's: a capsule in its own frame, or the larger ball where that
 * holds the other. */
static inline csg_term csg_tube_chord_term(csg_terms *t, const double *a, const double *b,
                                           const csg_term p[3])
{
    csg_vec3 d = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double r1 = a[CSG_CURVE_RADIUS], r2 = b[CSG_CURVE_RADIUS], length = csg_vec3_norm(d);
    const double *larger_end = r1 >= r2 ? a : b;
    bool is_ball = !(fabs(r1 - r2) < length);
    csg_term own[3];
    for (int i = 0; i < 3; i++)
        own[i] = csg_term_sub_number(t, p[i], is_ball ? larger_end[i] : a[i]);
    if (is_ball)
        return csg_term_number_sub(t, fmax(r1, r2), csg_term_norm3(t, own[0], own[1], own[2]));
    csg_affine place = csg_affine_z_to(d);
    csg_term turned[3];
    for (int i = 0; i < 3; i++) {
        turned[i] = csg_term_mul_number(t, own[0], place.m[0][i]);
        for (int k = 1; k < 3; k++)
            turned[i] = csg_term_add(t, turned[i], csg_term_mul_number(t, own[k], place.m[k][i]));
    }
    return csg_capsule_term(t, (double[]){length, r1, r2}, turned);
}

/* No formula of a point's nearest ball is short: chords within 1e-4 of the largest radius. */
static inline csg_term csg_tube_term(csg_primitive_kind kind, csg_terms *t, const double *v,
                                     const csg_term p[3])
{
    csg_curve bezier = csg_curve_make(kind, v);
    double largest = 0, from[CSG_CURVE_AXES], to[CSG_CURVE_AXES];
    for (int i = 0; i <= bezier.degree; i++)
        largest = fmax(largest, bezier.at[i][CSG_CURVE_RADIUS]);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&bezier, 1e-4 * largest), 1e5);
    csg_term all = CSG_FORMULA_NONE;
    csg_curve_at(&bezier, 0, from);
    for (uint32_t i = 1; i <= chords; i++) {
        csg_curve_at(&bezier, (double)i / chords, to);
        csg_term one = csg_tube_chord_term(t, from, to, p);
        all = i > 1 ? csg_term_max(t, all, one) : one;
        for (int k = 0; k < CSG_CURVE_AXES; k++)
            from[k] = to[k];
    }
    return all;
}

static inline double csg_tube_depth(csg_primitive_kind kind, const double *v)
{
    csg_curve bezier = csg_curve_make(kind, v);
    return csg_curve_only_radius(&bezier);
}

/* Those between chords of which the tube differs from their hull by little. */
static inline bool csg_tube_balls(csg_primitive_kind kind, csg_ball_sink *to, const double *v)
{
    const double most = 4000;
    csg_curve bezier = csg_curve_make(kind, v);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&bezier, to->within), most);
    for (uint32_t i = 0; i <= chords; i++) {
        double at[CSG_CURVE_AXES];
        csg_curve_at(&bezier, (double)i / chords, at);
        to->ball(to->user, csg_vec3_make(at[0], at[1], at[2]), at[CSG_CURVE_RADIUS]);
    }
    return true;
}

/* Control points within about [-1, 1]^3: tame, wild, straight, with cusps, loops, sides of no
 * length and control points that coincide; of one radius, with changing radii, pointed. */
static inline void csg_tube_example(csg_primitive_kind kind, csg_random *random, double *v)
{
    int count = (int)csg_primitive_parameter_count(kind) / CSG_CURVE_AXES;
    uint32_t shape = csg_random_below(random, 8), radii = csg_random_below(random, 4);
    double reach = shape < 3 ? 0.3 : 1, r = csg_random_uniform(random, 0.02, 0.5);
    for (int i = 0; i < count; i++) {
        double *p = v + CSG_CURVE_AXES * i, along = 2.0 * i / (count - 1) - 1;
        for (int k = 0; k < 3; k++)
            p[k] = csg_random_uniform(random, -reach, reach);
        if (shape < 3) /* tame */
            p[0] += along;
        if (shape == 3) { /* straight */
            p[0] = along * 0.8;
            p[1] = p[2] = 0;
        }
        if (shape == 4 && i > 0 && csg_random_below(random, 2)) /* some coincide */
            for (int k = 0; k < 3; k++)
                p[k] = p[k - CSG_CURVE_AXES];
        if (shape == 5) /* in a plane: cusps and loops when crossed */
            p[2] = 0;
        p[CSG_CURVE_RADIUS] = radii == 0   ? csg_random_uniform(random, 0.02, 0.5)
                              : radii == 1 ? fmax(csg_random_uniform(random, -0.1, 0.3), 0)
                                           : r;
    }
    if (shape == 5 && count == 4) /* a cusp in the middle, or nearly */
        for (int k = 0; k < 2; k++) {
            v[4 + k] = v[12 + k] + csg_random_uniform(random, -0.05, 0.05);
            v[8 + k] = v[k];
        }
    if (radii == 1)
        v[CSG_CURVE_RADIUS] = 0.2;
}

/* The functions of one degree, under the names that the table of primitives expects. */
#define CSG_TUBE_FUNCTIONS(NAME, name)                                                             \
    static inline bool csg_##name##_check(csg_refusal *refusal, double *v)                         \
    {                                                                                              \
        return csg_tube_check(CSG_NODE_##NAME, refusal, v);                                        \
    }                                                                                              \
    static inline csg_sample csg_##name##_distance(const double *v, csg_vec3 p)                    \
    {                                                                                              \
        return csg_tube_distance(CSG_NODE_##NAME, v, p);                                           \
    }                                                                                              \
    static inline double csg_##name##_support(const double *v, csg_vec3 n)                         \
    {                                                                                              \
        return csg_tube_support(CSG_NODE_##NAME, v, n);                                            \
    }                                                                                              \
    static inline bool csg_##name##_has_face(const double *v, csg_vec3 n)                          \
    {                                                                                              \
        return false;                                                                              \
    }                                                                                              \
    static inline csg_term csg_##name##_term(csg_terms *t, const double *v, const csg_term p[3])   \
    {                                                                                              \
        return csg_tube_term(CSG_NODE_##NAME, t, v, p);                                            \
    }                                                                                              \
    static inline double csg_##name##_depth(const double *v)                                       \
    {                                                                                              \
        return csg_tube_depth(CSG_NODE_##NAME, v);                                                 \
    }                                                                                              \
    static inline bool csg_##name##_balls(csg_ball_sink *to, const double *v)                      \
    {                                                                                              \
        return csg_tube_balls(CSG_NODE_##NAME, to, v);                                             \
    }                                                                                              \
    static inline void csg_##name##_example(csg_random *random, double *v)                         \
    {                                                                                              \
        csg_tube_example(CSG_NODE_##NAME, random, v);                                              \
    }                                                                                              \
    static inline bool csg_##name##_may_crease(const float *own, const float q[3], float reach,    \
                                               csg_band b)                                         \
    {                                                                                              \
        return true;                                                                               \
    }
CSG_TUBE_FUNCTIONS(QUADRATIC_TUBE, quadratic_tube)
CSG_TUBE_FUNCTIONS(CUBIC_TUBE, cubic_tube)
#undef CSG_TUBE_FUNCTIONS

#endif
