/* SPDX-License-Identifier: MIT
 * Raw offset loops (offset_loops.h), as ClipperOffset of Clipper 6 makes them: at a corner that the
 * offset opens an arc, a tip or a chamfer, at one that it closes a detour through the corner.
 */
#include "shape/plane/offset_loops.h"

#include <math.h>

#include "base/elementary.h"

typedef struct corner_at {
    double x, y;   /* the corner */
    double ax, ay; /* normals of the edges before and after, `by` long */
    double bx, by;
} corner_at;

static bool round_off(const corner_at *c, double angle, double turn, csg_offset_sink sink)
{
    double steps = fmin(floor(fabs(angle) / turn), 1e7), cosine = csg_cos(turn),
           sine = angle < 0 ? -csg_sin(turn) : csg_sin(turn), x = c->ax, y = c->ay;
    for (double k = 0; k < steps; k++) {
        double next_x = x * cosine - y * sine;
        y = x * sine + y * cosine;
        x = next_x;
        if (!sink.add(sink.user, c->x + x, c->y + y))
            return false;
    }
    return true;
}

static bool add_corner(const corner_at *c, double by, csg_corner corner, double turn,
                       csg_offset_sink sink)
{
    double cross = c->ax * c->by - c->ay * c->bx, dot = c->ax * c->bx + c->ay * c->by;
    double size = by * by, opening = 1 + dot / size;
    if (!sink.add(sink.user, c->x + c->ax, c->y + c->ay))
        return false;
    if (cross * by < 0) {
        if (!sink.add(sink.user, c->x, c->y))
            return false;
    } else if (corner == CSG_CORNER_ROUND) {
        if (!round_off(c, csg_atan2(cross, dot), turn, sink))
            return false;
    } else if (corner == CSG_CORNER_MITER && opening > 1e-12) {
        return sink.add(sink.user, c->x + (c->ax + c->bx) / opening,
                        c->y + (c->ay + c->by) / opening);
    }
    return sink.add(sink.user, c->x + c->bx, c->y + c->by);
}

/* `by` long, to the right of the way from a to b; false where there is none. */
static bool normal_of(csg_clipper_point a, csg_clipper_point b, double by, double *x, double *y)
{
    double dx = (double)(b.x - a.x), dy = (double)(b.y - a.y), length = sqrt(dx * dx + dy * dy);
    if (length == 0)
        return false;
    *x = by * dy / length;
    *y = -by * dx / length;
    return true;
}

bool csg_offset_loops(const csg_clipper_loops *loops, double by, csg_corner corner, double turn,
                      csg_offset_sink sink)
{
    for (size_t loop = 0, i = 0; loop < loops->loop_count; loop++) {
        size_t first = i, end = loops->ends[loop];
        for (; i < end; i++) {
            csg_clipper_point before = loops->points[i > first ? i - 1 : end - 1],
                              at = loops->points[i],
                              after = loops->points[i + 1 < end ? i + 1 : first];
            corner_at c = {.x = (double)at.x, .y = (double)at.y};
            if (normal_of(before, at, by, &c.ax, &c.ay) && normal_of(at, after, by, &c.bx, &c.by) &&
                !add_corner(&c, by, corner, turn, sink))
                return false;
        }
        sink.close(sink.user);
    }
    return true;
}
