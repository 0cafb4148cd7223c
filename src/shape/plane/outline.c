/* SPDX-License-Identifier: MIT
 * Growable loops of points and flat pieces of curves; see outline.h.
 *
 * A curve with second derivative at most M, cut into n pieces of equal parameter, strays from its
 * chords by at most M / (8 n^2). Numbers of pieces are bounded, so that no tolerance, however small
 * or wrong (NaN), makes more than MOST_PIECES points of one curve.
 */
#include "shape/plane/outline.h"

#include <string.h>

#include "base/elementary.h"

enum { MOST_PIECES = 4096 };

void csg_outline_init(csg_outline *outline, csg_memory *memory)
{
    *outline = (csg_outline){.memory = memory};
}

void csg_outline_release(csg_outline *outline)
{
    if (!outline->memory)
        return;
    csg_memory_release(outline->memory, outline->points,
                       outline->point_capacity * sizeof *outline->points);
    csg_memory_release(outline->memory, outline->ends,
                       outline->loop_capacity * sizeof *outline->ends);
    csg_outline_init(outline, outline->memory);
}

static bool reserve_points(csg_outline *outline, size_t needed)
{
    if (needed > UINT32_MAX) /* ends are 32 bits */
        return false;
    void *points = outline->points;
    if (!csg_memory_reserve(outline->memory, &points, &outline->point_capacity, needed,
                            sizeof *outline->points))
        return false;
    outline->points = points;
    return true;
}

static bool reserve_loops(csg_outline *outline, size_t needed)
{
    void *ends = outline->ends;
    if (!csg_memory_reserve(outline->memory, &ends, &outline->loop_capacity, needed,
                            sizeof *outline->ends))
        return false;
    outline->ends = ends;
    return true;
}

static bool is_same(csg_vec2 a, csg_vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

/* Where the open loop begins. */
static size_t open_first(const csg_outline *outline)
{
    return csg_outline_first(outline, outline->loop_count);
}

bool csg_outline_add(csg_outline *outline, csg_vec2 point)
{
    if (outline->point_count > open_first(outline) &&
        is_same(outline->points[outline->point_count - 1], point))
        return true; /* curves end where the next begins */
    if (!reserve_points(outline, outline->point_count + 1))
        return false;
    outline->points[outline->point_count++] = point;
    return true;
}

bool csg_outline_close(csg_outline *outline)
{
    size_t first = open_first(outline);
    while (outline->point_count > first + 1 &&
           is_same(outline->points[outline->point_count - 1], outline->points[first]))
        outline->point_count--;
    if (outline->point_count < first + 3) {
        outline->point_count = first;
        return true;
    }
    if (!reserve_loops(outline, outline->loop_count + 1))
        return false;
    outline->ends[outline->loop_count++] = (uint32_t)outline->point_count;
    return true;
}

bool csg_outline_append(csg_outline *outline, const csg_outline *more)
{
    size_t closed = csg_outline_first(more, more->loop_count), first = open_first(outline);
    if (!closed)
        return true;
    if (!reserve_points(outline, outline->point_count + closed) ||
        !reserve_loops(outline, outline->loop_count + more->loop_count))
        return false;
    /* a loop that is open stays so, behind the new ones */
    memmove(outline->points + first + closed, outline->points + first,
            (outline->point_count - first) * sizeof *outline->points);
    memcpy(outline->points + first, more->points, closed * sizeof *outline->points);
    outline->point_count += closed;
    for (size_t loop = 0; loop < more->loop_count; loop++)
        outline->ends[outline->loop_count + loop] = (uint32_t)(first + more->ends[loop]);
    outline->loop_count += more->loop_count;
    return true;
}

void csg_outline_transform(csg_outline *outline, const csg_affine *map)
{
    for (size_t i = 0; i < outline->point_count; i++) {
        csg_vec2 p = outline->points[i];
        outline->points[i].x = map->m[0][0] * p.x + map->m[0][1] * p.y + map->t[0];
        outline->points[i].y = map->m[1][0] * p.x + map->m[1][1] * p.y + map->t[1];
    }
}

csg_box csg_outline_box(const csg_outline *outline)
{
    if (!outline->point_count)
        return csg_box_empty();
    csg_box box = {{INFINITY, INFINITY, 0}, {-INFINITY, -INFINITY, 0}};
    for (size_t i = 0; i < outline->point_count; i++) {
        csg_vec2 p = outline->points[i];
        box.min.x = fmin(box.min.x, p.x);
        box.min.y = fmin(box.min.y, p.y);
        box.max.x = fmax(box.max.x, p.x);
        box.max.y = fmax(box.max.y, p.y);
    }
    return box;
}

/* ---- curves ------------------------------------------------------------------------------- */

static int pieces_of(double count)
{
    if (!(count > 1)) /* NaN too */
        return 1;
    return count < MOST_PIECES ? (int)ceil(count) : MOST_PIECES;
}

/* Quarter turns come out exact, and angles that differ by whole turns are the same point. */
static csg_vec2 on_circle(csg_vec2 center, double radius, double angle_deg)
{
    double turn = fmod(angle_deg, 360);
    if (turn < 0)
        turn += 360;
    double quarter = floor(turn / 90),
           rest = (turn - 90 * quarter) * (3.14159265358979323846 / 180);
    double c = rest == 0 ? 1 : csg_cos(rest), s = rest == 0 ? 0 : csg_sin(rest);
    double x = quarter == 1 ? -s : quarter == 2 ? -c : quarter == 3 ? s : c;
    double y = quarter == 1 ? c : quarter == 2 ? -s : quarter == 3 ? -c : s;
    return (csg_vec2){center.x + radius * x, center.y + radius * y};
}

bool csg_outline_arc(csg_outline *outline, csg_vec2 center, double radius, double from_deg,
                     double sweep_deg, double tolerance)
{
    /* sagitta radius (1 - cos(step / 2)); below 1e-7 the cosine would be 1 */
    double sagitta = fmin(fmax(tolerance / fabs(radius), 1e-7), 1);
    double step_deg = 2 * csg_acos(1 - sagitta) * (180 / 3.14159265358979323846);
    return csg_outline_arc_in_pieces(outline, center, radius, from_deg, sweep_deg,
                                     pieces_of(fabs(sweep_deg) / fmin(step_deg, 90)));
}

bool csg_outline_arc_in_pieces(csg_outline *outline, csg_vec2 center, double radius,
                               double from_deg, double sweep_deg, int pieces)
{
    for (int i = 1; i <= pieces; i++) {
        double angle = i < pieces ? from_deg + sweep_deg * i / pieces : from_deg + sweep_deg;
        if (!csg_outline_add(outline, on_circle(center, radius, angle)))
            return false;
    }
    return true;
}

static csg_vec2 mix(csg_vec2 a, csg_vec2 b, double t)
{
    return (csg_vec2){a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t};
}

/* |a - 2 b + c| */
static double bend(csg_vec2 a, csg_vec2 b, csg_vec2 c)
{
    return csg_hypot(a.x - 2 * b.x + c.x, a.y - 2 * b.y + c.y);
}

bool csg_outline_quadratic(csg_outline *outline, csg_vec2 from, csg_vec2 control, csg_vec2 to,
                           double tolerance)
{
    return csg_outline_quadratic_in_pieces(
        outline, from, control, to, pieces_of(sqrt(bend(from, control, to) / (4 * tolerance))));
}

bool csg_outline_quadratic_in_pieces(csg_outline *outline, csg_vec2 from, csg_vec2 control,
                                     csg_vec2 to, int pieces)
{
    for (int i = 1; i < pieces; i++) {
        double t = (double)i / pieces;
        if (!csg_outline_add(outline, mix(mix(from, control, t), mix(control, to, t), t)))
            return false;
    }
    return csg_outline_add(outline, to);
}

bool csg_outline_cubic(csg_outline *outline, csg_vec2 from, csg_vec2 control1, csg_vec2 control2,
                       csg_vec2 to, double tolerance)
{
    double most = fmax(bend(from, control1, control2), bend(control1, control2, to));
    return csg_outline_cubic_in_pieces(outline, from, control1, control2, to,
                                       pieces_of(sqrt(0.75 * most / tolerance)));
}

bool csg_outline_cubic_in_pieces(csg_outline *outline, csg_vec2 from, csg_vec2 control1,
                                 csg_vec2 control2, csg_vec2 to, int pieces)
{
    for (int i = 1; i < pieces; i++) {
        double t = (double)i / pieces;
        csg_vec2 middle = mix(control1, control2, t);
        csg_vec2 left = mix(mix(from, control1, t), middle, t);
        csg_vec2 right = mix(middle, mix(control2, to, t), t);
        if (!csg_outline_add(outline, mix(left, right, t)))
            return false;
    }
    return csg_outline_add(outline, to);
}
