/* SPDX-License-Identifier: MIT
 * Thinning out; see thin.h.
 */
#include "slice/thin.h"

#include <math.h>

/* Where so many points after each other cannot end a chord none behind them is tried. */
enum { MOST_MISSES = 16 };

typedef struct plane_vector {
    double x, y;
} plane_vector;

/* Directions from right to left, counter-clockwise, by less than half a turn. */
typedef struct direction_cone {
    plane_vector right, left;
    bool is_whole; /* any direction */
} direction_cone;

static double cross(plane_vector a, plane_vector b)
{
    return a.x * b.y - a.y * b.x;
}

static plane_vector between(const csg_slice_point *from, double x, double y)
{
    return (plane_vector){x - from->x, y - from->y};
}

static bool is_within(const direction_cone *c, plane_vector d)
{
    return c->is_whole || (cross(c->right, d) >= 0 && cross(d, c->left) >= 0 &&
                           d.x * (c->right.x + c->left.x) + d.y * (c->right.y + c->left.y) > 0);
}

/* False: no direction is left. */
static bool narrow(direction_cone *c, plane_vector right, plane_vector left)
{
    if (!(cross(right, left) > 0))
        return false;
    if (c->is_whole) {
        *c = (direction_cone){.right = right, .left = left};
        return true;
    }
    if (!(cross(c->right, left) > 0 && cross(right, c->left) > 0))
        return false;
    if (cross(c->right, right) > 0)
        c->right = right;
    if (cross(c->left, left) < 0)
        c->left = left;
    return cross(c->right, c->left) > 0;
}

/* To directions that pass the point within the distance, through its edge. */
static bool narrow_by(direction_cone *c, const csg_slice_point *from, const csg_slice_point *by,
                      double distance)
{
    plane_vector to = between(from, by->x, by->y);
    if (by->axis < 0) {
        double square = to.x * to.x + to.y * to.y - distance * distance;
        if (square <= 0)
            return true;
        double share = distance / sqrt(square);
        plane_vector side = {-to.y * share, to.x * share};
        return narrow(c, (plane_vector){to.x - side.x, to.y - side.y},
                      (plane_vector){to.x + side.x, to.y + side.y});
    }
    double at = by->axis ? by->y : by->x;
    double low = fmax(by->low, at - distance), high = fmin(by->high, at + distance);
    plane_vector a = by->axis ? between(from, by->x, low) : between(from, low, by->y);
    plane_vector b = by->axis ? between(from, by->x, high) : between(from, high, by->y);
    return cross(a, b) > 0 ? narrow(c, a, b) : narrow(c, b, a);
}

/* A corner, else the outermost point: where a contour has straight sides these meet there. */
static size_t first_of(const csg_slice_point *points, size_t count)
{
    size_t best = 0;
    for (size_t i = 0; i < count; i++) {
        const csg_slice_point *p = &points[i], *b = &points[best];
        bool is_corner = p->axis < 0, was = b->axis < 0;
        if (is_corner != was ? is_corner : p->x < b->x || (p->x == b->x && p->y < b->y))
            best = i;
    }
    return best;
}

/* Whether one chord can take the place of all points between two, counted from the first. */
static bool is_one_chord(const csg_slice_point *points, size_t count, size_t first, size_t from,
                         size_t to, double distance)
{
    const csg_slice_point *p = &points[(first + from) % count], *q = &points[(first + to) % count];
    direction_cone cone = {.is_whole = true};
    for (size_t i = from + 1; i < to; i++) {
        const csg_slice_point *by = &points[(first + i) % count];
        if (by->is_pinned || !narrow_by(&cone, p, by, distance))
            return false;
    }
    return is_within(&cone, between(p, q->x, q->y));
}

static size_t next_kept(const csg_slice_point *points, size_t count, size_t first, size_t from)
{
    do
        from++;
    while (from < count && !points[(first + from) % count].stays);
    return from;
}

/* The pass cannot know where a chord had better end: points that can go alone. The first stays.
 * Returns how many went. */
static size_t drop_single(csg_slice_point *points, size_t count, size_t first, double distance)
{
    size_t gone = 0, from = 0, middle = next_kept(points, count, first, 0);
    while (middle < count) {
        size_t to = next_kept(points, count, first, middle);
        if (is_one_chord(points, count, first, from, to, distance)) {
            points[(first + middle) % count].stays = false;
            gone++;
        } else {
            from = middle;
        }
        middle = to;
    }
    return gone;
}

size_t csg_slice_thin(csg_slice_point *points, size_t count, double distance)
{
    size_t kept = 0, first = first_of(points, count), from = 0;
    for (size_t i = 0; i < count; i++)
        points[i].stays = false;
    while (from < count) { /* counted from the first */
        const csg_slice_point *p = &points[(first + from) % count];
        direction_cone cone = {.is_whole = true};
        size_t reached = from + 1;
        points[(first + from) % count].stays = true;
        kept++;
        for (size_t next = from + 1; next <= count; next++) {
            const csg_slice_point *q = &points[(first + next) % count];
            if (is_within(&cone, between(p, q->x, q->y)))
                reached = next;
            bool is_over = q->is_pinned || next == count || next - reached > MOST_MISSES;
            if (is_over || !narrow_by(&cone, p, q, distance))
                break;
        }
        from = reached;
    }
    kept -= kept > 3 ? drop_single(points, count, first, distance) : 0;
    for (size_t i = 0; i < count && kept < 3; i++)
        points[i].stays = true;
    return kept < 3 ? count : kept;
}
