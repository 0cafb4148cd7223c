/* SPDX-License-Identifier: MIT
 * Exact signed distances of the primitives with their gradients, f > 0 inside (operators.md 1;
 * the ellipsoid after Eberly, "Distance from a point to an ellipsoid", with the secular equation
 * of More and Sorensen instead of his bisection). The nearest surface point decides both value and
 * gradient; where several are nearest, each coordinate that they do not share counts as zero or
 * one of them is taken.
 */
#include "scene/reference.h"

#include <assert.h>

#include "scene/primitives/curve.h"

static csg_vec3 vec3(double x, double y, double z)
{
    return (csg_vec3){x, y, z};
}

static double sign(double x)
{
    return (x > 0) - (x < 0);
}

/* A ball of radius r around `center`. */
static csg_sample ball(csg_vec3 p, csg_vec3 center, double r)
{
    csg_vec3 v = csg_vec3_sub(p, center);
    double distance = csg_vec3_norm(v);
    csg_vec3 away = distance > 0 ? csg_vec3_scale(v, -1 / distance) : vec3(0, 0, 0);
    return (csg_sample){r - distance, away};
}

/* A field of (rho, z) turned about the z axis; d_rho, d_z: its gradient there. */
static csg_sample revolve(csg_vec3 p, double rho, double value, double d_rho, double d_z)
{
    double k = rho > 0 ? d_rho / rho : 0;
    return (csg_sample){value, vec3(k * p.x, k * p.y, d_z)};
}

static csg_sample box(const double *v, csg_vec3 p)
{
    double round = v[3];
    const double at[3] = {p.x, p.y, p.z};
    double q[3], outside[3], square = 0;
    int widest = 0;
    for (int i = 0; i < 3; i++) {
        q[i] = fabs(at[i]) - (v[i] - round);
        outside[i] = fmax(q[i], 0);
        square += outside[i] * outside[i];
        if (q[i] > q[widest])
            widest = i;
    }
    double distance = sqrt(square), gradient[3] = {0};
    if (!(distance > 0)) {
        gradient[widest] = -sign(at[widest]);
        return (csg_sample){round - q[widest], vec3(gradient[0], gradient[1], gradient[2])};
    }
    for (int i = 0; i < 3; i++)
        gradient[i] = -sign(at[i]) * outside[i] / distance;
    return (csg_sample){round - distance, vec3(gradient[0], gradient[1], gradient[2])};
}

/* In the half plane (rho, z) a frustum is a convex polygon; its edges are the top, the bottom and
 * the slant (r1, -h)-(r2, h). Inside, the nearest of their lines; outside, the nearest edge. */
static csg_sample frustum(const double *v, csg_vec3 p)
{
    double r1 = v[0], r2 = v[1], h = v[2], round = v[3];
    double rho = hypot(p.x, p.y), length = hypot(r2 - r1, 2 * h);
    double n_rho = 2 * h / length, n_z = (r1 - r2) / length;
    double slant = n_rho * (rho - r1) + n_z * (p.z + h), cap = fabs(p.z) - h;
    if (slant <= 0 && cap <= 0) {
        if (slant > cap)
            return revolve(p, rho, round - slant, -n_rho, -n_z);
        return revolve(p, rho, round - cap, 0, -sign(p.z));
    }
    double t = ((r2 - r1) * (rho - r1) + 2 * h * (p.z + h)) / (length * length);
    double clamped = fmin(fmax(t, 0), 1);
    double d_rho = rho - (r1 + (r2 - r1) * clamped), d_z = p.z - h * (2 * clamped - 1);
    double distance = hypot(d_rho, d_z);
    if (t > 0 && t < 1 && slant > 0) { /* without the cancellation of d_rho and d_z */
        distance = slant;
        d_rho = n_rho * slant;
        d_z = n_z * slant;
    }
    double radius = p.z > 0 ? r2 : r1, over = fmax(rho - radius, 0);
    if (cap > 0 && hypot(over, cap) < distance) {
        distance = hypot(over, cap);
        d_rho = over;
        d_z = sign(p.z) * cap;
    }
    if (!(distance > 0))
        return revolve(p, rho, round, -n_rho, -n_z);
    return revolve(p, rho, round - distance, -d_rho / distance, -d_z / distance);
}

/* The balls of radius r1 + (r2 - r1) z / h around (0, 0, z), 0 <= z <= h: with k = (r1 - r2) / h
 * and a = sqrt(1 - k k) the ball that reaches deepest has its centre at z - k rho / a. */
static csg_sample capsule(const double *v, csg_vec3 p)
{
    double h = v[0], r1 = v[1], r2 = v[2];
    double k = (r1 - r2) / h, a = sqrt((1 - k) * (1 + k)), rho = hypot(p.x, p.y);
    double center = p.z - k * rho / a;
    if (center <= 0)
        return ball(p, vec3(0, 0, 0), r1);
    if (center >= h)
        return ball(p, vec3(0, 0, h), r2);
    double value = r1 - k * p.z - a * rho;
    return rho > 0 ? revolve(p, rho, value, -a, -k) : (csg_sample){value, vec3(0, 0, 0)};
}

static csg_sample torus(const double *v, csg_vec3 p)
{
    double big = v[0], small = v[1], half = v[2];
    csg_affine turn = csg_affine_rotate(half, vec3(0, 0, 1)); /* exact for quarter turns */
    double cosine = turn.m[0][0], sine = turn.m[1][0];
    if (half < 180 && sine * p.x - cosine * fabs(p.y) < 0) {
        double side = p.y < 0 ? -1 : 1;
        return ball(p, vec3(big * cosine, side * big * sine, 0), small);
    }
    double rho = hypot(p.x, p.y);
    if (!(rho > 0)) /* all points of the arc are nearest: the one on +x */
        return ball(p, vec3(big, 0, 0), small);
    double distance = hypot(rho - big, p.z);
    if (!(distance > 0))
        return (csg_sample){small, vec3(0, 0, 0)};
    return revolve(p, rho, small - distance, -(rho - big) / distance, -p.z / distance);
}

/* ---- ellipsoid ------------------------------------------------------------------------ */

/* The nearest point x of y satisfies x_i = y_i r_i / (u + d_i), with r_i = (e_i / e_min)^2 and
 * d_i = r_i - 1, for the largest root u of S(u) = sum (r_i z_i / (u + d_i))^2 = 1, z = y / e.
 * Then y - x = (u - 1) w and w_i = y_i / (u + d_i) is along the outward normal. */
typedef struct secular {
    double weight[3]; /* r_i z_i */
    double shift[3];  /* d_i >= 0, 0 for the shortest axis */
} secular;

/* Smaller weights are as good as zero, and their quotients would lose digits to underflow. */
#define NO_WEIGHT 1e-290

/* S(u) and S'(u). */
static double secular_sum(const secular *s, double u, double *slope)
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
static double secular_root(const secular *s)
{
    double u = 0, slope;
    for (int i = 0; i < 3; i++)
        u = fmax(u, s->weight[i] - s->shift[i]);
    if (u == 0 && secular_sum(s, 0, &slope) <= 1)
        return 0;
    for (int i = 0; i < 200; i++) {
        double sum = secular_sum(s, u, &slope);
        if (sum <= 1)
            break;
        double next = u + (1 - sqrt(sum)) * 2 * sum / slope;
        if (!(next > u))
            break;
        u = next;
    }
    return u;
}

static csg_sample ellipsoid(const double *e, csg_vec3 p)
{
    const double y[3] = {p.x, p.y, p.z};
    int shortest = 0;
    secular s;
    for (int i = 1; i < 3; i++)
        if (e[i] < e[shortest])
            shortest = i;
    for (int i = 0; i < 3; i++) {
        double ratio = e[i] / e[shortest];
        s.shift[i] = (ratio - 1) * (ratio + 1);
        s.weight[i] = fabs(y[i]) / e[i] * ratio * ratio;
        if (s.weight[i] < NO_WEIGHT)
            s.weight[i] = 0;
    }
    double u = secular_root(&s), w[3], square = 0, sum = 0;
    for (int i = 0; i < 3; i++) {
        w[i] = s.weight[i] == 0 ? 0 : y[i] / (u + s.shift[i]);
        square += w[i] * w[i];
        if (u == 0 && i != shortest && s.weight[i] != 0)
            sum += (s.weight[i] / s.shift[i]) * (s.weight[i] / s.shift[i]);
    }
    if (u == 0)
        square += e[shortest] * e[shortest] * fmax(1 - sum, 0);
    double norm = sqrt(square);
    csg_vec3 gradient =
        norm > 0 ? csg_vec3_scale(vec3(w[0], w[1], w[2]), -1 / norm) : vec3(0, 0, 0);
    return (csg_sample){(1 - u) * norm, gradient};
}

static csg_sample circle(double r, csg_vec3 p)
{
    double rho = hypot(p.x, p.y);
    return revolve(p, rho, r - rho, -1, 0);
}

static csg_sample rectangle(const double *v, csg_vec3 p)
{
    double qx = fabs(p.x) - (v[0] - v[2]), qy = fabs(p.y) - (v[1] - v[2]);
    double sx = -sign(p.x), sy = -sign(p.y);
    if (qx > 0 && qy > 0) {
        double corner = hypot(qx, qy);
        return (csg_sample){v[2] - corner, vec3(sx * qx / corner, sy * qy / corner, 0)};
    }
    return (csg_sample){v[2] - fmax(qx, qy), qx >= qy ? vec3(sx, 0, 0) : vec3(0, sy, 0)};
}

/* (|x|^p + |y|^p)^(1/p) for x, y >= 0 and its derivatives: the larger in front, so that no power
 * overflows. */
static double power_norm(double x, double y, double p, double *dx, double *dy)
{
    double most = fmax(x, y);
    *dx = *dy = 0;
    if (!(most > 0))
        return 0;
    double d = most * pow(pow(x / most, p) + pow(y / most, p), 1 / p);
    *dx = pow(x / d, p - 1);
    *dy = pow(y / d, p - 1);
    return d;
}

/* Barr's gauge: q within x y, p with z. */
static csg_sample superellipsoid(const double *v, csg_vec3 p)
{
    double dx, dy, dxy, dz;
    double across = power_norm(fabs(p.x) / v[0], fabs(p.y) / v[1], v[3], &dx, &dy);
    double d = power_norm(across, fabs(p.z) / v[2], v[4], &dxy, &dz);
    csg_vec3 gradient = vec3(-sign(p.x) * dx * dxy / v[0] / v[5],
                             -sign(p.y) * dy * dxy / v[1] / v[5], -sign(p.z) * dz / v[2] / v[5]);
    return (csg_sample){(1 - d) / v[5], gradient};
}

/* Of the gauge of an ellipse-like figure with exponent p whose axes have constants a and b. */
static double gauge_slope(double a, double b, double p)
{
    double most = fmax(a, b), s = 2 * p / (2 - p);
    return p >= 2 ? most : most * pow(pow(a / most, s) + pow(b / most, s), 1 / s);
}

double csg_gauge_slope(const double *v)
{
    return gauge_slope(gauge_slope(1 / v[0], 1 / v[1], v[3]), 1 / v[2], v[4]);
}

static csg_sample tube(csg_node_kind kind, const double *parameters, csg_vec3 p)
{
    csg_curve curve = csg_curve_make(kind, parameters);
    csg_vec3 to;
    double value = csg_curve_nearest(&curve, p, &to);
    return (csg_sample){value, csg_vec3_normalize(to)};
}

csg_sample csg_reference_primitive(csg_node_kind kind, const double *parameters, csg_vec3 p)
{
    switch (kind) {
    case CSG_NODE_SPHERE:
        return ball(p, vec3(0, 0, 0), parameters[0]);
    case CSG_NODE_BOX:
        return box(parameters, p);
    case CSG_NODE_FRUSTUM:
        return frustum(parameters, p);
    case CSG_NODE_CAPSULE:
        return capsule(parameters, p);
    case CSG_NODE_TORUS:
        return torus(parameters, p);
    case CSG_NODE_ELLIPSOID:
        return ellipsoid(parameters, p);
    case CSG_NODE_PLANE: {
        csg_vec3 normal = vec3(parameters[0], parameters[1], parameters[2]);
        return (csg_sample){parameters[3] - csg_vec3_dot(normal, p), csg_vec3_scale(normal, -1)};
    }
    case CSG_NODE_CIRCLE:
        return circle(parameters[0], p);
    case CSG_NODE_RECTANGLE:
        return rectangle(parameters, p);
    case CSG_NODE_SLAB:
        return (csg_sample){parameters[0] - fabs(p.z), vec3(0, 0, -sign(p.z))};
    case CSG_NODE_SUPERELLIPSOID:
        return superellipsoid(parameters, p);
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        return tube(kind, parameters, p);
    default:
        assert(kind == CSG_NODE_EMPTY);
        return (csg_sample){-INFINITY, vec3(0, 0, 0)};
    }
}
