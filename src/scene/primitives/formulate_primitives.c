/* SPDX-License-Identifier: MIT
 * The primitives of scene/primitives/reference_primitives.c as formulas.
 */
#include "scene/formula/formulate.h"

#include "scene/primitives/curve.h"

/* Distance in the half plane of a convex solid of revolution, or of any convex figure, from
 * `behind`, the largest of its half planes (below 0 inside, where it is the distance), and
 * `outside`, the distance to its boundary. */
static csg_term convex_distance(csg_terms *t, csg_term behind, csg_term outside)
{
    return csg_term_add(t, csg_term_min_number(t, behind, 0),
                        csg_term_mul(t, csg_term_step(t, behind), outside));
}

/* round - distance to a box of `axes` dimensions with these half sizes. */
static csg_term box(csg_terms *t, const double *half, double round, const csg_term *p, int axes)
{
    csg_term widest = 0, squares = 0;
    for (int i = 0; i < axes; i++) {
        csg_term q = csg_term_sub_number(t, csg_term_abs(t, p[i]), half[i] - round);
        csg_term square = csg_term_square(t, csg_term_max_number(t, q, 0));
        widest = i ? csg_term_max(t, widest, q) : q;
        squares = i ? csg_term_add(t, squares, square) : square;
    }
    csg_term distance =
        csg_term_add(t, csg_term_sqrt(t, squares), csg_term_min_number(t, widest, 0));
    return csg_term_less(t, round, distance);
}

/* Distance from (rho, z) to the segment (r1, -h)-(r2, h). */
static csg_term slant_distance(csg_terms *t, const double *v, csg_term rho, csg_term z)
{
    double dr = v[1] - v[0], dz = 2 * v[2], square = dr * dr + dz * dz;
    csg_term from_r = csg_term_sub_number(t, rho, v[0]), from_z = csg_term_add_number(t, z, v[2]);
    csg_term along = csg_term_add(t, csg_term_mul_number(t, from_r, dr / square),
                                  csg_term_mul_number(t, from_z, dz / square));
    along = csg_term_clamp(t, along, 0, 1);
    return csg_term_norm2(t, csg_term_sub(t, from_r, csg_term_mul_number(t, along, dr)),
                          csg_term_sub(t, from_z, csg_term_mul_number(t, along, dz)));
}

static csg_term frustum(csg_terms *t, const double *v, const csg_term p[3])
{
    double length = hypot(v[1] - v[0], 2 * v[2]);
    csg_term rho = csg_term_norm2(t, p[0], p[1]);
    csg_term slant = csg_term_add(
        t, csg_term_mul_number(t, csg_term_sub_number(t, rho, v[0]), 2 * v[2] / length),
        csg_term_mul_number(t, csg_term_add_number(t, p[2], v[2]), (v[0] - v[1]) / length));
    csg_term cap = csg_term_sub_number(t, csg_term_abs(t, p[2]), v[2]);
    csg_term outside = slant_distance(t, v, rho, p[2]);
    for (int end = 0; end < 2; end++) {
        csg_term over = csg_term_max_number(t, csg_term_sub_number(t, rho, v[end]), 0);
        csg_term away = csg_term_sub_number(t, p[2], end ? v[2] : -v[2]);
        outside = csg_term_min(t, outside, csg_term_norm2(t, over, away));
    }
    return csg_term_less(t, v[3], convex_distance(t, csg_term_max(t, slant, cap), outside));
}

/* The ball that reaches deepest has its centre at z - k rho / a, within the ends. */
static csg_term capsule(csg_terms *t, const double *v, const csg_term p[3])
{
    double k = (v[1] - v[2]) / v[0], a = sqrt((1 - k) * (1 + k));
    csg_term rho = csg_term_norm2(t, p[0], p[1]);
    csg_term center = csg_term_sub(t, p[2], csg_term_mul_number(t, rho, k / a));
    center = csg_term_clamp(t, center, 0, v[0]);
    csg_term radius = csg_term_less(t, v[1], csg_term_mul_number(t, center, k));
    return csg_term_sub(t, radius, csg_term_norm2(t, rho, csg_term_sub(t, p[2], center)));
}

/* In the plane the squared distance to the arc is rho^2 + R^2 - 2 R g, where g is rho within the
 * arc's angle and the part of the point along its end elsewhere. */
static csg_term torus(csg_terms *t, const double *v, const csg_term p[3])
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
    return csg_term_less(t, v[1], away);
}

/* The secular equation of scene/primitives/reference_primitives.c by so many steps of Newton's
 * method; the coordinate along the shortest axis is kept off 0, where the nearest points are a
 * pair. */
static csg_term ellipsoid(csg_terms *t, const double *e, const csg_term p[3])
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
    return csg_term_mul(t, csg_term_less(t, 1, u), csg_term_sqrt(t, square));
}

/* (|x|^n + |y|^n)^(1/n) */
static csg_term gauge(csg_terms *t, csg_term x, csg_term y, double n)
{
    csg_term sum = csg_term_add(t, csg_term_pow_number(t, csg_term_abs(t, x), n),
                                csg_term_pow_number(t, csg_term_abs(t, y), n));
    return csg_term_pow_number(t, sum, 1 / n);
}

/* The balls between two of a curve's: a capsule in its own frame, or the larger ball where that
 * holds the other. */
static csg_term chord(csg_terms *t, const double *a, const double *b, const csg_term p[3])
{
    csg_vec3 d = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double r1 = a[CSG_CURVE_RADIUS], r2 = b[CSG_CURVE_RADIUS], length = csg_vec3_norm(d);
    const double *larger = r1 >= r2 ? a : b;
    bool is_ball = !(fabs(r1 - r2) < length);
    csg_term own[3];
    for (int i = 0; i < 3; i++)
        own[i] = csg_term_sub_number(t, p[i], is_ball ? larger[i] : a[i]);
    if (is_ball)
        return csg_term_less(t, fmax(r1, r2), csg_term_norm3(t, own[0], own[1], own[2]));
    csg_affine place = csg_affine_z_to(d);
    csg_term turned[3];
    for (int i = 0; i < 3; i++) {
        turned[i] = csg_term_mul_number(t, own[0], place.m[0][i]);
        for (int k = 1; k < 3; k++)
            turned[i] = csg_term_add(t, turned[i], csg_term_mul_number(t, own[k], place.m[k][i]));
    }
    return capsule(t, (double[]){length, r1, r2}, turned);
}

/* No formula of a point's nearest ball is short: chords within 1e-4 of the largest radius. */
static csg_term tube(csg_terms *t, csg_node_kind kind, const double *v, const csg_term p[3])
{
    csg_curve curve = csg_curve_make(kind, v);
    double largest = 0, from[CSG_CURVE_AXES], to[CSG_CURVE_AXES];
    for (int i = 0; i <= curve.degree; i++)
        largest = fmax(largest, curve.at[i][CSG_CURVE_RADIUS]);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&curve, 1e-4 * largest), 1e5);
    csg_term all = CSG_FORMULA_NONE;
    csg_curve_at(&curve, 0, from);
    for (uint32_t i = 1; i <= chords; i++) {
        csg_curve_at(&curve, (double)i / chords, to);
        csg_term one = chord(t, from, to, p);
        all = i > 1 ? csg_term_max(t, all, one) : one;
        for (int k = 0; k < CSG_CURVE_AXES; k++)
            from[k] = to[k];
    }
    return all;
}

csg_term csg_formulate_primitive(csg_terms *t, csg_node_kind kind, const double *v,
                                 const csg_term p[3])
{
    switch (kind) {
    case CSG_NODE_SPHERE:
        return csg_term_less(t, v[0], csg_term_norm3(t, p[0], p[1], p[2]));
    case CSG_NODE_BOX:
        return box(t, v, v[3], p, 3);
    case CSG_NODE_FRUSTUM:
        return frustum(t, v, p);
    case CSG_NODE_CAPSULE:
        return capsule(t, v, p);
    case CSG_NODE_TORUS:
        return torus(t, v, p);
    case CSG_NODE_ELLIPSOID:
        return ellipsoid(t, v, p);
    case CSG_NODE_PLANE: {
        csg_term sum = csg_term_mul_number(t, p[0], v[0]);
        sum = csg_term_add(t, sum, csg_term_mul_number(t, p[1], v[1]));
        sum = csg_term_add(t, sum, csg_term_mul_number(t, p[2], v[2]));
        return csg_term_less(t, v[3], sum);
    }
    case CSG_NODE_CIRCLE:
        return csg_term_less(t, v[0], csg_term_norm2(t, p[0], p[1]));
    case CSG_NODE_RECTANGLE:
        return box(t, v, v[2], p, 2);
    case CSG_NODE_SLAB:
        return csg_term_less(t, v[0], csg_term_abs(t, p[2]));
    case CSG_NODE_SUPERELLIPSOID: {
        csg_term across = gauge(t, csg_term_mul_number(t, p[0], 1 / v[0]),
                                csg_term_mul_number(t, p[1], 1 / v[1]), v[3]);
        csg_term whole = gauge(t, across, csg_term_mul_number(t, p[2], 1 / v[2]), v[4]);
        return csg_term_mul_number(t, csg_term_less(t, 1, whole), 1 / v[5]);
    }
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        return tube(t, kind, v, p);
    default: /* EMPTY */
        return csg_term_number(t, -CSG_FORMULA_FAR);
    }
}
