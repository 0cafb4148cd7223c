/* SPDX-License-Identifier: MIT
 * Strokes as a heap of simple loops: a rectangle per segment, a disc, kite or triangle per corner
 * and cap. What overlaps is left to the union of polygons.h. See polylines.h.
 */
#include "outline/polylines.h"

#include "base/elementary.h"

static csg_vec2 minus(csg_vec2 a, csg_vec2 b)
{
    return (csg_vec2){a.x - b.x, a.y - b.y};
}
static csg_vec2 along(csg_vec2 a, csg_vec2 direction, double by)
{
    return (csg_vec2){a.x + direction.x * by, a.y + direction.y * by};
}
static csg_vec2 unit(csg_vec2 a)
{
    double length = csg_hypot(a.x, a.y);
    return length > 0 ? (csg_vec2){a.x / length, a.y / length} : (csg_vec2){1, 0};
}
static csg_vec2 left_of(csg_vec2 a)
{
    return (csg_vec2){-a.y, a.x};
}

/* Counter-clockwise, whichever way the corners are given. */
static bool add_loop(csg_outline *out, const csg_vec2 *corners, size_t count)
{
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        csg_vec2 a = minus(corners[i], corners[0]), b = minus(corners[(i + 1) % count], corners[0]);
        area += a.x * b.y - b.x * a.y;
    }
    bool done = true;
    for (size_t i = 0; i < count && done; i++)
        done = csg_outline_add(out, corners[area < 0 ? count - 1 - i : i]);
    return done && csg_outline_close(out);
}

static bool add_disc(const csg_stroke *stroke, csg_vec2 center, csg_outline *out)
{
    return csg_outline_arc(out, center, stroke->width / 2, 0, 360, stroke->tolerance) &&
           csg_outline_close(out);
}

static bool add_segment(const csg_stroke *stroke, csg_vec2 from, csg_vec2 to, bool first, bool last,
                        csg_outline *out)
{
    double half = stroke->width / 2, square = stroke->cap == CSG_CAP_SQUARE ? half : 0;
    csg_vec2 forward = unit(minus(to, from)), left = left_of(forward);
    from = along(from, forward, first ? -square : 0);
    to = along(to, forward, last ? square : 0);
    csg_vec2 corners[4] = {along(from, left, half), along(from, left, -half),
                           along(to, left, -half), along(to, left, half)};
    return add_loop(out, corners, 4);
}

/* What fills the wedge at `corner` on the outer side of a turn. */
static bool add_join(const csg_stroke *stroke, csg_vec2 before, csg_vec2 corner, csg_vec2 after,
                     csg_outline *out)
{
    double half = stroke->width / 2;
    if (stroke->join == CSG_LINE_JOIN_ROUND)
        return add_disc(stroke, corner, out);
    csg_vec2 in = unit(minus(corner, before)), away = unit(minus(after, corner));
    double turn = in.x * away.y - in.y * away.x, outer = turn > 0 ? -half : half;
    double cosine = in.x * away.x + in.y * away.y;
    csg_vec2 a = along(corner, left_of(in), outer), b = along(corner, left_of(away), outer);
    /* 1 / sin(half the angle between the segments), squared */
    double miter = 2 / fmax(1 + cosine, 1e-12);
    if (stroke->join == CSG_LINE_JOIN_BEVEL || miter > stroke->miter_limit * stroke->miter_limit) {
        csg_vec2 corners[3] = {corner, a, b};
        return add_loop(out, corners, 3);
    }
    csg_vec2 tip = {(a.x + b.x) / 2 - corner.x, (a.y + b.y) / 2 - corner.y};
    csg_vec2 corners[4] = {corner, a, along(corner, tip, miter), b};
    return add_loop(out, corners, 4);
}

bool csg_stroke_line(const csg_stroke *stroke, const csg_vec2 *points, size_t count,
                     csg_outline *out)
{
    bool done = true;
    for (size_t i = 0; i + 1 < count && done; i++)
        done = add_segment(stroke, points[i], points[i + 1], i == 0, i + 2 == count, out);
    for (size_t i = 1; i + 1 < count && done; i++)
        done = add_join(stroke, points[i - 1], points[i], points[i + 1], out);
    if (stroke->cap == CSG_CAP_ROUND && count > 1)
        done = done && add_disc(stroke, points[0], out) && add_disc(stroke, points[count - 1], out);
    return done;
}
