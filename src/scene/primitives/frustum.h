/* SPDX-License-Identifier: MIT
 * A cylinder or a cone's frustum along z, grown by a rounding. Parameters: radii at z = -h and
 * z = +h, h, rounding. In float: r1, (r1 + r2) / 2, h, nx, nz (the side's outward normal), length
 * of the side, rounding, (r2 - r1) / 2 (not r1, r2: gcc 12 does not vectorise a choice between two
 * parameters).
 */
#ifndef CSG_SCENE_FRUSTUM_H
#define CSG_SCENE_FRUSTUM_H

#include "base/elementary.h"
#include "scene/primitives/primitive_kit.h"

enum { CSG_FRUSTUM_OWN = 8 };

static inline bool csg_frustum_check(csg_refusal *refusal, double *v)
{
    return csg_check_radii(refusal, v[0], v[1]) &&
           csg_check_positive(refusal, v[2], "the height") &&
           csg_check_not_negative(refusal, v[3], "the rounding radius");
}

/* In the half plane (rho, z) a frustum is a convex polygon; its edges are the top, the bottom and
 * the slant (r1, -h)-(r2, h). Inside, the nearest of their lines; outside, the nearest edge. */
static inline csg_sample csg_frustum_distance(const double *v, csg_vec3 p)
{
    double r1 = v[0], r2 = v[1], h = v[2], round = v[3];
    double rho = csg_hypot(p.x, p.y), length = csg_hypot(r2 - r1, 2 * h);
    double n_rho = 2 * h / length, n_z = (r1 - r2) / length;
    double slant = n_rho * (rho - r1) + n_z * (p.z + h), cap = fabs(p.z) - h;
    if (slant <= 0 && cap <= 0) {
        if (slant > cap)
            return csg_sample_revolve(p, rho, round - slant, -n_rho, -n_z);
        return csg_sample_revolve(p, rho, round - cap, 0, -csg_sign(p.z));
    }
    double t = ((r2 - r1) * (rho - r1) + 2 * h * (p.z + h)) / (length * length);
    double clamped = fmin(fmax(t, 0), 1);
    double d_rho = rho - (r1 + (r2 - r1) * clamped), d_z = p.z - h * (2 * clamped - 1);
    double distance = csg_hypot(d_rho, d_z);
    if (t > 0 && t < 1 && slant > 0) { /* without the cancellation of d_rho and d_z */
        distance = slant;
        d_rho = n_rho * slant;
        d_z = n_z * slant;
    }
    double radius = p.z > 0 ? r2 : r1, over = fmax(rho - radius, 0);
    if (cap > 0 && csg_hypot(over, cap) < distance) {
        distance = csg_hypot(over, cap);
        d_rho = over;
        d_z = csg_sign(p.z) * cap;
    }
    if (!(distance > 0))
        return csg_sample_revolve(p, rho, round, -n_rho, -n_z);
    return csg_sample_revolve(p, rho, round - distance, -d_rho / distance, -d_z / distance);
}

static inline double csg_frustum_support(const double *v, csg_vec3 n)
{
    double across = csg_hypot(n.x, n.y);
    return fmax(v[0] * across - v[2] * n.z, v[1] * across + v[2] * n.z) + v[3] * csg_vec3_norm(n);
}

static inline bool csg_frustum_has_face(const double *v, csg_vec3 n)
{
    return csg_is_along(n, 2) && (n.z < 0 ? v[0] : v[1]) > 0;
}

/* Distance from (rho, z) to the segment (r1, -h)-(r2, h). */
static inline csg_term csg_frustum_slant_term(csg_terms *t, const double *v, csg_term rho,
                                              csg_term z)
{
    double dr = v[1] - v[0], dz = 2 * v[2], square = dr * dr + dz * dz;
    csg_term from_r = csg_term_sub_number(t, rho, v[0]), from_z = csg_term_add_number(t, z, v[2]);
    csg_term along = csg_term_add(t, csg_term_mul_number(t, from_r, dr / square),
                                  csg_term_mul_number(t, from_z, dz / square));
    along = csg_term_clamp(t, along, 0, 1);
    return csg_term_norm2(t, csg_term_sub(t, from_r, csg_term_mul_number(t, along, dr)),
                          csg_term_sub(t, from_z, csg_term_mul_number(t, along, dz)));
}

static inline csg_term csg_frustum_term(csg_terms *t, const double *v, const csg_term p[3])
{
    double length = csg_hypot(v[1] - v[0], 2 * v[2]);
    csg_term rho = csg_term_norm2(t, p[0], p[1]);
    csg_term slant = csg_term_add(
        t, csg_term_mul_number(t, csg_term_sub_number(t, rho, v[0]), 2 * v[2] / length),
        csg_term_mul_number(t, csg_term_add_number(t, p[2], v[2]), (v[0] - v[1]) / length));
    csg_term cap = csg_term_sub_number(t, csg_term_abs(t, p[2]), v[2]);
    csg_term outside = csg_frustum_slant_term(t, v, rho, p[2]);
    for (int end = 0; end < 2; end++) {
        csg_term over = csg_term_max_number(t, csg_term_sub_number(t, rho, v[end]), 0);
        csg_term away = csg_term_sub_number(t, p[2], end ? v[2] : -v[2]);
        outside = csg_term_min(t, outside, csg_term_norm2(t, over, away));
    }
    return csg_term_number_sub(t, v[3], csg_term_convex(t, csg_term_max(t, slant, cap), outside));
}

static inline double csg_frustum_depth(const double *v)
{
    return 0;
}

static inline bool csg_frustum_balls(csg_ball_sink *to, const double *v)
{
    to->arc(to->user, v[0], -v[2], 180, v[3]);
    to->arc(to->user, v[1], v[2], 180, v[3]);
    return true;
}

static inline void csg_frustum_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
    v[csg_random_below(random, 2)] *= csg_example_chance(random, 0.3) ? 0 : 1; /* pointed */
    v[1] = csg_example_chance(random, 0.3) && v[0] > 0 ? v[0] : v[1];          /* straight */
    v[3] = csg_example_chance(random, 0.5) ? 0 : csg_random_uniform(random, 0, 0.2);
}

/* ---- in float ------------------------------------------------------------------------------- */

static inline void csg_frustum_pack(csg_leaf *l, const double *v, double k)
{
    double r1 = v[0] * k, r2 = v[1] * k, h = v[2] * k;
    double length = csg_hypot(2 * h, r1 - r2);
    double own[] = {r1,       (r1 + r2) / 2, h, 2 * h / length, (r1 - r2) / length, length,
                    v[3] * k, (r2 - r1) / 2};
    memcpy(l->own, own, sizeof own);
    l->magnitude = csg_hypot(fmax(r1, r2), h) + v[3] * k;
}

/* Distance to a convex outline in the (rho, z) half plane: the side from (r1, -h) to (r2, h) and
 * the flat caps. Differences to the side's line, not to nearest points, so that the gradient is
 * exact where roots lie: on the surface. */
static inline float csg_frustum_value(const float *own, point q, point *g)
{
    float rho = sqrtf(q.x * q.x + q.y * q.y);
    float dx = rho - own[0], dz = q.z + own[2];
    float side = dx * own[3] + dz * own[4];
    float along = dz * own[3] - dx * own[4];
    float beyond = along - smaller(larger(along, 0), own[5]);
    float cap = absolute(q.z) - own[2];
    float over = larger(rho - (own[1] + sign_of(q.z) * own[7]), 0);
    float square_side = side * side + beyond * beyond, square_cap = over * over + cap * cap;
    int is_side = square_side < square_cap;
    int is_in = larger(side, cap) <= 0;
    float distance = sqrtf(is_side ? square_side : square_cap);
    float turn = is_in ? 1.0f : -1.0f;
    /* Unit vector from the nearest point, across and along the face; on it the face's own normal.
     */
    float across = distance > 0 ? turn * (is_side ? side : cap) / distance : -1.0f;
    float past = turn * quotient(is_side ? beyond : over, distance);
    float radial = is_side ? across * own[3] - past * own[4] : past;
    float axial = is_side ? across * own[4] + past * own[3] : across * sign_of(q.z);
    float k = quotient(radial, rho);
    *g = (point){q.x * k, q.y * k, axial};
    return own[6] + turn * distance;
}

static inline int csg_frustum_falls_outwards(const float *own)
{
    return own[7] == 0; /* a cylinder */
}

/* The side's normal turns with the azimuth. */
static inline bool csg_frustum_gradients(csg_cone_leaf *l)
{
    const float *own = l->own;
    double radius = csg_hypot(l->q[0], l->q[1]), nx = (double)own[3], nz = (double)own[4];
    double side = (radius - (double)own[0]) * nx + (l->q[2] + (double)own[2]) * nz;
    double top = l->q[2] - (double)own[2], bottom = -l->q[2] - (double)own[2];
    double most = fmax(side, fmax(top, bottom));
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double value = (double)own[6] - (double)csg_frustum_value(own, q, &g);
    /* All over the ball the nearest place is on the side, or on a cap. */
    double along = (l->q[2] + (double)own[2]) * nx - (radius - (double)own[0]) * nz;
    double wide = l->rho * (1 + 1e-4), turn = csg_cone_turn_within(radius, l->rho);
    if (side > wide && along > wide && along + wide < (double)own[5] && turn < 1.4) {
        l->bend = nx / (radius - l->rho);
        return csg_cone_add(l, -nx * l->q[0] / radius, -nx * l->q[1] / radius, -nz, nx * turn);
    }
    double rim = (double)own[1] + (l->q[2] < 0 ? -(double)own[7] : (double)own[7]);
    if (fabs(l->q[2]) - (double)own[2] > wide && radius + wide < rim) {
        l->bend = 0;
        return csg_cone_add(l, 0, 0, copysign(1, -l->q[2]), 0);
    }
    if (most > 0 && value > 1.2 * l->rho) {
        l->bend = 1 / (value * (1 - 1e-5) - l->rho);
        return csg_cone_add(l, (double)g.x, (double)g.y, (double)g.z,
                            csg_cone_turn_within(value, l->rho) + 1e-5);
    }
    /* Outside by up to 2.2 rho; at an acute rim a face takes part from further below its plane. */
    double from = fmin(0, most - l->rho), reach = l->rho * (1 + 2.2 / nx);
    uint32_t faces = 0;
    bool done = true;
    l->sharp_from = (double)own[6];
    if (side + reach >= from) {
        double v = (double)own[6] - side;
        double ex = radius > 0 ? l->q[0] / radius : 0, ey = radius > 0 ? l->q[1] / radius : 0;
        const csg_cone_face bent = {v, 0.5 * nx * turn * l->rho, 0},
                            tip = {v, nx * l->rho, nx * l->rho};
        done = turn < 1.4 ? csg_cone_add_bent_face(l, -nx * ex, -nx * ey, -nz, nx * turn, bent)
                          : csg_cone_add_bent_face(l, 0, 0, -nz, nx, tip);
        faces++;
    }
    if (top + reach >= from && (own[1] + own[7] > 0 || own[6] > 0)) {
        done = done && csg_cone_add_face(l, 0, 0, -1, (double)own[6] - top);
        faces++;
    }
    if (bottom + reach >= from && (own[0] > 0 || own[6] > 0)) {
        done = done && csg_cone_add_face(l, 0, 0, 1, (double)own[6] - bottom);
        faces++;
    }
    if (faces == 1 && side + reach >= from && turn < 1.4)
        l->bend = nx / (radius - l->rho);
    l->balls->has_edges |= faces > 1 && own[6] == 0;
    return done;
}

/* The rims, the tips of cones, and what goes on from there inside. */
static inline bool csg_frustum_may_crease(const float *own, const float q[3], float reach,
                                          csg_band b)
{
    float rho = sqrtf(q[0] * q[0] + q[1] * q[1]), best = INFINITY;
    for (int side = -1; side <= 1; side += 2) {
        float over = rho - (own[1] + (float)side * own[7]), along = q[2] - (float)side * own[2];
        best = fminf(best, sqrtf(over * over + along * along));
    }
    return b.high > own[6] || best <= reach + 2 * own[6];
}

/* What is rounded less the distance from the side, which of a cylinder is that from its axis. */
static inline bool csg_frustum_beside(const csg_smooth_leaf *l, const csg_smooth *side,
                                      csg_smooth *out)
{
    const csg_smooth *const across[2] = {&l->p[0], &l->p[1]};
    const double round = (double)l->own[6];
    bool is_upright = !(fabs(l->own[4]) > 0);
    if (is_upright)
        return csg_smooth_round(l, round + (double)l->own[0], across, 2, out);
    *out = csg_smooth_line(l, round, -1, side);
    return true;
}

/* Near the rim at one end, where the frustum has its side, the cap or the rim nearest. beyond: > 0,
 * past the side's end. Where only the sign matters side and cap stand for the inside, too. */
static inline bool csg_frustum_choose(const csg_smooth_leaf *l, const csg_smooth *side,
                                      const csg_smooth *cap, const csg_smooth *over,
                                      const csg_smooth *beyond, bool is_acute, csg_smooth *out)
{
    enum { SIDE, CAP, RIM, WAYS };
    const csg_smooth *const from_rim[2] = {over, cap};
    const double round = (double)l->own[6];
    bool is_outside = csg_smooth_is_positive(l, cap) || csg_smooth_is_positive(l, side);
    const bool possible[WAYS] = {
        !csg_smooth_is_positive(l, beyond), !csg_smooth_is_positive(l, over),
        !csg_smooth_is_negative(l, beyond) && !csg_smooth_is_negative(l, over)};
    int way = is_outside || l->choice->signs ? csg_smooth_choose(l, possible, WAYS) : -1;
    switch (way) {
    case SIDE:
        csg_smooth_require(l, -1, beyond);
        if (is_acute)
            csg_smooth_require(l, -1, cap);
        return csg_frustum_beside(l, side, out);
    case CAP:
        csg_smooth_require(l, -1, over);
        if (is_acute)
            csg_smooth_require(l, 1, cap);
        *out = csg_smooth_line(l, round, -1, cap);
        return true;
    case RIM:
        csg_smooth_require(l, 1, over);
        csg_smooth_require(l, 1, beyond);
        return csg_smooth_round(l, round, from_rim, 2, out);
    default:
        return false;
    }
}

/* The side, a cap, or, outside, a rim. About the axis the distance from it is no smooth function,
 * but a cap needs no more than bounds of it. */
static inline bool csg_frustum_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    const double *own = l->own;
    const double h = (double)own[2], nx = (double)own[3], nz = (double)own[4];
    const double reach = l->reach * (1 + 1e-9);
    double end = l->p[2].f.value < 0 ? -1 : 1, rim = (double)own[1] + end * (double)own[7];
    double radius = csg_hypot(l->p[0].f.value, l->p[1].f.value);
    csg_smooth rho, cap = csg_smooth_line(l, -h, end, &l->p[2]);
    double over_cap = cap.f.value; /* at the centre, as the side's here: at most */
    double over_side = (radius + reach - rim) * nx + (fabs(over_cap) + reach) * fabs(nz);
    bool is_under = end * l->p[2].f.value > reach && radius + reach < rim;
    if (is_under && (over_cap > reach || over_cap - reach > over_side)) {
        *out = csg_smooth_line(l, (double)own[6], -1, &cap);
        return true;
    }
    if (!csg_smooth_radial(l, &rho))
        return false;
    csg_smooth up = csg_smooth_line(l, h, 1, &l->p[2]);
    csg_smooth side = csg_smooth_line(l, -(double)own[0] * nx, nx, &rho);
    side = csg_smooth_sum(l, &side, nz, &up);
    csg_smooth along = csg_smooth_line(l, (double)own[0] * nz, -nz, &rho);
    along = csg_smooth_sum(l, &along, nx, &up);
    csg_smooth past = csg_smooth_line(l, -(double)own[5], 1, &along);
    csg_smooth other_cap = csg_smooth_line(l, -h, -end, &l->p[2]);
    bool is_beside = csg_smooth_is_positive(l, &along) && csg_smooth_is_negative(l, &past);
    bool is_between = csg_smooth_is_negative(l, &cap) && csg_smooth_is_negative(l, &other_cap);
    bool is_deepest = is_between && csg_smooth_is_above(l, &side, &cap) &&
                      csg_smooth_is_above(l, &side, &other_cap);
    if ((is_beside && (is_deepest || csg_smooth_is_positive(l, &side))) ||
        (is_deepest && csg_smooth_is_negative(l, &side))) {
        return csg_frustum_beside(l, &side, out);
    }
    csg_smooth over = csg_smooth_line(l, -rim, 1, &rho);
    const csg_smooth *const from_rim[2] = {&over, &cap};
    bool is_past = end > 0 ? csg_smooth_is_positive(l, &past) : csg_smooth_is_negative(l, &along);
    if (!(end * l->p[2].f.value > reach))
        return false;
    if (is_past && csg_smooth_is_positive(l, &over) && csg_smooth_is_positive(l, &cap)) {
        return csg_smooth_round(l, (double)own[6], from_rim, 2, out);
    }
    csg_smooth beyond = csg_smooth_scaled(l, end, end > 0 ? &past : &along);
    bool has_one_end =
        end > 0 ? csg_smooth_is_positive(l, &along) : csg_smooth_is_negative(l, &past);
    return l->choice && has_one_end &&
           csg_frustum_choose(l, &side, &cap, &over, &beyond, end * nz < 0, out);
}

static inline unsigned csg_frustum_mirrors(const float *own)
{
    return CSG_MIRROR_TURNED | (own[7] == 0 ? CSG_MIRROR_Z : 0);
}

#endif
