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
#include "field/kernels/curve_kernel.h"

#include <string.h>

#include "field/kernels/frames.h"
#include "scene/primitives/tube.h"

enum { LANES = 64, PARTS = 5, STEPS = 4 };

#define INLINE static inline __attribute__((always_inline))

/* Where the search for one minimum stands: between low and high, at s. */
typedef struct place {
    float low[LANES], high[LANES], s[LANES];
} place;

/* A group of points. */
typedef struct group {
    size_t count;
    float x[LANES], y[LANES], z[LANES]; /* in the curve's frame */
    float a[LANES], b[LANES], c[LANES]; /* what m needs: the first coefficients, or the point */
    place first, last;
    float value[LANES], gx[LANES], gy[LANES], gz[LANES];
} group;

/* Coordinate k of Q, of Q' and of Q''. */
INLINE float at(const float *own, int degree, int k, float s)
{
    float top = degree == 3 ? own[CSG_TUBE_FIRST + 3 + k] + s * own[CSG_TUBE_FIRST + 6 + k]
                            : own[CSG_TUBE_FIRST + 3 + k];
    return s * (own[CSG_TUBE_FIRST + k] + s * top);
}
INLINE float first_at(const float *own, int degree, int k, float s)
{
    float top = degree == 3
                    ? 2.0f * own[CSG_TUBE_FIRST + 3 + k] + 3.0f * s * own[CSG_TUBE_FIRST + 6 + k]
                    : 2.0f * own[CSG_TUBE_FIRST + 3 + k];
    return own[CSG_TUBE_FIRST + k] + s * top;
}
INLINE float second_at(const float *own, int degree, int k, float s)
{
    return degree == 3 ? 2.0f * own[CSG_TUBE_FIRST + 3 + k] + 6.0f * s * own[CSG_TUBE_FIRST + 6 + k]
                       : 2.0f * own[CSG_TUBE_FIRST + 3 + k];
}

/* r, r' and r'' */
INLINE float radius_at(const float *own, int degree, float s)
{
    const float *r = own + CSG_TUBE_RADII;
    return r[0] + s * (r[1] + s * (degree == 3 ? r[2] + s * r[3] : r[2]));
}
INLINE float radius_first(const float *own, int degree, float s)
{
    const float *r = own + CSG_TUBE_RADII;
    return r[1] + s * (degree == 3 ? 2.0f * r[2] + 3.0f * s * r[3] : 2.0f * r[2]);
}
INLINE float radius_second(const float *own, int degree, float s)
{
    const float *r = own + CSG_TUBE_RADII;
    return degree == 3 ? 2.0f * r[2] + 6.0f * s * r[3] : 2.0f * r[2];
}

/* m(s) and its slope; a, b, c: see group. */
INLINE float climb_constant(const float *own, int degree, float a, float b, float c, float s,
                            float *slope)
{
    const float *k = own + CSG_TUBE_PRODUCTS; /* of s, s^2, ... */
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
    const float *q = own + CSG_TUBE_FIRST, *k = own + CSG_TUBE_PRODUCTS;
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
    float found[LANES];               /* 1 where m has turned before */
} stretch;

INLINE int may_cross(float was, float now, float slope_was, float slope_now)
{
    int falls = (was > 0) & (now > 0) & (slope_was < 0) & (slope_now > 0);
    int climbs = (was <= 0) & (now <= 0) & (slope_was > 0) & (slope_now < 0);
    return falls | climbs;
}

/* Goes for the extremum by the chord of the slope; rarely needed. */
INLINE void look_between(const float *own, int degree, int varies, const group *g, stretch *t)
{
    const size_t count = g->count;
    float low[LANES], high[LANES], at_low[LANES], at_high[LANES];
    for (size_t i = 0; i < count; i++) {
        int asked = may_cross(t->was[i], t->now[i], t->slope_was[i], t->slope_now[i]);
        low[i] = t->low;
        high[i] = t->high;
        at_low[i] = asked ? t->slope_was[i] : 0; /* s stays low, where nothing new is seen */
        at_high[i] = asked ? t->slope_now[i] : 1.0f;
    }
    for (int step = 0; step < 3; step++)
        for (size_t i = 0; i < count; i++) {
            float slope, s = low[i] + (high[i] - low[i]) * (at_low[i] / (at_low[i] - at_high[i]));
            float m = climb(own, degree, varies, g->a[i], g->b[i], g->c[i], s, &slope);
            float was = t->was[i];
            int seen = ((m > 0) & (was <= 0)) | ((m < 0) & (was > 0));
            int left = ((slope > 0) & (at_low[i] > 0)) | ((slope < 0) & (at_low[i] < 0));
            t->between[i] = seen ? s : t->between[i];
            t->top[i] = seen ? m : t->top[i];
            at_high[i] = left ? at_high[i] : slope;
            high[i] = left ? high[i] : s;
            at_low[i] = left ? slope : at_low[i];
            low[i] = left ? s : low[i];
        }
}

INLINE void look_at_stretch(const float *own, int degree, int varies, const group *g, stretch *t)
{
    const size_t count = g->count;
    float s = t->high, any = 0;
    for (size_t i = 0; i < count; i++) {
        t->was[i] = t->now[i];
        t->slope_was[i] = t->slope_now[i];
        t->top[i] = t->between[i] = 0;
    }
    for (size_t i = 0; i < count; i++)
        t->now[i] = climb(own, degree, varies, g->a[i], g->b[i], g->c[i], s, &t->slope_now[i]);
    for (size_t i = 0; i < count; i++) {
        int may = may_cross(t->was[i], t->now[i], t->slope_was[i], t->slope_now[i]);
        any = may ? 1.0f : any;
    }
    if (any != 0)
        look_between(own, degree, varies, g, t);
}

/* Where m turns in the stretch, it does so between low and high. */
INLINE void take_bracket(stretch *restrict t, size_t count, place *restrict first,
                         place *restrict last)
{
    const float t_low = t->low, t_high = t->high;
    for (size_t i = 0; i < count; i++) {
        float was = t->was[i], now = t->now[i], top = t->top[i], between = t->between[i];
        /* m was not seen below 0 unless it stood above, and the other way round */
        float low = top < 0 ? between : t_low, high = top > 0 ? between : t_high;
        was = top < 0 ? top : was;
        now = top > 0 ? top : now;
        float start = low + (high - low) * (was / (was - now));
        int up = (was <= 0) & (now > 0), is_first = up & (t->found[i] == 0);
        first->low[i] = is_first ? low : first->low[i];
        first->high[i] = is_first ? high : first->high[i];
        first->s[i] = is_first ? start : first->s[i];
        last->low[i] = up ? low : last->low[i];
        last->high[i] = up ? high : last->high[i];
        last->s[i] = up ? start : last->s[i];
        t->found[i] = up ? 1.0f : t->found[i];
    }
}

/* The first and the last place where m turns from below 0 to above: before the piece it is below,
 * behind it above. s: where the chord of m is 0. */
INLINE void bracket(const float *own, int degree, int varies, group *g)
{
    const size_t count = g->count;
    stretch t = {.high = -1};
    for (size_t i = 0; i < count; i++) {
        t.now[i] = t.slope_now[i] = -1;
        t.found[i] = 0;
        g->first.low[i] = g->first.high[i] = g->first.s[i] = 1;
        g->last.low[i] = g->last.high[i] = g->last.s[i] = 1;
    }
    for (int part = 0; part <= PARTS; part++) {
        t.low = t.high;
        t.high = -1.0f + (2.0f / PARTS) * (float)part;
        look_at_stretch(own, degree, varies, g, &t);
        take_bracket(&t, count, &g->first, &g->last);
    }
    for (size_t i = 0; i < count; i++) {
        float end = t.now[i];
        g->last.low[i] = end <= 0 ? 1.0f : g->last.low[i];
        g->last.high[i] = end <= 0 ? 1.0f : g->last.high[i];
        g->last.s[i] = end <= 0 ? 1.0f : g->last.s[i];
    }
}

INLINE void refine(const float *own, int degree, int varies, const group *g, place *at)
{
    const size_t count = g->count;
    for (int step = 0; step < STEPS; step++)
        for (size_t i = 0; i < count; i++) {
            float slope, s = at->s[i];
            float m = climb(own, degree, varies, g->a[i], g->b[i], g->c[i], s, &slope);
            float low = m > 0 ? at->low[i] : s, high = m > 0 ? s : at->high[i];
            float next = s - m / slope, half = 0.5f * (low + high);
            next = next >= low ? next : half;
            at->low[i] = low;
            at->high[i] = high;
            at->s[i] = next <= high ? next : half;
        }
}

/* r - |w| at s and the way there. */
INLINE void take_ball(const float *own, int degree, group *g, const float *at_s)
{
    const size_t count = g->count;
    for (size_t i = 0; i < count; i++) {
        float s = at_s[i], old = g->value[i];
        float x = at(own, degree, 0, s) - g->x[i], y = at(own, degree, 1, s) - g->y[i],
              z = at(own, degree, 2, s) - g->z[i];
        float d = sqrtf(x * x + y * y + z * z), value = radius_at(own, degree, s) - d;
        float over = quotient(1.0f, d);
        x *= over;
        y *= over;
        z *= over;
        g->value[i] = value > old ? value : old;
        g->gx[i] = value > old ? x : g->gx[i];
        g->gy[i] = value > old ? y : g->gy[i];
        g->gz[i] = value > old ? z : g->gz[i];
    }
}

INLINE void search(const float *parameters, int degree, int varies, group *g)
{
    const size_t count = g->count;
    float other = 0, own[CSG_TUBE_OWN]; /* a copy: the compiler then knows that nothing writes it */
    memcpy(own, parameters, sizeof own);
    prepare(own, degree, varies, g);
    bracket(own, degree, varies, g);
    for (size_t i = 0; i < count; i++) {
        other = g->first.low[i] != g->last.low[i] ? 1.0f : other;
        g->value[i] = -INFINITY;
        g->gx[i] = g->gy[i] = g->gz[i] = 0;
    }
    refine(own, degree, varies, g, &g->first);
    take_ball(own, degree, g, g->first.s);
    if (other != 0) {
        refine(own, degree, varies, g, &g->last);
        take_ball(own, degree, g, g->last.s);
    }
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
static size_t find_nearest_balls(const csg_tape_node *node, const float *parameters, csg_points p,
                                 size_t from, group *g)
{
    float frame[12] = {0};
    int offset = node->frame == CSG_FRAME_OFFSET;
    const float *own = parameters + (offset ? CSG_LEAF_OWN_OFFSET : CSG_LEAF_OWN_AFFINE);
    memcpy(frame, parameters + CSG_LEAF_FRAME, (offset ? 3 : 12) * sizeof *frame);
    g->count = p.count - from < LANES ? p.count - from : LANES;
    for (size_t i = 0; i < g->count; i++) {
        float x = p.x[from + i], y = p.y[from + i], z = p.z[from + i];
        point q = offset ? offset_frame(frame, x, y, z) : affine_frame(frame, x, y, z);
        g->x[i] = q.x;
        g->y[i] = q.y;
        g->z[i] = q.z;
    }
    int varies = own[CSG_TUBE_VARIES] != 0;
    if (node->op == CSG_OP_OF(CUBIC_TUBE))
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
        find_nearest_balls(node, parameters, p, from, &g);
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
        find_nearest_balls(node, parameters, p, from, &g);
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
