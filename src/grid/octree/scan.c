/* SPDX-License-Identifier: MIT
 * Doubtful edges among samples; see scan.h.
 */
#include "grid/octree/scan.h"

#include <math.h>

/* Of the sum of |f| at an edge's ends, in spans: 1 for what crosses the edge itself, more for what
 * passes by it. */
static const float WIDEST = 1.4f;

/* Whether some value is near enough to zero for any edge. */
static bool comes_near(const float *f, size_t count, float limit)
{
    int near = 0;
    for (size_t i = 0; i < count; i++)
        near |= fabsf(f[i]) < limit;
    return near;
}

/* How doubtful the edge between b and c is, a and d being the line's next values: by how much they
 * are larger. 0: not at all. */
static float doubt_of(float a, float b, float c, float d, float widest)
{
    bool same = (a >= 0) == (b >= 0) && (b >= 0) == (c >= 0) && (c >= 0) == (d >= 0);
    float inner = fabsf(b) + fabsf(c), outer = fabsf(a) + fabsf(d);
    if (!same || inner > widest || fabsf(a) < 1.1f * fabsf(b) || fabsf(d) < 1.1f * fabsf(c) ||
        outer < 1.5f * inner)
        return 0;
    return 1 - inner / outer;
}

/* The same of an edge at the border of the samples, where the value before b is missing: |f| falls
 * from c on as it did from d to c, and would be less than nothing before it is at b. Less is known
 * than of other edges: half the doubt. */
static float doubt_at_border(float b, float c, float d, float widest)
{
    bool same = (b >= 0) == (c >= 0) && (c >= 0) == (d >= 0);
    float inner = fabsf(b) + fabsf(c), fall = fabsf(d) - fabsf(c);
    if (!same || inner > widest || fabsf(d) < 1.1f * fabsf(c) || inner >= fall)
        return 0;
    return 0.5f * (1 - inner / fall);
}

/* ---- a look at all edges along an axis ---------------------------------------------------------
 *
 * Nearly always none is doubtful, which is seen without a branch, in vectors. What is asked here is
 * part of what the functions above ask, so an edge that they doubt is never missed.
 */

/* Whether |f| falls to both ends of an edge between two others: `count` edges side by side, from
 * that between f[0] and f[step] on. */
static int some_fall(const float *f, size_t step, size_t count, float widest)
{
    const float *before = f - step, *next = f + step, *behind = f + 2 * step;
    int some = 0;
    for (size_t i = 0; i < count; i++) {
        float a = before[i], b = f[i], c = next[i], d = behind[i];
        int same = (a * b >= 0) & (b * c >= 0) & (c * d >= 0);
        some |= same & (fabsf(b) + fabsf(c) <= widest) & (fabsf(a) >= 1.1f * fabsf(b)) &
                (fabsf(d) >= 1.1f * fabsf(c));
    }
    return some;
}

/* The same of edges at the border, between b and c, d being the line's next value. */
static int some_fall_at_border(const float *b, const float *c, const float *d, size_t stride,
                               size_t count, float widest)
{
    int some = 0;
    for (size_t i = 0; i < count * stride; i += stride) {
        int same = (b[i] * c[i] >= 0) & (c[i] * d[i] >= 0);
        float inner = fabsf(b[i]) + fabsf(c[i]);
        some |= same & (inner <= widest) & (fabsf(d[i]) >= 1.1f * fabsf(c[i])) &
                (inner < fabsf(d[i]) - fabsf(c[i]));
    }
    return some;
}

/* Points are passed in runs of those that lie side by side and are as far along the axis: single
 * ones along x, lines of them along y, planes along z. */
static bool may_doubt(const float *f, size_t n, int axis, float widest)
{
    size_t step = axis == 0 ? 1 : axis == 1 ? n : n * n, last = (n - 1) * step;
    int some = 0;
    for (size_t begin = 0; begin < n * n * n && !some; begin += n * step) {
        const float *low = f + begin, *high = low + last;
        some = some_fall(low + step, step, (n - 3) * step, widest);
        if (axis > 0) {
            some |= some_fall_at_border(low, low + step, low + 2 * step, 1, step, widest);
            some |= some_fall_at_border(high, high - step, high - 2 * step, 1, step, widest);
        }
    }
    if (axis == 0) {
        const float *high = f + last;
        some |= some_fall_at_border(f, f + 1, f + 2, n, n * n, widest);
        some |= some_fall_at_border(high, high - 1, high - 2, n, n * n, widest);
    }
    return some;
}

/* ---- the most doubtful edge ------------------------------------------------------------------ */

static void scan_axis(csg_scan *scan, const float *f, size_t n, const uint32_t first[3],
                      uint8_t axis, float widest)
{
    const size_t steps[3] = {1, n, n * n};
    size_t step = steps[axis], across[2] = {steps[(axis + 1) % 3], steps[(axis + 2) % 3]};
    for (size_t line = 0; line < n * n; line++) {
        size_t u = line % n, v = line / n;
        const float *p = f + u * across[0] + v * across[1];
        for (size_t i = 0; i + 1 < n; i++) {
            const float *at = p + i * step;
            float doubt = i == 0 ? doubt_at_border(at[0], at[step], at[2 * step], widest)
                          : i + 2 == n
                              ? doubt_at_border(at[step], at[0], *(at - step), widest)
                              : doubt_of(*(at - step), at[0], at[step], at[2 * step], widest);
            scan->count += doubt > 0;
            if (!(doubt > scan->doubt))
                continue;
            scan->doubt = doubt;
            scan->axis = axis;
            scan->is_inside = at[0] >= 0;
            scan->point[axis] = first[axis] + (uint32_t)i;
            scan->point[(axis + 1) % 3] = first[(axis + 1) % 3] + (uint32_t)u;
            scan->point[(axis + 2) % 3] = first[(axis + 2) % 3] + (uint32_t)v;
        }
    }
}

void csg_scan_values(csg_scan *scan, const float *f, size_t n, const uint32_t first[3])
{
    float widest = WIDEST * scan->span;
    if (!comes_near(f, n * n * n, widest / 2))
        return;
    for (uint8_t axis = 0; axis < 3; axis++)
        if (may_doubt(f, n, axis, widest))
            scan_axis(scan, f, n, first, axis, widest);
}
