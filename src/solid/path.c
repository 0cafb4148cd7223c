/* SPDX-License-Identifier: MIT
 * Polylines with mitred or round corners, and curves through points as chains of arcs; see path.h.
 *
 * Smooth paths are biarcs: two arcs from one point to the next that share a tangent halfway (K. M.
 * Bolton, Biarc curves, CAD 7 (1975), with equal lengths of the tangents, in space as in the
 * plane). The tangent at a point is that of the circle through it and its two neighbours, so points
 * on a circle give that circle. An end without a neighbour is that of one arc.
 */
#include "solid/path.h"

#include <stdint.h>

#include "base/elementary.h"
#include "solid/facets.h"

#define SAME 1e-9   /* of the path's size: two points are one */
#define LEAST 1e-10 /* sine of an angle that is none */
/* Arcs of a radius above so many times their chord are lines, off by less than 1.3e-4 of it: the
 * floats in which they are evaluated count from their centre. */
#define FLATTEST 1000.0
#define STEEPEST 0.9999999 /* cosine: path and `up` are one direction */

static double in_degrees(double radians)
{
    return radians * (180 / csg_acos(-1));
}

/* ---- frames ---------------------------------------------------------------------------------- */

/* By the smallest rotation that takes the tangent to `to`; both have length 1. */
static csg_path_frame carried(csg_path_frame f, csg_vec3 at, csg_vec3 to)
{
    csg_vec3 axis = csg_vec3_cross(f.tangent, to);
    double c = csg_vec3_dot(f.tangent, to), shrink = 1 / (1 + c);
    csg_vec3 across = csg_vec3_cross(axis, f.y);
    csg_vec3 y = csg_vec3_add(csg_vec3_add(csg_vec3_scale(f.y, c), across),
                              csg_vec3_scale(axis, csg_vec3_dot(axis, f.y) * shrink));
    csg_vec3 x = csg_vec3_normalize(csg_vec3_cross(y, to));
    return (csg_path_frame){at, x, csg_vec3_cross(to, x), to};
}

static csg_path_frame turned(csg_path_frame f, double degrees)
{
    double c = csg_cosine_deg(degrees), s = csg_sine_deg(degrees);
    csg_vec3 x = csg_vec3_add(csg_vec3_scale(f.x, c), csg_vec3_scale(f.y, s));
    f.y = csg_vec3_sub(csg_vec3_scale(f.y, c), csg_vec3_scale(f.x, s));
    f.x = x;
    return f;
}

/* y as near to `up` as it can be; where the tangent runs along it, as near to the y axis, or x. */
static csg_path_frame upright(csg_vec3 at, csg_vec3 tangent, csg_vec3 up)
{
    const csg_vec3 others[3] = {up, {0, 1, 0}, {1, 0, 0}};
    csg_vec3 x = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        csg_vec3 to = csg_vec3_normalize(others[i]);
        if (fabs(csg_vec3_dot(to, tangent)) > STEEPEST)
            continue;
        x = csg_vec3_normalize(csg_vec3_cross(to, tangent));
        break;
    }
    return (csg_path_frame){at, x, csg_vec3_cross(tangent, x), tangent};
}

/* Counter-clockwise from one frame to another of the same tangent. */
static double angle_between(const csg_path_frame *from, const csg_path_frame *to)
{
    double angle =
        in_degrees(csg_atan2(csg_vec3_dot(from->y, to->x), csg_vec3_dot(from->x, to->x)));
    return fabs(angle) < 1e-9 ? 0 : angle;
}

/* ---- pieces ---------------------------------------------------------------------------------- */

typedef struct tracing {
    csg_path *path;
    const csg_path_shape *shape;
    csg_path_finding *found;
    csg_vec3 at; /* where the last piece ended */
} tracing;

static bool fail(tracing *t, csg_path_fault fault, uint32_t at, uint32_t other, double needed,
                 double there)
{
    *t->found = (csg_path_finding){fault, at, other, needed, there};
    return false;
}

/* Frames follow when all is there (set_frames); of them only tangents are set. */
static bool add_piece(tracing *t, csg_path_piece piece)
{
    csg_path *path = t->path;
    if (!csg_memory_reserve(path->memory, (void **)&path->pieces, &path->capacity, path->count + 1,
                            sizeof piece))
        return fail(t, CSG_PATH_NO_MEMORY, 0, 0, 0, 0);
    path->pieces[path->count++] = piece;
    t->at = piece.end.at;
    return true;
}

static bool line_to(tracing *t, csg_vec3 to, uint32_t from)
{
    csg_vec3 way = csg_vec3_sub(to, t->at), along = csg_vec3_normalize(way);
    return add_piece(t, (csg_path_piece){.start = {.at = t->at, .tangent = along},
                                         .end = {.at = to, .tangent = along},
                                         .length = csg_vec3_norm(way),
                                         .from = from});
}

/* An arc in the plane of tangent and inward, from its start on. */
static bool add_arc(tracing *t, csg_vec3 tangent, csg_vec3 inward, double radius, double angle,
                    uint32_t from)
{
    double c = csg_cosine_deg(angle), s = csg_sine_deg(angle);
    csg_vec3 to =
        csg_vec3_add(csg_vec3_scale(tangent, radius * s), csg_vec3_scale(inward, radius * (1 - c)));
    csg_vec3 turns = csg_vec3_add(csg_vec3_scale(tangent, c), csg_vec3_scale(inward, s));
    return add_piece(t, (csg_path_piece){.start = {.at = t->at, .tangent = tangent},
                                         .end = {.at = csg_vec3_add(t->at, to), .tangent = turns},
                                         .length = radius * angle / in_degrees(1),
                                         .radius = radius,
                                         .angle = angle,
                                         .inward = inward,
                                         .from = from});
}

/* From where the path is, with this tangent, to a point: one arc, in quarters. */
static bool arc_to(tracing *t, csg_vec3 tangent, csg_vec3 to, uint32_t from)
{
    csg_vec3 chord = csg_vec3_sub(to, t->at);
    double along = csg_vec3_dot(chord, tangent), length = csg_vec3_norm(chord);
    csg_vec3 across = csg_vec3_sub(chord, csg_vec3_scale(tangent, along));
    double rise = csg_vec3_norm(across), radius = length * length / (2 * rise);
    if (!(radius < FLATTEST * length))
        return line_to(t, to, from);
    csg_vec3 inward = csg_vec3_scale(across, 1 / rise);
    double angle = 2 * in_degrees(csg_atan2(rise, along));
    int parts = (int)fmax(ceil(angle / 90 - 1e-9), 1);
    bool ok = true;
    for (int i = 0; i < parts && ok; i++) {
        ok = add_arc(t, tangent, inward, radius, angle / parts, from);
        if (!ok)
            break;
        const csg_path_piece *last = &t->path->pieces[t->path->count - 1];
        tangent = last->end.tangent;
        csg_vec3 center = csg_vec3_add(last->start.at, csg_vec3_scale(inward, radius));
        inward = csg_vec3_normalize(csg_vec3_sub(center, last->end.at));
    }
    if (ok) /* where it was computed to end and where it shall differ by rounding */
        t->at = t->path->pieces[t->path->count - 1].end.at = to;
    return ok;
}

/* ---- polylines ------------------------------------------------------------------------------- */

static csg_vec3 point_at(const csg_path_shape *s, int64_t i)
{
    return s->points[(i + s->count) % s->count];
}

static csg_vec3 direction(const csg_path_shape *s, int64_t i)
{
    return csg_vec3_normalize(csg_vec3_sub(point_at(s, i + 1), point_at(s, i)));
}

/* How far before and behind point i an arc of the radius begins and ends; 0 at an end. */
static double arc_reach(const csg_path_shape *s, int64_t i)
{
    if (!s->closed && (i == 0 || i + 1 == s->count))
        return 0;
    csg_vec3 in = direction(s, i - 1), out = direction(s, i);
    double half = csg_atan2(csg_vec3_norm(csg_vec3_cross(in, out)), csg_vec3_dot(in, out)) / 2;
    return s->round * csg_tan(half);
}

static bool add_polyline(tracing *t)
{
    const csg_path_shape *s = t->shape;
    uint32_t edges = s->closed ? s->count : s->count - 1;
    csg_vec3 ahead = direction(s, 0);
    t->at = csg_vec3_add(s->points[0], csg_vec3_scale(ahead, s->closed ? arc_reach(s, 0) : 0));
    for (uint32_t i = 0; i < edges; i++) {
        uint32_t next = (i + 1) % s->count;
        double here = arc_reach(s, i), there = arc_reach(s, next);
        csg_vec3 along = direction(s, i), to = s->points[next];
        double length = csg_vec3_norm(csg_vec3_sub(to, s->points[i]));
        if (here + there > length * (1 + SAME))
            return fail(t, CSG_PATH_BENDS_MEET, i, next, here + there, length);
        bool is_line = length - here - there > SAME * length;
        if (is_line && !line_to(t, csg_vec3_sub(to, csg_vec3_scale(along, there)), i))
            return false;
        csg_vec3 after = direction(s, next);
        if (there > SAME * length &&
            !arc_to(t, along, csg_vec3_add(to, csg_vec3_scale(after, there)), next))
            return false;
    }
    return true;
}

/* ---- curves through points ------------------------------------------------------------------- */

/* Of the circle through point i and its neighbours: chords by the other one's length. */
static csg_vec3 circle_tangent(const csg_path_shape *s, int64_t i)
{
    csg_vec3 in = csg_vec3_sub(point_at(s, i), point_at(s, i - 1));
    csg_vec3 out = csg_vec3_sub(point_at(s, i + 1), point_at(s, i));
    double before = csg_vec3_norm(in), after = csg_vec3_norm(out);
    return csg_vec3_normalize(
        csg_vec3_add(csg_vec3_scale(in, after / before), csg_vec3_scale(out, before / after)));
}

/* The tangent at the other end of an arc with this chord. */
static csg_vec3 mirrored(csg_vec3 tangent, csg_vec3 chord)
{
    double by = 2 * csg_vec3_dot(tangent, chord) / csg_vec3_dot(chord, chord);
    return csg_vec3_normalize(csg_vec3_sub(csg_vec3_scale(chord, by), tangent));
}

static csg_vec3 smooth_tangent(const csg_path_shape *s, int64_t i)
{
    bool first = !s->closed && i == 0, last = !s->closed && i + 1 == s->count;
    if (!first && !last)
        return circle_tangent(s, i);
    if (s->count == 2)
        return direction(s, 0);
    return first ? mirrored(circle_tangent(s, 1), csg_vec3_sub(s->points[1], s->points[0]))
                 : mirrored(circle_tangent(s, i - 1), csg_vec3_sub(s->points[i], s->points[i - 1]));
}

/* Two arcs whose tangents are equally long: from |q2 - q1| = 2 d with q1 = p1 + d t1 and
 * q2 = p2 - d t2 follows 2 (1 - t1.t2) d^2 + 2 v.(t1 + t2) d - v.v = 0, where v = p2 - p1, whose
 * positive solution is this; it divides by 0 nowhere but for tangents that both point straight
 * back, which are no tangents of circles through the neighbours. */
static bool biarc_to(tracing *t, csg_vec3 first, csg_vec3 second, csg_vec3 to, uint32_t from)
{
    csg_vec3 way = csg_vec3_sub(to, t->at);
    double b = csg_vec3_dot(way, csg_vec3_add(first, second)), square = csg_vec3_dot(way, way);
    double a = 2 * (1 - csg_vec3_dot(first, second));
    double d = square / (b + sqrt(b * b + a * square));
    csg_vec3 one = csg_vec3_add(t->at, csg_vec3_scale(first, d));
    csg_vec3 two = csg_vec3_sub(to, csg_vec3_scale(second, d));
    csg_vec3 middle = csg_vec3_scale(csg_vec3_add(one, two), 0.5);
    csg_vec3 tangent = csg_vec3_normalize(csg_vec3_sub(two, one));
    return arc_to(t, first, middle, from) && arc_to(t, tangent, to, from);
}

static bool add_curve(tracing *t)
{
    const csg_path_shape *s = t->shape;
    uint32_t edges = s->closed ? s->count : s->count - 1;
    bool ok = true;
    t->at = s->points[0];
    for (uint32_t i = 0; i < edges && ok; i++) {
        uint32_t next = (i + 1) % s->count;
        csg_vec3 first = smooth_tangent(s, i), second = smooth_tangent(s, next);
        ok = biarc_to(t, first, second, s->points[next], i);
    }
    return ok;
}

/* ---- frames of all pieces -------------------------------------------------------------------- */

static void set_frames(tracing *t)
{
    csg_path *path = t->path;
    csg_path_piece *p = path->pieces;
    csg_path_frame f = upright(p[0].start.at, p[0].start.tangent, t->shape->up);
    for (size_t i = 0; i < path->count; i++) {
        f = carried(f, p[i].start.at, p[i].start.tangent);
        p[i].start = f;
        p[i].end = f = carried(f, p[i].end.at, p[i].end.tangent);
        f = turned(f, p[i].turn);
    }
}

/* What is left to turn from the last frame to the first of a closed path. */
static double angle_left(const csg_path *path)
{
    const csg_path_piece *last = &path->pieces[path->count - 1], *first = &path->pieces[0];
    csg_path_frame f =
        carried(turned(last->end, last->turn), first->start.at, first->start.tangent);
    return angle_between(&f, &first->start);
}

/* In proportion to the lengths: of a polyline along what is straight, since what turns along an arc
 * is no exact distance. */
static void turn_evenly(tracing *t, double angle)
{
    csg_path *path = t->path;
    double lines = 0, all = 0;
    for (size_t i = 0; i < path->count; i++) {
        all += path->pieces[i].length;
        lines += path->pieces[i].radius > 0 ? 0 : path->pieces[i].length;
    }
    bool lines_turn = !t->shape->smooth && lines > 0;
    for (size_t i = 0; i < path->count && angle != 0; i++)
        if (!lines_turn || path->pieces[i].radius == 0)
            path->pieces[i].turn += angle * path->pieces[i].length / (lines_turn ? lines : all);
}

/* Each piece turns by what the next one's start needs to be upright. */
static bool turn_upright(tracing *t)
{
    csg_path *path = t->path;
    csg_vec3 up = csg_vec3_normalize(t->shape->up);
    for (size_t i = 0; i < path->count; i++) {
        csg_path_piece *p = &path->pieces[i];
        if (fabs(csg_vec3_dot(p->start.tangent, up)) > STEEPEST ||
            fabs(csg_vec3_dot(p->end.tangent, up)) > STEEPEST)
            return fail(t, CSG_PATH_RUNS_UP, p->from, 0, 0, 0);
        size_t after = csg_path_after(path, i);
        csg_vec3 ahead = after == SIZE_MAX ? p->end.tangent : path->pieces[after].start.tangent;
        csg_path_frame to = upright(p->end.at, ahead, up);
        csg_path_frame from = upright(p->start.at, p->start.tangent, up);
        from = carried(carried(from, p->end.at, p->end.tangent), p->end.at, ahead);
        p->turn = angle_between(&from, &to);
    }
    return true;
}

/* ---- paths ----------------------------------------------------------------------------------- */

static bool check_points(tracing *t)
{
    const csg_path_shape *s = t->shape;
    csg_box box = csg_box_empty();
    for (uint32_t i = 0; i < s->count; i++)
        box = csg_box_hull(box, (csg_box){s->points[i], s->points[i]});
    double least = SAME * csg_vec3_norm(csg_box_size(box));
    for (uint32_t i = 0; i < s->count; i++) { /* the ends of an open path are apart, too */
        uint32_t next = (i + 1) % s->count;
        if (!(csg_vec3_norm(csg_vec3_sub(s->points[next], s->points[i])) > least))
            return fail(t, CSG_PATH_COINCIDES, next, i, 0, 0);
    }
    for (uint32_t i = 0; i < s->count; i++) {
        if (!s->closed && (i == 0 || i + 1 == s->count))
            continue;
        csg_vec3 in = direction(s, (int64_t)i - 1), out = direction(s, i);
        if (csg_vec3_dot(in, out) < 0 && csg_vec3_norm(csg_vec3_cross(in, out)) < 1e-6)
            return fail(t, CSG_PATH_TURNS_BACK, i, 0, 0, 0);
    }
    return true;
}

bool csg_path_make(csg_path *path, csg_memory *memory, const csg_path_shape *shape,
                   csg_path_finding *found)
{
    *path = (csg_path){.memory = memory, .closed = shape->closed};
    *found = (csg_path_finding){.fault = CSG_PATH_SOUND};
    tracing t = {.path = path, .shape = shape, .found = found};
    if (!check_points(&t) || !(shape->smooth ? add_curve(&t) : add_polyline(&t)))
        return false;
    if (shape->upright && !turn_upright(&t))
        return false;
    set_frames(&t);
    if (path->closed)
        turn_evenly(&t, angle_left(path));
    turn_evenly(&t, -shape->twist);
    set_frames(&t);
    return true;
}

void csg_path_release(csg_path *path)
{
    csg_memory_release(path->memory, path->pieces, path->capacity * sizeof *path->pieces);
    *path = (csg_path){.memory = path->memory};
}

size_t csg_path_before(const csg_path *path, size_t i)
{
    return i > 0 ? i - 1 : path->closed ? path->count - 1 : SIZE_MAX;
}

size_t csg_path_after(const csg_path *path, size_t i)
{
    return i + 1 < path->count ? i + 1 : path->closed ? 0 : SIZE_MAX;
}

bool csg_path_is_corner(const csg_path *path, size_t i)
{
    size_t before = csg_path_before(path, i);
    if (before == SIZE_MAX)
        return false;
    csg_vec3 in = path->pieces[before].end.tangent, out = path->pieces[i].start.tangent;
    return csg_vec3_norm(csg_vec3_cross(in, out)) > LEAST;
}

csg_vec3 csg_path_joint(const csg_path *path, size_t i)
{
    size_t before = csg_path_before(path, i);
    csg_vec3 out = path->pieces[i].start.tangent;
    return before == SIZE_MAX
               ? out
               : csg_vec3_normalize(csg_vec3_add(path->pieces[before].end.tangent, out));
}
