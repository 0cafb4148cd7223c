/* SPDX-License-Identifier: MIT
 * An ellipsoid around the origin. Parameters: semi-axes. In float: e_x >= e_z, e_y >= e_z, e_z (the
 * axes are turned for it), e_x^2 / e_z^2, e_y^2 / e_z^2, 0.
 *
 * The distance after Eberly, "Distance from a point to an ellipse, an ellipsoid" (2013), with the
 * secular equation of More and Sorensen instead of his bisection.
 */
#ifndef CSG_SCENE_ELLIPSOID_H
#define CSG_SCENE_ELLIPSOID_H

#include "scene/primitives/primitive_kit.h"

enum { CSG_ELLIPSOID_OWN = 6 };

static inline bool csg_ellipsoid_check(csg_refusal *refusal, double *v)
{
    return csg_check_positive(refusal, v[0], "the semi-axis") &&
           csg_check_positive(refusal, v[1], "the semi-axis") &&
           csg_check_positive(refusal, v[2], "the semi-axis");
}

/* The nearest point x of y satisfies x_i = y_i r_i / (u + d_i), with r_i = (e_i / e_min)^2 and
 * d_i = r_i - 1, for the largest root u of S(u) = sum (r_i z_i / (u + d_i))^2 = 1, z = y / e.
 * Then y - x = (u - 1) w and w_i = y_i / (u + d_i) is along the outward normal. */
typedef struct csg_secular {
    double weight[3]; /* r_i z_i */
    double shift[3];  /* d_i >= 0, 0 for the shortest axis */
} csg_secular;

/* S(u) and S'(u). */
static inline double csg_secular_sum(const csg_secular *s, double u, double *slope)
{
    double sum = 0;
    *slope = 0;
    for (int i = 0; i < 3; i++) {
        if (s->weight[i] == 0)
            continue;
        double t = s->weight[i] / (u + s->shift[i]);
        sum += t * t;
        *slope -= 2 * t * t / (u + s->shift[i]);
    }
    return sum;
}

/* Newton's method on 1 - 1 / sqrt(S), which is nearly linear and convex: from the left it never
 * passes the root. 0 when S(0) <= 1: the nearest points are a pair, above and below the shortest
 * axis' middle plane. */
static inline double csg_secular_root(const csg_secular *s)
{
    double u = 0, slope;
    for (int i = 0; i < 3; i++)
        u = fmax(u, s->weight[i] - s->shift[i]);
    if (u == 0 && csg_secular_sum(s, 0, &slope) <= 1)
        return 0;
    for (int i = 0; i < 200; i++) {
        double sum = csg_secular_sum(s, u, &slope);
        if (sum <= 1)
            break;
        double next = u + (1 - sqrt(sum)) * 2 * sum / slope;
        if (!(next > u))
            break;
        u = next;
    }
    return u;
}

static inline csg_sample csg_ellipsoid_distance(const double *e, csg_vec3 p)
{
    /* Smaller weights are as good as zero, and their quotients would lose digits to underflow. */
    const double no_weight = 1e-290, y[3] = {p.x, p.y, p.z};
    int shortest = 0;
    csg_secular s;
    for (int i = 1; i < 3; i++)
        if (e[i] < e[shortest])
            shortest = i;
    for (int i = 0; i < 3; i++) {
        double ratio = e[i] / e[shortest];
        s.shift[i] = (ratio - 1) * (ratio + 1);
        s.weight[i] = fabs(y[i]) / e[i] * ratio * ratio;
        if (s.weight[i] < no_weight)
            s.weight[i] = 0;
    }
    double u = csg_secular_root(&s), w[3], square = 0, sum = 0;
    for (int i = 0; i < 3; i++) {
        w[i] = s.weight[i] == 0 ? 0 : y[i] / (u + s.shift[i]);
        square += w[i] * w[i];
        if (u == 0 && i != shortest && s.weight[i] != 0)
            sum += (s.weight[i] / s.shift[i]) * (s.weight[i] / s.shift[i]);
    }
    if (u == 0)
        square += e[shortest] * e[shortest] * fmax(1 - sum, 0);
    double norm = sqrt(square);
    csg_vec3 gradient = norm > 0 ? csg_vec3_scale(csg_vec3_make(w[0], w[1], w[2]), -1 / norm)
                                 : csg_vec3_make(0, 0, 0);
    return (csg_sample){(1 - u) * norm, gradient};
}

static inline double csg_ellipsoid_support(const double *v, csg_vec3 n)
{
    return csg_vec3_norm(csg_vec3_make(v[0] * n.x, v[1] * n.y, v[2] * n.z));
}

static inline bool csg_ellipsoid_has_face(const double *v, csg_vec3 n)
{
    return false;
}

/* The secular equation by so many steps of Newton's method; the coordinate along the shortest axis
 * is kept off 0, where the nearest points are a pair. */
static inline csg_term csg_ellipsoid_term(csg_terms *t, const double *e, const csg_term p[3])
{
    enum { STEPS = 14 };
    const double least = 1e-9;
    csg_term weight[3], u = 0, sum = 0, square = 0;
    double shift[3];
    int shortest = e[1] < e[0] ? 1 : 0;
    shortest = e[2] < e[shortest] ? 2 : shortest;
    for (int i = 0; i < 3; i++) {
        double ratio = e[i] / e[shortest];
        csg_term y = csg_term_abs(t, p[i]);
        y = i == shortest ? csg_term_max_number(t, y, least * e[i]) : y;
        shift[i] = (ratio - 1) * (ratio + 1);
        weight[i] = csg_term_mul_number(t, y, ratio * ratio / e[i]);
        csg_term at = csg_term_sub_number(t, weight[i], shift[i]);
        u = i ? csg_term_max(t, u, at) : at;
    }
    for (int step = 0; step < STEPS; step++) {
        csg_term slope = 0;
        for (int i = 0; i < 3; i++) {
            csg_term below = csg_term_add_number(t, u, shift[i]);
            csg_term q = csg_term_square(t, csg_term_div(t, weight[i], below));
            sum = i ? csg_term_add(t, sum, q) : q;
            q = csg_term_div(t, q, below);
            slope = i ? csg_term_add(t, slope, q) : q;
        }
        csg_term more = csg_term_sub_number(t, csg_term_sqrt(t, sum), 1);
        more = csg_term_div(t, csg_term_mul(t, more, sum), slope);
        u = csg_term_add(t, u, csg_term_max_number(t, more, 0));
    }
    for (int i = 0; i < 3; i++) { /* w_i = y_i / (u + d_i) */
        double scale = e[shortest] / e[i] * e[shortest];
        csg_term w = csg_term_div(t, csg_term_mul_number(t, weight[i], scale),
                                  csg_term_add_number(t, u, shift[i]));
        w = csg_term_square(t, w);
        square = i ? csg_term_add(t, square, w) : w;
    }
    return csg_term_mul(t, csg_term_number_sub(t, 1, u), csg_term_sqrt(t, square));
}

static inline double csg_ellipsoid_depth(const double *v)
{
    return 0;
}

static inline bool csg_ellipsoid_balls(csg_ball_sink *to, const double *v)
{
    to->ball(to->user, csg_vec3_make(0, 0, 0), 1);
    to->axes = csg_vec3_make(v[0], v[1], v[2]);
    return true;
}

static inline void csg_ellipsoid_example(csg_random *random, double *v)
{
    csg_example_sizes(random, v);
}

/* ---- in float ------------------------------------------------------------------------------- */

/* The smallest semi-axis last: the frame's rows are turned. */
static inline void csg_ellipsoid_pack(csg_leaf *l, const double *v, double k)
{
    int last = v[0] < v[1] ? (v[0] < v[2] ? 0 : 2) : (v[1] < v[2] ? 1 : 2);
    int order[3] = {(last + 1) % 3, (last + 2) % 3, last};
    csg_affine turned = l->to_own;
    for (int i = 0; i < 3; i++) {
        memcpy(turned.m[i], l->to_own.m[order[i]], sizeof turned.m[i]);
        turned.t[i] = l->to_own.t[order[i]];
        l->own[i] = v[order[i]] * k;
    }
    l->to_own = turned;
    if (last != 2)
        l->frame = CSG_FRAME_AFFINE;
    double z = l->own[2];
    l->own[3] = (l->own[0] / z) * (l->own[0] / z);
    l->own[4] = (l->own[1] / z) * (l->own[1] / z);
    l->own[5] = 0;
    l->magnitude = fmax(l->own[0], l->own[1]);
}

/* The nearest point y satisfies y_i = e_i^2 p_i / (t + e_i^2); solved in scaled variables with
 * v = t / e_z^2 + 1, e_z the smallest semi-axis, so that nothing cancels near the medial disc.
 * Newton on a convex decreasing function rises to its root from any lower bound. The bounds: no
 * term exceeds 1; and where a step from v = 1 lands, which is the root for points on the surface,
 * so that few steps do near it. Nine reach float precision everywhere for axes up to 1 : 100. */
static inline float csg_ellipsoid_value(const float *own, point q, point *g)
{
    float zx = absolute(q.x) / own[0], zy = absolute(q.y) / own[1], zz = absolute(q.z) / own[2];
    float rx = own[3], ry = own[4];
    float bx = rx * zx, by = ry * zy;
    float excess = zx * zx + zy * zy + zz * zz - 1.0f;
    float slope_at_one = 2.0f * (zx * zx / rx + zy * zy / ry + zz * zz);
    float v = larger(larger(zz, 1e-6f), larger(bx - rx + 1.0f, by - ry + 1.0f));
    v = larger(v, 1.0f + quotient(excess, slope_at_one));
#pragma GCC unroll 9
    for (int step = 0; step < 9; step++) {
        float ix = 1.0f / (v + (rx - 1.0f)), iy = 1.0f / (v + (ry - 1.0f)), iz = 1.0f / v;
        float tx = bx * ix, ty = by * iy, tz = zz * iz;
        float value = tx * tx + ty * ty + tz * tz - 1.0f;
        float slope = 2.0f * (tx * tx * ix + ty * ty * iy + tz * tz * iz);
        v = value > 0 ? v + quotient(value, slope) : v;
    }
    float ux = bx / (v + (rx - 1.0f)), uy = by / (v + (ry - 1.0f)); /* nearest point / axes */
    float uz = sqrtf(larger(1.0f - ux * ux - uy * uy, 0));
    uz = v > uz * uz ? zz / v : uz; /* the one that loses fewer digits */
    float dx = own[0] * (zx - ux), dy = own[1] * (zy - uy), dz = own[2] * (zz - uz);
    float distance = sqrtf(dx * dx + dy * dy + dz * dz);
    float nx = ux / own[0], ny = uy / own[1], nz = uz / own[2];
    float s = quotient(-1.0f, sqrtf(nx * nx + ny * ny + nz * nz));
    *g = (point){sign_of(q.x) * nx * s, sign_of(q.y) * ny * s, sign_of(q.z) * nz * s};
    return excess < 0 ? distance : -distance;
}

static inline int csg_ellipsoid_falls_outwards(const float *own)
{
    return 1;
}

/* Whether inside the ellipsoid all of the ball has one nearest point each: where that jumps lies in
 * the shortest axis' middle plane, and where two axes are the shortest, on the third. */
static inline bool csg_ellipsoid_is_clear(const csg_cone_leaf *l)
{
    const float *own = l->own;
    double z = l->q[2], from = fabs(z);
    for (int i = 0; i < 2; i++)
        from = own[i] == own[2] ? fmax(from, sqrt(l->q[i] * l->q[i] + z * z)) : from;
    return from > l->rho * (1 + 1e-6);
}

/* With A = diag(1 / e_i^2) the normal n of the nearest point y is along N = A y, so a turn is at
 * most K / |N| times y's way, K = 1 / e_min^2: the curvature there. Over the ball y moves no
 * farther than s where rho |N| / (|N| - depth K) <= s, and along the way |N| falls by no more than
 * |A n - (n . A n) n| a length, which grows with n's turn by the range of A's numbers at most. The
 * turn, and per length between any two points; INFINITY: not known. A way and a turn that their
 * own bounds do not reach are never reached. */
static inline double csg_ellipsoid_turn(const csg_cone_leaf *l, point g, double value, double *bend)
{
    enum { TRIES = 6 };
    static const double MORE = 1.05, ROUNDING = 1e-4;
    const float *own = l->own;
    const double n[3] = {(double)g.x, (double)g.y, (double)g.z};
    double depth = fmax(value + l->rho, 0), longest = fmax((double)own[0], (double)own[1]);
    double steepest = 1 / ((double)own[2] * (double)own[2]),
           apart = steepest - 1 / (longest * longest);
    double square = 0, mean = 0, squares = 0, way = 0, turn = 0;
    for (int i = 0; i < 3; i++) {
        double a = 1 / ((double)own[i] * (double)own[i]), along = (l->q[i] - value * n[i]) * a;
        square += along * along;
        mean += a * n[i] * n[i];
        squares += a * a * n[i] * n[i];
    }
    double length = (1 - ROUNDING) * sqrt(square),
           falls = sqrt(fmax(squares - mean * mean, 0)) + ROUNDING * steepest;
    *bend = INFINITY;
    if (depth > 0 && !csg_ellipsoid_is_clear(l))
        return INFINITY;
    for (int i = 0; i < TRIES; i++) {
        double left = length - (falls + apart * turn) * way, clear = left - steepest * depth;
        if (!(left > 1e-3 * length && clear > 0))
            break;
        double next_way = l->rho * left / clear, next_turn = steepest * next_way / left;
        if (next_way <= way && next_turn <= turn) {
            *bend = steepest / clear;
            return next_turn;
        }
        way = MORE * next_way;
        turn = MORE * next_turn;
    }
    return INFINITY;
}

/* How far q is from where its nearest point is no longer the only one, along its gradient, at
 * least: the normal there meets nothing of that before the shortest axis' middle plane. */
static inline double csg_ellipsoid_way_in(const csg_cone_leaf *l, point g)
{
    static const double ROUNDING = 1e-5;
    const float *own = l->own;
    double far = l->q[2] * l->q[2], along = (double)g.z * (double)g.z;
    const double n[2] = {(double)g.x, (double)g.y};
    for (int i = 0; i < 2; i++) {
        far += own[i] == own[2] ? l->q[i] * l->q[i] : 0;
        along += own[i] == own[2] ? n[i] * n[i] : 0;
    }
    return sqrt(far) * (1 - ROUNDING) / (sqrt(along) + ROUNDING);
}

/* The depth f in a convex solid is concave, and f(q + t g) = f(q) + t as far as the way in. With g'
 * the gradient at x that says f(q) + t <= f(x) + g' (q + t g - x), and f(x) <= f(q) + g (x - q):
 * so g and g' are apart by no more than 2 |x - q| / t. */
static inline double csg_ellipsoid_concave_turn(const csg_cone_leaf *l, point g)
{
    return 2 * l->rho / csg_ellipsoid_way_in(l, g);
}

static inline bool csg_ellipsoid_gradients(csg_cone_leaf *l)
{
    const float *own = l->own;
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double value = (double)csg_ellipsoid_value(own, q, &g), depth = fmax(value + l->rho, 0);
    double least = (double)own[2], curvature = fmax((double)own[0], (double)own[1]);
    curvature /= least * least;
    double by_all = curvature * depth < 1 ? curvature / (1 - curvature * depth) : INFINITY, by_ball;
    double spread = fmin(l->rho * by_all, csg_ellipsoid_turn(l, g, value, &by_ball));
    spread = fmin(spread, csg_ellipsoid_concave_turn(l, g));
    l->bend = fmin(by_all, by_ball);
    if (!(spread < 1.4))
        return false;
    return csg_cone_add(l, (double)g.x, (double)g.y, (double)g.z, spread + 1e-4);
}

/* Inside, from the smallest radius of curvature on. */
static inline bool csg_ellipsoid_may_crease(const float *own, const float q[3], float reach,
                                            csg_band b)
{
    float least = fminf(own[0], fminf(own[1], own[2]));
    return csg_band_meets(b, least * least / fmaxf(own[0], fmaxf(own[1], own[2])), INFINITY);
}

/* Of the secular equation in own coordinates, z being along the shortest axis: with
 * t_i = r_i y_i / e_i / (u + d_i) what is left of it, sum t_i^2 - 1, and half its slope in u, less
 * than 0: sum t_i^2 / (u + d_i). False: u + d_i may be 0. */
static inline bool csg_secular_models(const csg_smooth_leaf *l, const csg_secular *s,
                                      const csg_taylor *u, csg_taylor *rest, csg_taylor *slope)
{
    *rest = csg_taylor_constant(-1);
    *slope = csg_taylor_constant(0);
    for (int i = 0; i < 3; i++) {
        csg_taylor from = csg_taylor_raised(*u, s->shift[i]), inverse;
        if (!csg_taylor_inverse(&from, l->radius, &inverse))
            return false;
        csg_taylor t = csg_taylor_product(&l->p[i].f, &inverse, l->radius);
        t = csg_taylor_scaled(&t, s->weight[i]);
        t = csg_taylor_square(&t, l->radius);
        *rest = csg_taylor_sum(rest, 1, &t);
        t = csg_taylor_product(&t, &inverse, l->radius);
        *slope = csg_taylor_sum(slope, 1, &t);
    }
    return true;
}

/* The equation's root is off a polynomial by what that leaves of it over the slope S_u: all terms
 * have negative powers of u + d_i, so that falls by no more than 3 / u of itself a length. Its
 * gradient is -S_y / S_u, which with |t| = 1 changes by 10 k / (u S_u) a length, k being the
 * largest r_i / e_i / (u + d_i). False: too little is known of it. */
static inline bool csg_secular_enclose(const csg_smooth_leaf *l, const csg_secular *s,
                                       csg_taylor *u)
{
    static const double MORE = 1 + 1e-9, CLOSE = 0.05, CHANGE = 11;
    csg_taylor rest, slope;
    if (!csg_secular_models(l, s, u, &rest, &slope))
        return false;
    double r = l->radius, from = csg_taylor_least(u, r), steep = 2 * csg_taylor_least(&slope, r);
    double left = fabs(rest.value) + csg_taylor_reach(&rest, r), steepest = 0;
    if (!(from > 0 && steep > 0 && left < CLOSE * from * steep && left < CLOSE))
        return false;
    double off = 2 * left / steep, close = from - off;
    steep *= 1 - 3 * off / close;
    for (int i = 0; i < 3; i++)
        steepest = fmax(steepest, s->weight[i] / (close + s->shift[i]));
    double turn = CHANGE * steepest / (close * steep);
    csg_taylor polynomial = rest;
    polynomial.error = polynomial.quartic = polynomial.turned = polynomial.thrice = 0;
    double value = fabs(rest.value) + csg_taylor_reach(&polynomial, r);
    double gradient = csg_norm3(rest.slope) + csg_taylor_stray(&polynomial, r);
    u->error = (rest.error + value) / steep * MORE;
    u->quartic = rest.quartic / steep * MORE;
    u->turned = ((rest.turned + gradient) / steep + turn * u->error) * MORE;
    u->thrice = (rest.thrice / steep + turn * u->quartic * r) * MORE;
    return true;
}

/* The distance is (1 - u) |w|, w_i = y_i / (u + d_i), u being the secular equation's root: as a
 * polynomial by the chord method, which makes it right by an order more each time. */
static inline bool csg_ellipsoid_distance_model(const csg_smooth_leaf *l, csg_smooth *out)
{
    enum { ORDERS = 4 };
    csg_secular s, at_center;
    csg_taylor u, rest, slope, norm, w[3];
    for (int i = 0; i < 3; i++) {
        double ratio = (double)l->own[i] / (double)l->own[2];
        s.shift[i] = (ratio - 1) * (ratio + 1);
        s.weight[i] = ratio * ratio / (double)l->own[i];
        at_center.shift[i] = s.shift[i];
        at_center.weight[i] = s.weight[i] * fabs(l->p[i].f.value);
    }
    u = csg_taylor_constant(csg_secular_root(&at_center));
    for (int n = 0; n < ORDERS; n++) {
        if (!csg_secular_models(l, &s, &u, &rest, &slope) || !(slope.value > 0))
            return false;
        u = csg_taylor_sum(&u, 0.5 / slope.value, &rest);
        u.error = u.quartic = u.turned = u.thrice = 0;
    }
    if (!csg_secular_enclose(l, &s, &u))
        return false;
    for (int i = 0; i < 3; i++) {
        csg_taylor from = csg_taylor_raised(u, s.shift[i]), inverse;
        if (!csg_taylor_inverse(&from, l->radius, &inverse))
            return false;
        w[i] = csg_taylor_product(&l->p[i].f, &inverse, l->radius);
    }
    const csg_taylor *const along[3] = {&w[0], &w[1], &w[2]};
    if (!csg_taylor_norm(along, 3, l->radius, &norm))
        return false;
    u = csg_taylor_raised(csg_taylor_scaled(&u, -1), 1);
    out->f = csg_taylor_product(&u, &norm, l->radius);
    return true;
}

/* Where nothing but inside and outside of it matters a (1 - |x / axes|^2) / 2 does, a being the
 * least semi-axis: near its surface that is no steeper than |x / axes|. */
static inline bool csg_ellipsoid_smooth(const csg_smooth_leaf *l, csg_smooth *out)
{
    double least = fmin((double)l->own[0], fmin((double)l->own[1], (double)l->own[2])), far = 0;
    csg_smooth sum;
    if (l->with_slopes)
        return false;
    if (!l->choice || !l->choice->at_zero)
        return csg_ellipsoid_distance_model(l, out);
    sum.f = csg_taylor_constant(1);
    for (int i = 0; i < 3; i++) {
        double scale = 1 / (double)l->own[i], x = l->p[i].f.value * scale;
        csg_taylor scaled = csg_taylor_scaled(&l->p[i].f, scale);
        scaled = csg_taylor_square(&scaled, l->radius);
        sum.f = csg_taylor_sum(&sum.f, -1, &scaled);
        far += x * x;
    }
    double steep = fmax(sqrt(far) + l->reach / least, 1);
    *out = csg_smooth_scaled(l, 0.5 * least / steep, &sum);
    return true;
}

static inline unsigned csg_ellipsoid_mirrors(const float *own)
{
    return CSG_MIRROR_SIGNS | (own[0] == own[1] ? CSG_MIRROR_XY | CSG_MIRROR_AROUND : 0);
}

#endif
