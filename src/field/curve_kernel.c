/* SPDX-License-Identifier: MIT
 * The nearest ball of a gentle piece of a curve (compile_curve.h), for many points at once. With
 * w = Q(s) - p, -1 <= s <= 1, |w| - r is least where m(s) = w . Q' - r' |w| turns from below 0 to
 * above, or at an end. A gentle piece has at most two such places that matter. m is looked at in
 * five places; between those where it first and last turns, Newton's method that may not leave its
 * bracket (else it is halved) takes a fixed number of steps. What s lacks then counts with its
 * square.
 *
 * For one radius m is a polynomial whose coefficients the point enters three times only. Every
 * point does the same whatever stands beside it; whether all points of a group have one bracket is
 * all that is asked of them together, and the second search would then find the same.
 */
#include "field/curve_kernel.h"

#include <string.h>

#include "field/frames.h"

enum { LANES = 32, PARTS = 4, STEPS = 4 };

#define INLINE static inline __attribute__((always_inline))

/* A group of points. */
typedef struct group {
    size_t count;
    float x[LANES], y[LANES], z[LANES]; /* in the curve's frame */
    float a[LANES], b[LANES], c[LANES]; /* what m needs: the first coefficients, or the point */
    float low[2][LANES], high[2][LANES], s[2][LANES];
    float value[LANES], gx[LANES], gy[LANES], gz[LANES];
} group;

/* Coordinate k of Q, of Q' and of Q''. */
INLINE float at(const float *own, int degree, int k, float s)
{
    float top = degree == 3 ? own[CURVE_FIRST + 3 + k] + s * own[CURVE_FIRST + 6 + k]
                            : own[CURVE_FIRST + 3 + k];
    return s * (own[CURVE_FIRST + k] + s * top);
}
INLINE float first_at(const float *own, int degree, int k, float s)
{
    float top = degree == 3 ? 2.0f * own[CURVE_FIRST + 3 + k] + 3.0f * s * own[CURVE_FIRST + 6 + k]
                            : 2.0f * own[CURVE_FIRST + 3 + k];
    return own[CURVE_FIRST + k] + s * top;
}
INLINE float second_at(const float *own, int degree, int k, float s)
{
    return degree == 3 ? 2.0f * own[CURVE_FIRST + 3 + k] + 6.0f * s * own[CURVE_FIRST + 6 + k]
                       : 2.0f * own[CURVE_FIRST + 3 + k];
}

/* r, r' and r'' */
INLINE float radius_at(const float *own, int degree, float s)
{
    const float *r = own + CURVE_RADII;
    return r[0] + s * (r[1] + s * (degree == 3 ? r[2] + s * r[3] : r[2]));
}
INLINE float radius_first(const float *own, int degree, float s)
{
    const float *r = own + CURVE_RADII;
    return r[1] + s * (degree == 3 ? 2.0f * r[2] + 3.0f * s * r[3] : 2.0f * r[2]);
}
INLINE float radius_second(const float *own, int degree, float s)
{
    const float *r = own + CURVE_RADII;
    return degree == 3 ? 2.0f * r[2] + 6.0f * s * r[3] : 2.0f * r[2];
}

/* m(s) and its slope; a, b, c: see group. */
INLINE float climb_constant(const float *own, int degree, float a, float b, float c, float s,
                            float *slope)
{
    const float *k = own + CURVE_PRODUCTS; /* of s, s^2, ... */
    float top = degree == 3 ? k[2] + s * (k[3] + s * k[4]) : k[2];
    float steep = degree == 3 ? 3.0f * k[2] + s * (4.0f * k[3] + 5.0f * s * k[4]) : 3.0f * k[2];
    *slope = b + s * (2.0f * c + s * steep);
    return a + s * (b + s * (c + s * top));
}
INLINE float climb_varying(const float *own, int degree, float x, float y, float z, float s,
                           float *slope)
{
    float wx = at(own, degree, 0, s) - x, wy = at(own, degree, 1, s) - y,
          wz = at(own, degree, 2, s) - z;
    float dx = first_at(own, degree, 0, s), dy = first_at(own, degree, 1, s),
          dz = first_at(own, degree, 2, s);
    float length = sqrtf(wx * wx + wy * wy + wz * wz);
    float along = wx * dx + wy * dy + wz * dz, r = radius_first(own, degree, s);
    float bend = wx * second_at(own, degree, 0, s) + wy * second_at(own, degree, 1, s) +
                 wz * second_at(own, degree, 2, s);
    *slope = dx * dx + dy * dy + dz * dz + bend - radius_second(own, degree, s) * length -
             r * quotient(along, length);
    return along - r * length;
}
INLINE float climb(const float *own, int degree, int varies, float a, float b, float c, float s,
                   float *slope)
{
    return varies ? climb_varying(own, degree, a, b, c, s, slope)
                  : climb_constant(own, degree, a, b, c, s, slope);
}

INLINE void prepare(const float *own, int degree, int varies, group *g)
{
    const float *q = own + CURVE_FIRST, *k = own + CURVE_PRODUCTS;
    for (size_t i = 0; i < g->count; i++) {
        float x = g->x[i], y = g->y[i], z = g->z[i];
        float third = degree == 3 ? 3.0f * (x * q[6] + y * q[7] + z * q[8]) : 0;
        g->a[i] = varies ? x : -(x * q[0] + y * q[1] + z * q[2]);
        g->b[i] = varies ? y : k[0] - 2.0f * (x * q[3] + y * q[4] + z * q[5]);
        g->c[i] = varies ? z : k[1] - third;
    }
}

/* m at the ends of a stretch, where it has one sign but turns back towards 0 and may cross it twice
 * in between. */
typedef struct stretch {
    float low, high; /* s */
    float was[LANES], now[LANES], slope_was[LANES], slope_now[LANES];
    float between[LANES], top[LANES]; /* where it was seen on the other side, and m there, else 0 */
} stretch;

INLINE int may_cross(const stretch *t, size_t i)
{
    return ((t->was[i] > 0) == (t->now[i] > 0)) & ((t->was[i] > 0) == (t->slope_was[i] < 0)) &
           ((t->was[i] > 0) == (t->slope_now[i] > 0));
}

/* Goes for the extremum by the chord of the slope; rarely needed. */
INLINE void look_between(const float *own, int degree, int varies, const group *g, stretch *t)
{
    for (size_t i = 0; i < g->count; i++) {
        float low = t->low, high = t->high, at_low = t->slope_was[i], at_high = t->slope_now[i];
        int asked = may_cross(t, i);
        for (int step = 0; step < 3; step++) {
            float slope, s = low + (high - low) * (at_low / (at_low - at_high));
            float m = climb(own, degree, varies, g->a[i], g->b[i], g->c[i], s, &slope);
            int seen = asked & ((m > 0) != (t->was[i] > 0)), left = (slope > 0) == (at_low > 0);
            t->between[i] = seen ? s : t->between[i];
            t->top[i] = seen ? m : t->top[i];
            at_high = left ? at_high : slope;
            high = left ? high : s;
            at_low = left ? slope : at_low;
            low = left ? s : low;
        }
    }
}

/* Where m turns in the stretch, it does so between low and high. */
INLINE void take_bracket(const stretch *t, group *g, float *found)
{
    for (size_t i = 0; i < g->count; i++) {
        int seen = t->top[i] != 0, below = seen & (t->was[i] > 0), above = seen & (t->was[i] <= 0);
        float was = below ? t->top[i] : t->was[i], low = below ? t->between[i] : t->low;
        float now = above ? t->top[i] : t->now[i], high = above ? t->between[i] : t->high;
        int up = (was <= 0) & (now > 0), first = up & (found[i] == 0);
        float start = low + (high - low) * (was / (was - now));
        g->low[0][i] = first ? low : g->low[0][i];
        g->high[0][i] = first ? high : g->high[0][i];
        g->s[0][i] = first ? start : g->s[0][i];
        g->low[1][i] = up ? low : g->low[1][i];
        g->high[1][i] = up ? high : g->high[1][i];
        g->s[1][i] = up ? start : g->s[1][i];
        found[i] = up ? 1.0f : found[i];
    }
}

/* The first and the last place where m turns from below 0 to above: before the piece it is below,
 * behind it above. s: where the chord of m is 0. */
INLINE void bracket(const float *own, int degree, int varies, group *g)
{
    float found[LANES];
    stretch t = {.high = -1};
    for (size_t i = 0; i < g->count; i++) {
        t.now[i] = t.slope_now[i] = -1;
        found[i] = 0;
        for (int side = 0; side < 2; side++)
            g->low[side][i] = g->high[side][i] = g->s[side][i] = 1;
    }
    for (int part = 0; part <= PARTS; part++) {
        int any = 0;
        t.low = t.high;
        t.high = -1.0f + (2.0f / PARTS) * (float)part;
        for (size_t i = 0; i < g->count; i++) {
            t.was[i] = t.now[i];
            t.slope_was[i] = t.slope_now[i];
            t.top[i] = t.between[i] = 0;
            t.now[i] =
                climb(own, degree, varies, g->a[i], g->b[i], g->c[i], t.high, &t.slope_now[i]);
        }
        for (size_t i = 0; i < g->count; i++)
            any |= may_cross(&t, i);
        if (any)
            look_between(own, degree, varies, g, &t);
        take_bracket(&t, g, found);
    }
    for (size_t i = 0; i < g->count; i++) {
        int end = t.now[i] <= 0;
        g->low[1][i] = end ? 1.0f : g->low[1][i];
        g->high[1][i] = end ? 1.0f : g->high[1][i];
        g->s[1][i] = end ? 1.0f : g->s[1][i];
    }
}

INLINE void refine(const float *own, int degree, int varies, group *g, int side)
{
    for (int step = 0; step < STEPS; step++)
        for (size_t i = 0; i < g->count; i++) {
            float slope, s = g->s[side][i];
            float m = climb(own, degree, varies, g->a[i], g->b[i], g->c[i], s, &slope);
            float low = m > 0 ? g->low[side][i] : s, high = m > 0 ? s : g->high[side][i];
            float next = s - m / slope;
            int is_in = (next >= low) & (next <= high);
            g->low[side][i] = low;
            g->high[side][i] = high;
            g->s[side][i] = is_in ? next : 0.5f * (low + high);
        }
}

/* r - |w| at the better of both places, and where it is. */
INLINE void settle(const float *own, int degree, group *g, int sides)
{
    for (int side = 0; side < sides; side++)
        for (size_t i = 0; i < g->count; i++) {
            float s = g->s[side][i];
            float x = at(own, degree, 0, s) - g->x[i], y = at(own, degree, 1, s) - g->y[i],
                  z = at(own, degree, 2, s) - g->z[i];
            float d = sqrtf(x * x + y * y + z * z), value = radius_at(own, degree, s) - d;
            int better = side == 0 ? 1 : value > g->value[i];
            g->value[i] = better ? value : g->value[i];
            g->gx[i] = better ? quotient(x, d) : g->gx[i];
            g->gy[i] = better ? quotient(y, d) : g->gy[i];
            g->gz[i] = better ? quotient(z, d) : g->gz[i];
        }
}

INLINE void search(const float *own, int degree, int varies, group *g)
{
    prepare(own, degree, varies, g);
    bracket(own, degree, varies, g);
    int one = 1;
    for (size_t i = 0; i < g->count; i++)
        one &= g->low[0][i] == g->low[1][i];
    for (int side = 0; side < (one ? 1 : 2); side++)
        refine(own, degree, varies, g, side);
    settle(own, degree, g, one ? 1 : 2);
}

static void search_quadratic(const float *own, group *g)
{
    search(own, 2, 0, g);
}
static void search_quadratic_varying(const float *own, group *g)
{
    search(own, 2, 1, g);
}
static void search_cubic(const float *own, group *g)
{
    search(own, 3, 0, g);
}
static void search_cubic_varying(const float *own, group *g)
{
    search(own, 3, 1, g);
}

/* ---- leaves -------------------------------------------------------------------------------- */

/* Finds the nearest balls of the points from `from` on; how many. */
static size_t run(const csg_tape_node *node, const float *parameters, csg_points p, size_t from,
                  group *g)
{
    float own[OWN_CUBIC_TUBE], frame[12] = {0};
    int offset = node->frame == CSG_FRAME_OFFSET;
    memcpy(own, parameters + (offset ? CSG_LEAF_OWN_OFFSET : CSG_LEAF_OWN_AFFINE), sizeof own);
    memcpy(frame, parameters + CSG_LEAF_FRAME, (offset ? 3 : 12) * sizeof *frame);
    g->count = p.count - from < LANES ? p.count - from : LANES;
    for (size_t i = 0; i < g->count; i++) {
        float x = p.x[from + i], y = p.y[from + i], z = p.z[from + i];
        point q = offset ? offset_frame(frame, x, y, z) : affine_frame(frame, x, y, z);
        g->x[i] = q.x;
        g->y[i] = q.y;
        g->z[i] = q.z;
    }
    int varies = own[CURVE_VARIES] != 0;
    if (node->op == CSG_OP_CUBIC_TUBE)
        (varies ? search_cubic_varying : search_cubic)(own, g);
    else
        (varies ? search_quadratic_varying : search_quadratic)(own, g);
    return g->count;
}

static void curve_values(const csg_tape_node *node, const float *parameters, csg_points p,
                         float *out)
{
    group g;
    const float sigma = parameters[CSG_LEAF_SIGMA];
    for (size_t from = 0; from < p.count; from += g.count) {
        run(node, parameters, p, from, &g);
        for (size_t i = 0; i < g.count; i++)
            out[from + i] = sigma * g.value[i];
    }
}

static void curve_gradients(const csg_tape_node *node, const float *parameters, csg_points p,
                            float *out, float *gx, float *gy, float *gz)
{
    group g;
    const float sigma = parameters[CSG_LEAF_SIGMA];
    for (size_t from = 0; from < p.count; from += g.count) {
        run(node, parameters, p, from, &g);
        for (size_t i = 0; i < g.count; i++) {
            point way = {g.gx[i], g.gy[i], g.gz[i]};
            if (node->frame == CSG_FRAME_AFFINE)
                way = affine_back(parameters + CSG_LEAF_FRAME, way);
            out[from + i] = sigma * g.value[i];
            gx[from + i] = sigma * way.x;
            gy[from + i] = sigma * way.y;
            gz[from + i] = sigma * way.z;
        }
    }
}

const csg_curve_kernel CSG_THIS_CURVE_KERNEL = {
    .values = curve_values,
    .gradients = curve_gradients,
};
