/* SPDX-License-Identifier: MIT
 * Warps in float, each map and its derivative written once; built once per instruction set like
 * kernel.c. Definitions: scene/primitives/warp.c.
 */
#include "field/kernels/warp_kernel.h"

#include <string.h>

#include "field/kernels/functions.h"
#include "scene/primitives/point.h"
#include "scene/warp_kinds.h"

#define HALF_TURN 3.14159274f

/* Where a point goes, and how: columns of the derivative. */
typedef struct warped {
    point at, dx, dy, dz;
} warped;

static inline point row_point(const float *m, float x, float y, float z)
{
    return (point){m[0] * x + m[1] * y + m[2] * z + m[9], m[3] * x + m[4] * y + m[5] * z + m[10],
                   m[6] * x + m[7] * y + m[8] * z + m[11]};
}

static inline warped revolve_at(const float *own, point p)
{
    float rho = sqrtf(p.x * p.x + p.y * p.y);
    return (warped){
        {rho, p.z, 0}, {quotient(p.x, rho), 0, 0}, {quotient(p.y, rho), 0, 0}, {0, 1.0f, 0}};
}

static inline warped slice_at(const float *own, point p)
{
    return (warped){{p.x, p.y, 0}, {1.0f, 0, 0}, {0, 1.0f, 0}, {0, 0, 0}};
}

/* As in double. */
static inline warped elbow_at(const float *own, point p)
{
    float c = own[CSG_ELBOW_COSINE], s = own[CSG_ELBOW_SINE];
    float a = p.x * c + absolute(p.y) * s, b = p.x * s - absolute(p.y) * c;
    float da = larger(a, 0), db = larger(b, 0), d = sqrtf(da * da + db * db);
    float by_a = b > 0 ? quotient(da, d) : 1.0f, by_b = b > 0 ? quotient(db, d) : 0;
    float side = p.y < 0 ? -1.0f : 1.0f;
    return (warped){{(b > 0 ? d : a), p.z, 0},
                    {by_a * c + by_b * s, 0, 0},
                    {side * (by_a * s - by_b * c), 0, 0},
                    {0, 1.0f, 0}};
}

/* One comparison, since gcc makes no vectors of choices by two: differences are above 0 just where
 * their numbers are apart that way. */
static inline int is_between(float z, float low, float high)
{
    return smaller(z - low, high - z) > 0;
}

/* By `rate` per length between two heights; what is farther from the axis than `reach` is drawn
 * in. */
static inline warped turned(float rate, float low, float high, float reach, point p)
{
    float rho = sqrtf(p.x * p.x + p.y * p.y);
    int is_far = rho > reach;
    float inward = is_far ? reach / rho : 1.0f;
    float angle = -rate * smaller(larger(p.z, low), high);
    float c = inward * wave(angle, 1), s = inward * wave(angle, 0);
    float x = c * p.x - s * p.y, y = s * p.x + c * p.y;
    float turning = is_between(p.z, low, high) ? -rate : 0;
    float ux = is_far ? x / reach : 0, uy = is_far ? y / reach : 0; /* taken out of the columns */
    float first = ux * c + uy * s, second = uy * c - ux * s;
    return (warped){{x, y, p.z},
                    {c - first * ux, s - first * uy, 0},
                    {-s - second * ux, c - second * uy, 0},
                    {-turning * y, turning * x, 1.0f}};
}

static inline warped twist_at(const float *own, point p)
{
    return turned(own[CSG_TWIST_RATE], own[CSG_TWIST_LOW], own[CSG_TWIST_HIGH],
                  own[CSG_TWIST_REACH], p);
}

/* A twist of what was divided, by the chain rule. own[CSG_TAPER_X], [CSG_TAPER_Y]: what the scales
 * grow by per length (compile_warp.c). */
static inline warped taper_at(const float *own, point p)
{
    float low = own[CSG_TAPER_LOW], high = own[CSG_TAPER_HIGH];
    float grow_x = own[CSG_TAPER_X], grow_y = own[CSG_TAPER_Y];
    float z = smaller(larger(p.z, low), high) - low;
    float per_x = 1.0f / (1.0f + grow_x * z), per_y = 1.0f / (1.0f + grow_y * z);
    float u = p.x * per_x, w = p.y * per_y;
    float less_u = is_between(p.z, low, high) ? u * grow_x * per_x : 0,
          less_w = is_between(p.z, low, high) ? w * grow_y * per_y : 0;
    warped of = turned(own[CSG_TAPER_RATE], low, high, own[CSG_TAPER_REACH], (point){u, w, p.z});
    return (warped){of.at,
                    {of.dx.x * per_x, of.dx.y * per_x, 0},
                    {of.dy.x * per_y, of.dy.y * per_y, 0},
                    {of.dz.x - (of.dx.x * less_u + of.dy.x * less_w),
                     of.dz.y - (of.dx.y * less_u + of.dy.y * less_w), 1.0f}};
}

static inline warped bend_at(const float *own, point p)
{
    float radius = own[CSG_BEND_RADIUS], nearest = own[CSG_BEND_NEAREST];
    float most = own[CSG_BEND_ANGLE];
    float across = radius - p.z, s = sqrtf(p.x * p.x + across * across);
    float phi = angle_of(p.x, across);
    float sin_phi = quotient(p.x, s), cos_phi = quotient(across, s);
    float back = most / (HALF_TURN - most);
    int is_behind = absolute(phi) > most, is_near = s < nearest;
    float turned = is_behind ? sign_of(phi) * back * larger(HALF_TURN - absolute(phi), 0) : phi;
    float slope = is_behind ? -back : 1.0f;
    float shrink = is_near ? s / nearest : 1.0f;
    float around = radius * slope * (is_near ? 1.0f / nearest : quotient(1.0f, s));
    float outward = is_near ? radius * turned / nearest : 0;
    return (warped){{radius * turned * shrink, p.y, radius - s},
                    {around * cos_phi + outward * sin_phi, 0, -sin_phi},
                    {0, 1.0f, 0},
                    {around * sin_phi - outward * cos_phi, 0, cos_phi}};
}

/* Local copies of the parameters: the compiler then knows that no store changes them. */
#define LOOPS(name)                                                                                \
    static void name##_points(const csg_tape_warp *warp, float *restrict x, float *restrict y,     \
                              float *restrict z, size_t count)                                     \
    {                                                                                              \
        float own[CSG_WARP_PARAMETERS], m[12];                                                     \
        memcpy(own, warp->own, sizeof own);                                                        \
        memcpy(m, warp->frame, sizeof m);                                                          \
        for (size_t i = 0; i < count; i++) {                                                       \
            point at = name##_at(own, row_point(m, x[i], y[i], z[i])).at;                          \
            x[i] = at.x;                                                                           \
            y[i] = at.y;                                                                           \
            z[i] = at.z;                                                                           \
        }                                                                                          \
    }                                                                                              \
    static void name##_slopes(const csg_tape_warp *warp, const float *restrict x,                  \
                              const float *restrict y, const float *restrict z, size_t count,      \
                              float(*restrict column)[CSG_BATCH])                                  \
    {                                                                                              \
        float own[CSG_WARP_PARAMETERS], m[12];                                                     \
        memcpy(own, warp->own, sizeof own);                                                        \
        memcpy(m, warp->frame, sizeof m);                                                          \
        for (size_t i = 0; i < count; i++) {                                                       \
            warped w = name##_at(own, row_point(m, x[i], y[i], z[i]));                             \
            column[0][i] = w.dx.x, column[1][i] = w.dx.y, column[2][i] = w.dx.z;                   \
            column[3][i] = w.dy.x, column[4][i] = w.dy.y, column[5][i] = w.dy.z;                   \
            column[6][i] = w.dz.x, column[7][i] = w.dz.y, column[8][i] = w.dz.z;                   \
        }                                                                                          \
    }
#define CSG_WARP(NAME, name, ...) LOOPS(name)
#include "scene/primitives/warps.def"

static void warp_points(const csg_tape_warp *warp, float *x, float *y, float *z, size_t count)
{
    switch (warp->kind) {
#define CSG_WARP(NAME, name, ...)                                                                  \
    case CSG_WARP_##NAME:                                                                          \
        name##_points(warp, x, y, z, count);                                                       \
        break;
#include "scene/primitives/warps.def"
    }
}

static void warp_slopes(const csg_tape_warp *warp, const float *x, const float *y, const float *z,
                        size_t count, float (*column)[CSG_BATCH])
{
    switch (warp->kind) {
#define CSG_WARP(NAME, name, ...)                                                                  \
    case CSG_WARP_##NAME:                                                                          \
        name##_slopes(warp, x, y, z, count, column);                                               \
        break;
#include "scene/primitives/warps.def"
    }
}

/* By the chain rule. */
static void lead_out(const csg_tape_warp *warp, const float (*restrict column)[CSG_BATCH],
                     size_t count, float *restrict gx, float *restrict gy, float *restrict gz)
{
    float m[12];
    memcpy(m, warp->frame, sizeof m);
    for (size_t i = 0; i < count; i++) {
        float a = column[0][i] * gx[i] + column[1][i] * gy[i] + column[2][i] * gz[i];
        float b = column[3][i] * gx[i] + column[4][i] * gy[i] + column[5][i] * gz[i];
        float c = column[6][i] * gx[i] + column[7][i] * gy[i] + column[8][i] * gz[i];
        gx[i] = m[0] * a + m[3] * b + m[6] * c;
        gy[i] = m[1] * a + m[4] * b + m[7] * c;
        gz[i] = m[2] * a + m[5] * b + m[8] * c;
    }
}

/* The warps on the way to number `warp`, outermost first; returns how many. */
static int way_to(const csg_tape *tape, uint32_t warp, const csg_tape_warp *way[CSG_MOST_WARPS])
{
    int count = 0;
    for (uint32_t w = warp; w; w = tape->warps[w - 1].outer)
        count++;
    int place = count;
    for (uint32_t w = warp; w; w = tape->warps[w - 1].outer)
        way[--place] = &tape->warps[w - 1];
    return count;
}

static void points_of_way(const csg_tape *tape, uint32_t warp, float *x, float *y, float *z,
                          size_t count)
{
    const csg_tape_warp *way[CSG_MOST_WARPS];
    int length = way_to(tape, warp, way);
    for (int i = 0; i < length; i++)
        warp_points(way[i], x, y, z, count);
}

/* From the innermost warp outwards, each at the points as they come to it. */
static void gradients_of_way(const csg_tape *tape, uint32_t warp, const float *x, const float *y,
                             const float *z, size_t count, float *gx, float *gy, float *gz,
                             csg_warp_slopes *kept)
{
    const csg_tape_warp *way[CSG_MOST_WARPS];
    float px[CSG_BATCH], py[CSG_BATCH], pz[CSG_BATCH];
    int length = way_to(tape, warp, way);
    if (kept->warp == warp) {
        lead_out(way[0], (const float(*)[CSG_BATCH])kept->column, count, gx, gy, gz);
        return;
    }
    for (int i = length - 1; i >= 0; i--) {
        memcpy(px, x, count * sizeof *px);
        memcpy(py, y, count * sizeof *py);
        memcpy(pz, z, count * sizeof *pz);
        for (int k = 0; k < i; k++)
            warp_points(way[k], px, py, pz, count);
        warp_slopes(way[i], px, py, pz, count, kept->column);
        lead_out(way[i], (const float(*)[CSG_BATCH])kept->column, count, gx, gy, gz);
    }
    kept->warp = length == 1 ? warp : 0;
}

const csg_warp_kernel CSG_THIS_WARP_KERNEL = {
    .points = points_of_way,
    .gradients = gradients_of_way,
};
