/* SPDX-License-Identifier: MIT
 * The blends of fields F in [0, 1] with the surface at 1/2 (operators.md 4 to 6, 9), each written
 * once, for one point, without branches, as formulas.h does: only + - * / sqrt, comparisons,
 * selections and the functions of functions.h, so every instruction set gives the same bits.
 *
 * An operand that does not count leaves the other one as it is, bit for bit; prune.c drops it then.
 * Solutions come from the defining equations in forms that lose no digits, or from Newton's method
 * on them, not from the closed forms of the papers.
 */
#ifndef CSG_FIELD_SOFT_FORMULAS_H
#define CSG_FIELD_SOFT_FORMULAS_H

#include "field/kernels/functions.h"
#include "field/rule_layout.h"
#include "field/tape.h"
#include "scene/primitives/point.h"

/* Else gcc may call the longer ones, and a loop with a call is no vector loop. */
#define INLINED __attribute__((always_inline)) static inline

/* A value and its partial derivatives with respect to both operands. */
typedef struct mixture {
    float value, a, b;
} mixture;

/* A value and its derivative. */
typedef struct curve {
    float value, slope;
} curve;

/* ---- field functions P(d), s = d^2: value and dP/dd (operators.md 4) --------------------------
 * In factors, so that the end at d = 1 keeps its digits; beyond it exactly 0. bend_of_: the
 * coefficients of 1, s, s^2 in the second derivative before that. */

static const float bend_of_sextic[3] = {-44.0f / 9, 68.0f / 3, -40.0f / 3};
static inline curve falloff_sextic(float d)
{
    float s = d * d, u = larger(1.0f - s, 0);
    return (curve){(u * u) * (1.0f - (4.0f / 9) * s), d * u * ((8.0f / 3) * s - 44.0f / 9)};
}
static const float bend_of_cubic[3] = {-6, 36, -30};
static inline curve falloff_cubic(float d)
{
    float u = larger(1.0f - d * d, 0);
    return (curve){u * u * u, -6.0f * d * (u * u)};
}
static const float bend_of_quartic[3] = {-4, 12, 0};
static inline curve falloff_quartic(float d)
{
    float u = larger(1.0f - d * d, 0);
    return (curve){u * u, -4.0f * d * u};
}
static const float bend_of_quadratic[3] = {-2, 0, 0};
static inline curve falloff_quadratic(float d)
{
    float u = larger(1.0f - d * d, 0);
    return (curve){u, u > 0 ? -2.0f * d : 0};
}

/* H_3, the step that makes a field of a distance, and its derivative (operators.md 7.1, 9). */
static inline curve step_cubic(float t)
{
    float a = 1.0f - smaller(absolute(t), 1.0f); /* from the nearer end: 0 and 1 are exact */
    float outer = (9.0f / 16) * (a * a * a);     /* u^3 / 6 with u = 3 a / 2 */
    float v = 1.5f * a - 1.5f;
    float inner = -5.0f / 8 + 1.125f * a - (v * v * v) / 3.0f;
    float low = a < 2.0f / 3 ? outer : inner;
    float slope = a < 2.0f / 3 ? (27.0f / 16) * (a * a) : 1.125f - 1.5f * (v * v);
    return (curve){t > 0 ? 1.0f - low : low, slope};
}

/* 1/2 + rate v in [0, 1]; what is nearly 0 or 1 comes from a field that was just that. */
static inline curve clamped(float f)
{
    const float hair = 0x1p-22f;
    int inside = (f > hair) & (f < 1.0f - hair);
    float end = f > 0.5f ? 1.0f : 0.0f;
    return (curve){inside ? f : end, inside ? 1.0f : 0.0f};
}

static inline float distance_of(float iso, float rate, float v)
{
    return larger(smaller(iso - rate * v, 1.0f), 0); /* NaN is outside */
}

/* ---- Ricci's operators (6.1) --------------------------------------------------------------- */

/* t^p for 0 <= t <= 1, p >= 1, by ln t, -200 for 0, of which the power is exactly 0. Sums instead
 * of choices, which would keep gcc 12 from vectorising the exponential's conversion. */
INLINED float power(float t, float p)
{
    float nothing = t > 0 ? 0 : 1.0f;
    return value_exp(p * (value_ln(t + nothing, 0) - 200.0f * nothing), 0);
}

/* (x^n + y^n)^(1/n) or, of = -1, (x^-n + y^-n)^(-1/n), by the ratio t of the operands and the root
 * r of 1 + t^n. */
INLINED mixture ricci(float n, float of, float x, float y)
{
    float most = larger(x, y), least = smaller(x, y);
    float t = quotient(least, most), u = power(t, n);
    float log = value_ln(1.0f + u, 0);
    float r = value_exp(of * log / n, 0); /* exactly 1 where u = 0 */
    /* Union: (most / G)^(n - 1), intersection: (G / least)^(n + 1). */
    float near = value_exp((of / n - 1.0f) * log, 0);
    float far = near * (of > 0 ? quotient(u, t) : u * t);
    int x_near = of > 0 ? x >= y : x <= y;
    return (mixture){(of > 0 ? most : least) * r, x_near ? near : far, x_near ? far : near};
}
INLINED mixture ricci_union(float n, float x, float y)
{
    return ricci(n, 1.0f, x, y);
}
INLINED mixture ricci_intersection(float n, float x, float y)
{
    return ricci(n, -1.0f, x, y);
}

/* ---- super-ellipsoids (4) ---------------------------------------------------------------------
 */

/* (1 - d) / L by the gauge d, the same sum of powers twice (scene/primitives/superellipsoid.h). */
static inline float csg_superellipsoid_value(const float *own, point at, point *g)
{
    float x = absolute(at.x) / own[0], y = absolute(at.y) / own[1], z = absolute(at.z) / own[2];
    mixture flat = ricci_union(own[3], x, y), d = ricci_union(own[4], flat.value, z);
    float s = d.value > 0 ? -own[5] : 0;
    *g = (point){s * sign_of(at.x) * d.a * flat.a / own[0],
                 s * sign_of(at.y) * d.a * flat.b / own[1], s * sign_of(at.z) * d.b / own[2]};
    return own[5] - own[5] * d.value;
}

/* ---- Hsu's scale function (6.3) ----------------------------------------------------------------
 */

/* B(x, y; r1, r2, p), kappa = p / (r1 r2) < 1. */
INLINED mixture scale(float r1, float r2, float kappa, float x, float y)
{
    int first = x <= y;
    float least = smaller(x, y), d = absolute(x - y);
    float turn = first ? 1.0f : 0.0f;
    float near = r2 + turn * (r1 - r2), far = r1 + turn * (r2 - r1);
    float q = near * (far * least - d), area = r1 * r2;
    float reach = r1 + r2 + area, bend = 2.0f * area * (1.0f - kappa);
    int inside = q > 0;
    q = larger(q, 0);
    float root = sqrtf(larger(bend * (bend * (d * d) + 4.0f * reach * q * d + 4.0f * (q * q)), 0));
    float under = 2.0f * reach * q + bend * d + root;
    float value = least - (inside ? 2.0f * (q * q) / under : 0);
    /* u and v of the smaller and of the larger operand. */
    float u = larger(quotient(least - value, near * value), 0);
    float v = larger(quotient(least + d - value, far * value), 0);
    float middle = sqrtf(2.0f * (1.0f - kappa)), both = 2.0f * sqrtf(u * v);
    float w_near = (both + middle * v) / near, w_far = (both + middle * u) / far;
    float sum = (1.0f + near * u) * w_near + (1.0f + far * v) * w_far;
    int known = inside & (sum > 0);
    float share_near = known ? w_near / sum : 1.0f, share_far = known ? w_far / sum : 0.0f;
    return (mixture){value, first ? share_near : share_far, first ? share_far : share_near};
}

/* N_S (6.5) with bend = A; from `top` on, a hair below m, it is 1. */
static inline curve normalise_scale(float top, float bend, float u)
{
    float over = larger(u - 0.5f, 0);
    int full = u >= top;
    return (curve){full ? 1.0f : u + bend * (over * over), full ? 0.0f : 1.0f + 2.0f * bend * over};
}

/* N_A (6.5) */
static inline curve normalise_sum(float u)
{
    float rest = 1.0f - u;
    int low = u < 0.5f, full = u >= 1.0f;
    float value = 1.0f - 4.0f * u * (rest * rest), slope = 4.0f * rest * (3.0f * u - 1.0f);
    value = low ? u : value;
    slope = low ? 1.0f : slope;
    return (curve){full ? 1.0f : value, full ? 0.0f : slope};
}

/* N_S for ranges times s: m = 1 / (1 + s h) with h = r1 r2 / (r1 + r2 + sqrt(2 r1 r2 (1 - kappa))).
 */
static inline float top_of_turned(float h, float s)
{
    return (1.0f - (float)CSG_SCALE_HAIR) / (1.0f + s * h);
}
/* 1 - m = s h / under, m - 1/2 = half / 2 under */
static inline float bend_of_turned(float h, float s)
{
    float under = 1.0f + s * h, half = 1.0f - s * h;
    return 4.0f * s * h * under / (half * half);
}
static inline curve normalise_turned(float h, float s, float u)
{
    return normalise_scale(top_of_turned(h, s), bend_of_turned(h, s), u);
}

/* ---- products (6.4) -------------------------------------------------------------------------- */

INLINED mixture perlin_union(float x, float y)
{
    return (mixture){x + y * (1.0f - x), 1.0f - y, 1.0f - x};
}
INLINED mixture perlin_intersection(float x, float y)
{
    return (mixture){x * y, y, x};
}

/* ---- arcs of ellipses (5.2, 5.3): a = cot(angle2), b = tan(angle1) ------------------------------
 */

/* Whether the angle of (x, y) lies in the transition. */
static inline int arc_blends(float a, float b, float x, float y)
{
    return (y > b * x) & (x > a * y);
}

INLINED mixture arc_union(float a, float b, float x, float y)
{
    float al = 1.0f - a, be = 1.0f - b;
    float nu = (be * be) * (x * x) + (al * al) * (y * y), w = a * y - b * x;
    float root = sqrtf(larger(nu - w * w, 0));
    float under = (be * be) * a * x + (al * al) * b * y + al * be * root;
    float g = larger(quotient(nu, under), larger(x, y));
    float nx = (be * be) * larger(x - a * g, 0), ny = (al * al) * larger(y - b * g, 0);
    float scale = quotient(g, x * nx + y * ny);
    int only_x = y <= b * x, only_y = x <= a * y;
    float gx = only_y ? 0.0f : nx * scale, gy = only_y ? 1.0f : ny * scale;
    g = only_y ? y : g;
    return (mixture){only_x ? x : g, only_x ? 1.0f : gx, only_x ? 0.0f : gy};
}

/* 1 / A = b and 1 / B = a of 5.3, multiplied through by a^2 b^2. */
INLINED mixture arc_intersection(float a, float b, float x, float y)
{
    float al = 1.0f - b, be = 1.0f - a, w = a * y - b * x;
    float square = (be * be) * (b * b) * (x * x) + (al * al) * (a * a) * (y * y) - w * w;
    float root = sqrtf(larger(square, 0));
    float under = be * be + al * al - (al * al) * (be * be);
    float g = quotient((be * be) * b * x + (al * al) * a * y + al * be * root, under);
    g = smaller(g, smaller(x, y));
    float nx = (be * be) * b * larger(g - b * x, 0), ny = (al * al) * a * larger(g - a * y, 0);
    float scale = quotient(g, x * nx + y * ny);
    int only_y = y <= b * x, only_x = x <= a * y;
    float gx = only_x ? 1.0f : nx * scale, gy = only_x ? 0.0f : ny * scale;
    g = only_x ? x : g;
    return (mixture){only_y ? y : g, only_y ? 0.0f : gx, only_y ? 1.0f : gy};
}

/* One stretch's part of a profile's factor (5.5): what it rises between its knots and where the
 * angle is. */
static inline curve profile_part(const float *stretch, float angle)
{
    const float inverse = stretch[CSG_STRETCH_INVERSE], rise = stretch[CSG_STRETCH_RISE];
    const float first = stretch[CSG_STRETCH_SLOPE], last = stretch[CSG_STRETCH_NEXT_SLOPE];
    float s = smaller(larger((angle - stretch[CSG_STRETCH_ANGLE]) * inverse, 0), 1.0f);
    float z = 1.0f - s;
    float steep =
        rise * (6.0f * s * z) + first * (z * (1.0f - 3.0f * s)) + last * (s * (3.0f * s - 2.0f));
    return (curve){rise * (s * s * (3.0f - 2.0f * s)) + first * (s * (z * z)) - last * (s * s * z),
                   (s > 0) & (s < 1.0f) ? inverse * steep : 0};
}

/* ---- sharp -----------------------------------------------------------------------------------
 */

static inline mixture field_union(float x, float y)
{
    float first = x > y ? 1.0f : 0.0f;
    return (mixture){larger(x, y), first, 1.0f - first};
}
static inline mixture field_intersection(float x, float y)
{
    float first = x < y ? 1.0f : 0.0f;
    return (mixture){smaller(x, y), first, 1.0f - first};
}

/* ---- sharp at the surface (5.6), C = 1/2 ------------------------------------------------------
 */

/* Newton's method on phi(c) = r - (c - m), m(c) the centre of the circle through (x, y). */
INLINED mixture sharp_union(float x, float y)
{
    float most = larger(x, y), least = smaller(x, y);
    int below = 0.5f * least > most * most, above = least * least > 0.5f * most;
    float last = below ? sqrtf(0.5f * least) : 2.0f * (least * least);
    float c = most, cx = 0, cy = 0, slope = 0;
#pragma GCC unroll 5
    for (int step = 0; step < 5; step++) {
        float root = sqrtf(0.5f * c);
        float m = below ? 2.0f * (c * c) : root;
        slope = below ? 4.0f * c : 0.5f * quotient(root, c);
        float dx = absolute(x - m), dy = absolute(y - m), r = sqrtf(dx * dx + dy * dy);
        cx = quotient(dx, r), cy = quotient(dy, r);
        float next = c + (r - (c - m)) / (1.0f + slope * (cx + cy - 1.0f));
        next = smaller(larger(next, most), last);
        c = step < 4 ? next : c; /* the last round is for the derivatives */
    }
    int arc = below | above;
    float scale = 1.0f / (1.0f + slope * (cx + cy - 1.0f));
    float gx = x >= y ? 1.0f : 0.0f, gy = x >= y ? 0.0f : 1.0f;
    int known = arc & (cx + cy > 0);
    return (mixture){arc ? c : most, known ? cx * scale : gx, known ? cy * scale : gy};
}

/* The same mirrored; below the level for the centre instead of c = 2 m^2, since m(c) is steep at
 * 0. Both are concave or convex from the right end of their brackets, so steps do not pass the
 * root.
 */
INLINED mixture sharp_intersection(float x, float y)
{
    float most = larger(x, y), least = smaller(x, y);
    int below = 0.5f * least > most * most, above = least * least > 0.5f * most;
    float end = below ? sqrtf(0.5f * least) : least, first = below ? most : sqrtf(0.5f * most);
    float v = end, c = least, cx = 0, cy = 0, slope = 0; /* v: m below, c above */
#pragma GCC unroll 8
    for (int step = 0; step < 8; step++) {
        float m = below ? v : 2.0f * (v * v);
        c = below ? 2.0f * (v * v) : v;
        slope = 4.0f * v; /* of the one by the other */
        float dx = absolute(m - x), dy = absolute(m - y), r = sqrtf(dx * dx + dy * dy);
        cx = quotient(dx, r), cy = quotient(dy, r);
        float s = cx + cy, phi = (m - c) - r;
        float rise = below ? 1.0f - slope - s : slope * (1.0f - s) - 1.0f;
        float next = v - phi / (rise < 0 ? rise : -1.0f);
        next = smaller(larger(next, first), end);
        v = step < 7 ? next : v;
    }
    float along = below ? quotient(1.0f, slope) : slope; /* m'(c) */
    int arc = below | above;
    float scale = 1.0f / (1.0f + along * (cx + cy - 1.0f));
    float gx = x < y ? 1.0f : 0.0f, gy = x < y ? 0.0f : 1.0f;
    int known = arc & (cx + cy > 0);
    return (mixture){arc ? c : least, known ? cx * scale : gx, known ? cy * scale : gy};
}

#endif
