/* SPDX-License-Identifier: MIT
 * The float formulas of every primitive, each written once, for one point, without
 * branches: kernel.c runs them over batches and the compiler turns the batch loops into vectors.
 * Only + - * / sqrt, comparisons and selections: each exactly rounded, so every instruction set
 * gives the same bits. The definition they answer to is scene/reference.h.
 *
 * A primitive returns its value (f > 0 inside) and writes its gradient; where the caller drops the
 * gradient the compiler drops its arithmetic.
 */
#ifndef CSG_FIELD_FORMULAS_H
#define CSG_FIELD_FORMULAS_H

#include <math.h>

#include "base/select.h"
#include "scene/scene.h"

typedef struct point {
    float x, y, z;
} point;

/* ---- primitives: own parameters in the order packed by compile.c ---------------------- */

enum {
    OWN_SPHERE = 1,
    OWN_BOX = 4,
    OWN_FRUSTUM = 8,
    OWN_CAPSULE = 5,
    OWN_TORUS = 4,
    OWN_ELLIPSOID = 6,
    OWN_PLANE = 4,
    OWN_CIRCLE = 1,
    OWN_RECTANGLE = 3,
    OWN_SLAB = 1,
    OWN_SUPERELLIPSOID = 6 /* soft_formulas.h */
};

/* Own parameters of a piece of a curve (curve_kernel.c), s = -1 to 1 along it, its middle the
 * origin: coefficients of Q for s, s^2, s^3, of r for 1, s, s^2, s^3, and of Q . Q' for s to s^5;
 * whether r varies. */
enum {
    CURVE_FIRST,
    CURVE_RADII = CURVE_FIRST + 9,
    CURVE_PRODUCTS = CURVE_RADII + 4,
    CURVE_VARIES = CURVE_PRODUCTS + 5,
    OWN_QUADRATIC_TUBE,
    OWN_CUBIC_TUBE = OWN_QUADRATIC_TUBE
};

/* own: r */
static inline float sphere_at(const float *own, point q, point *g)
{
    float d = sqrtf(q.x * q.x + q.y * q.y + q.z * q.z);
    float s = quotient(-1.0f, d);
    *g = (point){q.x * s, q.y * s, q.z * s};
    return own[0] - d;
}

/* own: half sizes without the rounding, rounding */
static inline float box_at(const float *own, point q, point *g)
{
    float ax = absolute(q.x) - own[0], ay = absolute(q.y) - own[1], az = absolute(q.z) - own[2];
    float ox = larger(ax, 0), oy = larger(ay, 0), oz = larger(az, 0);
    float outside = sqrtf(ox * ox + oy * oy + oz * oz);
    float inside = larger(ax, larger(ay, az));
    int is_out = inside > 0;
    float s = quotient(-1.0f, outside);
    float fx = ax >= larger(ay, az) ? -1.0f : 0;
    float fy = (ay >= az) & (fx == 0) ? -1.0f : 0;
    float fz = (fx == 0) & (fy == 0) ? -1.0f : 0;
    *g = (point){sign_of(q.x) * (is_out ? ox * s : fx), sign_of(q.y) * (is_out ? oy * s : fy),
                 sign_of(q.z) * (is_out ? oz * s : fz)};
    return own[3] - (is_out ? outside : inside);
}

/* Distance to a convex outline in the (rho, z) half plane: the side from (r1, -h) to (r2, h) and
 * the flat caps. Differences to the side's line, not to nearest points, so that the gradient is
 * exact where roots lie: on the surface. own: r1, (r1 + r2) / 2, h, nx, nz (side's outward
 * normal), length of the side, rounding, (r2 - r1) / 2 (not r1, r2: gcc 12 does not vectorise a
 * choice between two parameters) */
static inline float frustum_at(const float *own, point q, point *g)
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

/* Balls of radius r(t) along a segment: the farthest-reaching t in closed form.
 * own: h, 1 / h, r1, r2 - r1, s / c with s = (r1 - r2) / h, c = sqrt(1 - s^2) */
static inline float capsule_at(const float *own, point q, point *g)
{
    float rho = sqrtf(q.x * q.x + q.y * q.y);
    float t = smaller(larger((q.z - rho * own[4]) * own[1], 0), 1.0f);
    float dz = q.z - t * own[0];
    float d = sqrtf(q.x * q.x + q.y * q.y + dz * dz);
    float s = quotient(-1.0f, d);
    *g = (point){q.x * s, q.y * s, dz * s};
    return own[2] + t * own[3] - d;
}

/* own: R, r, cosine and sine of half the opening angle */
static inline float torus_at(const float *own, point q, point *g)
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

/* Exact distance: the nearest point y satisfies y_i = e_i^2 p_i / (t + e_i^2); solved in scaled
 * variables (Eberly, "Distance from a point to an ellipse, an ellipsoid", 2013) with v = t / e_z^2
 * + 1, e_z the smallest semi-axis, so that nothing cancels near the medial disc. Newton on a convex
 * decreasing function rises to its root from any lower bound. The bounds: no term exceeds 1; and
 * where a step from v = 1 lands, which is the root for points on the surface, so that few steps do
 * near it. Nine reach float precision everywhere for axes up to 1 : 100. own: e_x >= e_z,
 * e_y >= e_z, e_z (compile.c turns the axes), e_x^2 / e_z^2, e_y^2 / e_z^2, 0 */
static inline float ellipsoid_at(const float *own, point q, point *g)
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

/* own: n (with any scale folded in), d */
static inline float plane_at(const float *own, point q, point *g)
{
    *g = (point){-own[0], -own[1], -own[2]};
    return own[3] - (own[0] * q.x + own[1] * q.y + own[2] * q.z);
}

/* own: r */
static inline float circle_at(const float *own, point q, point *g)
{
    float d = sqrtf(q.x * q.x + q.y * q.y);
    float s = quotient(-1.0f, d);
    *g = (point){q.x * s, q.y * s, 0};
    return own[0] - d;
}

/* own: half sizes without the rounding, rounding */
static inline float rectangle_at(const float *own, point q, point *g)
{
    float ax = absolute(q.x) - own[0], ay = absolute(q.y) - own[1];
    float ox = larger(ax, 0), oy = larger(ay, 0);
    float outside = sqrtf(ox * ox + oy * oy), inside = larger(ax, ay);
    int is_out = inside > 0;
    float s = quotient(-1.0f, outside);
    float fx = ax >= ay ? -1.0f : 0, fy = ax >= ay ? 0 : -1.0f;
    *g = (point){sign_of(q.x) * (is_out ? ox * s : fx), sign_of(q.y) * (is_out ? oy * s : fy), 0};
    return own[2] - (is_out ? outside : inside);
}

/* own: half height */
static inline float slab_at(const float *own, point q, point *g)
{
    *g = (point){0, 0, -sign_of(q.z)};
    return own[0] - absolute(q.z);
}

#endif
