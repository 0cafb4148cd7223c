/* SPDX-License-Identifier: MIT
 * Sweeps along a path (path.h): a prism along each line, a revolution along each arc, cut where
 * they meet and united.
 *
 * Let A and B be two neighbours that go on beyond the plane P of their joint, g_A and g_B their
 * fields and h the distance from P, positive on the side of B. On P the figure is the same for both
 * (frames go from one to the other by the rotation that is also the reflection in P), so g_A = g_B
 * there. A cut at h <= 0 and B cut at h >= 0 have P as a wall on which the field is 0; what is in
 * both A and B is united with them. That adds nothing: on either side it lies in the piece that is
 * there. On P the field is g_A = g_B then, as if there were no joint. All of this is sharp unions
 * and intersections of fields with constant 1, so the sweep's constant is 1 as well (operators.md
 * 18); a piece that turns is a warp, whose field is divided by its own.
 *
 * Pieces meet without a cut where they have one tangent: an extrusion and a sector end there by
 * themselves. Inside, the field is no more than the way to the next joint but one. Paths that are
 * nothing but lines with arcs between them are better off: elbows, below.
 */
#include "solid/along.h"

#include <stdint.h>

#include "base/elementary.h"
#include "scene/outlines/unite.h"
#include "scene/warp_kinds.h"
#include "solid/facets.h"
#include "solid/measure.h"
#include "solid/operations.h"

typedef struct sweeping {
    csg_solid_job *job;
    const csg_path *path;
    csg_node_id flat;   /* copied for each piece */
    csg_outline figure; /* its corners, for what fits */
    double reach;       /* of the figure from the path */
} sweeping;

/* How far a piece must go on before its start and behind its end, so that it comes to the planes of
 * its joints everywhere, and between which lengths it is whole. */
typedef struct span {
    double before, behind;
    double low, high;
} span;

static csg_vec3 in_frame(const csg_path_frame *f, csg_vec2 p)
{
    return csg_vec3_add(csg_vec3_scale(f->x, p.x), csg_vec3_scale(f->y, p.y));
}

static csg_path_frame end_frame(const csg_path_piece *piece)
{
    csg_path_frame f = piece->end;
    double c = csg_cosine_deg(piece->turn), s = csg_sine_deg(piece->turn);
    csg_vec3 x = f.x;
    f.x = csg_vec3_add(csg_vec3_scale(x, c), csg_vec3_scale(f.y, s));
    f.y = csg_vec3_sub(csg_vec3_scale(f.y, c), csg_vec3_scale(x, s));
    return f;
}

/* Along the tangent, how far from the frame's origin the plane through it is at this point. */
static double way_to_plane(const csg_path_frame *f, csg_vec3 normal, csg_vec2 p)
{
    return -csg_vec3_dot(normal, in_frame(f, p)) / csg_vec3_dot(normal, f->tangent);
}

static csg_vec3 joint_after(const csg_path *path, size_t i)
{
    size_t after = csg_path_after(path, i);
    return after == SIZE_MAX ? path->pieces[i].end.tangent : csg_path_joint(path, after);
}

static bool is_corner_after(const csg_path *path, size_t i)
{
    size_t after = csg_path_after(path, i);
    return after != SIZE_MAX && csg_path_is_corner(path, after);
}

static span measure(const sweeping *s, size_t i)
{
    const csg_path_piece *piece = &s->path->pieces[i];
    /* a little more than the corners need, which lie within a circle; the planes cut it off */
    const double room = 1e-3 * s->reach;
    span out = {.low = 0, .high = piece->length};
    csg_path_frame end = end_frame(piece);
    csg_vec3 first = csg_path_joint(s->path, i), second = joint_after(s->path, i);
    bool begins = csg_path_is_corner(s->path, i), ends = is_corner_after(s->path, i);
    for (size_t k = 0; k < s->figure.point_count; k++) {
        csg_vec2 p = s->figure.points[k];
        double from = begins ? way_to_plane(&piece->start, first, p) : 0;
        double to = ends ? way_to_plane(&end, second, p) : 0;
        out.before = fmax(out.before, -from);
        out.behind = fmax(out.behind, to);
        out.low = fmax(out.low, from);
        out.high = fmin(out.high, piece->length + to);
    }
    out.before += begins ? room : 0;
    out.behind += ends ? room : 0;
    return out;
}

/* ---- what fits ------------------------------------------------------------------------------- */

static bool fail(csg_path_finding *found, csg_path_fault fault, const sweeping *s, size_t i,
                 double needed, double there)
{
    size_t after = csg_path_after(s->path, i);
    uint32_t at = s->path->pieces[i].from;
    *found = (csg_path_finding){fault, at, after == SIZE_MAX ? at + 1 : s->path->pieces[after].from,
                                needed, there};
    return false;
}

/* How far the figure reaches inwards at an arc; one that turns, all around. */
static double inward_reach(const sweeping *s, const csg_path_piece *piece)
{
    double reach = 0;
    if (piece->turn != 0)
        return s->reach;
    for (size_t k = 0; k < s->figure.point_count; k++)
        reach =
            fmax(reach, csg_vec3_dot(piece->inward, in_frame(&piece->start, s->figure.points[k])));
    return reach;
}

/* Both mitres of a line must leave something of it everywhere. */
static bool fits_line(const sweeping *s, size_t i, csg_path_finding *found)
{
    const csg_path_piece *piece = &s->path->pieces[i];
    csg_path_frame end = end_frame(piece);
    csg_vec3 first = csg_path_joint(s->path, i), second = joint_after(s->path, i);
    double most = 0;
    for (size_t k = 0; k < s->figure.point_count; k++) {
        csg_vec2 p = s->figure.points[k];
        most = fmax(most, way_to_plane(&piece->start, first, p) - way_to_plane(&end, second, p));
    }
    if (!(most <= piece->length * (1 + 1e-9)))
        return fail(found, CSG_PATH_TOO_SHORT, s, i, most, piece->length);
    span room = measure(s, i);
    if (piece->turn != 0 && !(room.high - room.low > 1e-3 * piece->length))
        return fail(found, CSG_PATH_CANNOT_TURN, s, i, piece->length - (room.high - room.low),
                    piece->length);
    return true;
}

static bool fits(const sweeping *s, csg_path_finding *found)
{
    for (size_t i = 0; i < s->path->count; i++) {
        const csg_path_piece *piece = &s->path->pieces[i];
        double reach = piece->radius > 0 ? inward_reach(s, piece) : 0;
        if (piece->radius > 0 && !(reach < piece->radius * (1 - 1e-6)))
            return fail(found, CSG_PATH_TOO_THICK, s, i, reach, piece->radius);
        /* nearer to the line about which it is bent, the field is a small part of the distance */
        if (piece->radius > 0 && piece->turn != 0 && !(reach <= piece->radius / 2))
            return fail(found, CSG_PATH_TURNS_THICK, s, i, reach, piece->radius);
        if (piece->radius == 0 && !fits_line(s, i, found))
            return false;
    }
    return true;
}

/* ---- pieces ---------------------------------------------------------------------------------- */

static csg_affine columns(csg_vec3 x, csg_vec3 y, csg_vec3 z, csg_vec3 t)
{
    return (csg_affine){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}, {t.x, t.y, t.z}};
}

static csg_node_id copied(sweeping *s)
{
    if (s->job->stop || !csg_solid_charge(s->job, 10))
        return CSG_NODE_NONE;
    return csg_solid_done(s->job, csg_build_copy(s->job->builder, s->flat));
}

/* The figure along z, turning where the piece is whole, `before` and `behind` longer. */
static csg_node_id prism(sweeping *s, const csg_path_piece *piece, span room, double before,
                         double behind)
{
    csg_solid_job *job = s->job;
    csg_node_id node = copied(s);
    const csg_warp twist = {
        .kind = CSG_WARP_TWIST,
        .parameters = {piece->turn / (room.high - room.low), room.low, room.high}};
    if (node != CSG_NODE_NONE && piece->turn != 0)
        node = csg_solid_done(job, csg_build_warp(job->builder, &twist, node, job->where));
    if (node == CSG_NODE_NONE)
        return node;
    return csg_solid_done(
        job, csg_build_extrude(job->builder, node, -before, piece->length + behind, job->where));
}

/* A prism that turns, bent: its middle comes to the origin, along x. */
static csg_node_id bent(sweeping *s, const csg_path_piece *piece, span room, double before,
                        double behind)
{
    csg_solid_job *job = s->job;
    const csg_path_frame *f = &piece->start;
    csg_vec3 out = csg_vec3_cross(piece->inward, f->tangent); /* y of the bend */
    csg_affine lie = {{{0, 0, 1},
                       {csg_vec3_dot(f->x, out), csg_vec3_dot(f->y, out), 0},
                       {csg_vec3_dot(f->x, piece->inward), csg_vec3_dot(f->y, piece->inward), 0}},
                      {-piece->length / 2, 0, 0}};
    double c = csg_cosine_deg(piece->angle / 2), sine = csg_sine_deg(piece->angle / 2);
    csg_vec3 along =
        csg_vec3_add(csg_vec3_scale(f->tangent, c), csg_vec3_scale(piece->inward, sine));
    csg_vec3 inward =
        csg_vec3_sub(csg_vec3_scale(piece->inward, c), csg_vec3_scale(f->tangent, sine));
    csg_vec3 center = csg_vec3_add(f->at, csg_vec3_scale(piece->inward, piece->radius));
    csg_affine place =
        columns(along, out, inward, csg_vec3_sub(center, csg_vec3_scale(inward, piece->radius)));
    const csg_warp bend = {.kind = CSG_WARP_BEND, .parameters = {piece->radius}};
    csg_node_id node = csg_solid_moved(job, prism(s, piece, room, before, behind), &lie);
    if (node == CSG_NODE_NONE)
        return node;
    node = csg_solid_done(job, csg_build_warp(job->builder, &bend, node, job->where));
    return csg_solid_moved(job, node, &place);
}

/* A sector of the revolution whose box is not that of the whole ring: cut farther away from the
 * surface than any place inside is from it. */
static csg_node_id boxed(sweeping *s, csg_node_id sector, double radius, double half_deg)
{
    csg_solid_job *job = s->job;
    double r = s->reach, out = radius + 2 * r;
    double wide = out * csg_sine_deg(half_deg) + r;
    double nearest = (radius - r) * csg_cosine_deg(half_deg) - r;
    csg_box box = {{nearest, -wide, -2 * r}, {out, wide, 2 * r}};
    if (sector == CSG_NODE_NONE)
        return sector;
    return csg_solid_done(job, csg_build_cut(job->builder, sector, box, job->where));
}

static csg_vec3 center_of(const csg_path_piece *arc)
{
    return csg_vec3_add(arc->start.at, csg_vec3_scale(arc->inward, arc->radius));
}

/* Where an arc's middle comes that lies on x: `middle` degrees behind its start. */
static csg_affine middle_of_arc(const csg_path_piece *arc, double middle)
{
    const csg_path_frame *f = &arc->start;
    csg_vec3 out = csg_vec3_scale(arc->inward, -1), axis = csg_vec3_cross(out, f->tangent);
    double c = csg_cosine_deg(middle), sine = csg_sine_deg(middle);
    csg_vec3 x = csg_vec3_add(csg_vec3_scale(out, c), csg_vec3_scale(f->tangent, sine));
    return columns(x, csg_vec3_cross(axis, x), axis, center_of(arc));
}

/* The figure as it stands where an arc begins: x away from the axis, y along it. */
static csg_node_id standing(sweeping *s, const csg_path_piece *arc)
{
    const csg_path_frame *f = &arc->start;
    csg_vec3 out = csg_vec3_scale(arc->inward, -1), axis = csg_vec3_cross(out, f->tangent);
    csg_affine stand = {{{csg_vec3_dot(f->x, out), csg_vec3_dot(f->y, out), 0},
                         {csg_vec3_dot(f->x, axis), csg_vec3_dot(f->y, axis), 0},
                         {0, 0, 1}},
                        {arc->radius, 0, 0}};
    return csg_solid_moved(s->job, copied(s), &stand);
}

/* The figure turned about the arc's axis; the middle of what is made lies on x. */
static csg_node_id sector(sweeping *s, const csg_path_piece *piece, double before, double behind)
{
    csg_solid_job *job = s->job;
    double half = (piece->angle + behind + before) / 2;
    csg_affine place = middle_of_arc(piece, (piece->angle + behind - before) / 2);
    csg_node_id node = standing(s, piece);
    if (node == CSG_NODE_NONE)
        return node;
    node = csg_solid_turn(job, node, 2 * half, -half);
    return csg_solid_moved(job, boxed(s, node, piece->radius, half), &place);
}

/* A piece that goes on by these lengths at both ends. */
static csg_node_id body(sweeping *s, size_t i, double before, double behind)
{
    const double most_deg = 80; /* then no sector is larger than 180 degrees: it is convex */
    const csg_path_piece *piece = &s->path->pieces[i];
    span room = measure(s, i);
    before += room.before;
    behind += room.behind;
    csg_affine place =
        columns(piece->start.x, piece->start.y, piece->start.tangent, piece->start.at);
    if (piece->radius == 0)
        return csg_solid_moved(s->job, prism(s, piece, room, before, behind), &place);
    double nearest = piece->radius - inward_reach(s, piece), degree = csg_acos(-1) / 180;
    before = fmin(before / (nearest * degree), most_deg);
    behind = fmin(behind / (nearest * degree), most_deg);
    if (piece->turn == 0)
        return sector(s, piece, before, behind);
    return bent(s, piece, room, before * degree * piece->radius, behind * degree * piece->radius);
}

/* ---- elbows ----------------------------------------------------------------------------------
 * Arcs about one axis between two lines, where the path has no corner: one body with both lines,
 * whole (CSG_WARP_ELBOW). Its field is the figure's own everywhere, and so is its distance. What
 * shares a line with the next elbow has the same field along it, and each ends at the far end of
 * it: no joint is needed, and the nearest wall is at least half the line away.
 */

typedef struct elbow {
    size_t before, first, last, behind; /* the lines, and the arcs between them */
    double angle;                       /* of all arcs */
} elbow;

static csg_vec3 axis_of(const csg_path_piece *arc)
{
    return csg_vec3_cross(arc->start.tangent, arc->inward);
}

static bool goes_on_about(const csg_path_piece *a, const csg_path_piece *b)
{
    static const double SAME = 1e-9;
    double apart = csg_vec3_norm(csg_vec3_sub(center_of(a), center_of(b)));
    double turned = csg_vec3_norm(csg_vec3_sub(axis_of(a), axis_of(b)));
    return apart <= SAME * a->radius && turned <= SAME &&
           fabs(a->radius - b->radius) <= SAME * a->radius;
}

/* Behind this line; false: what follows is none. */
static bool find_elbow(const csg_path *path, size_t line, elbow *out)
{
    static const double MOST = 179; /* degrees: behind its axis there is nothing of both lines */
    size_t at = csg_path_after(path, line);
    *out = (elbow){.before = line, .first = at};
    while (at != SIZE_MAX && at != line && path->pieces[at].radius > 0) {
        if (!goes_on_about(&path->pieces[out->first], &path->pieces[at]))
            return false;
        out->angle += path->pieces[at].angle;
        out->last = at;
        at = csg_path_after(path, at);
    }
    out->behind = at;
    return at != SIZE_MAX && at != line && out->angle > 0 && out->angle < MOST;
}

/* All of the path is lines with elbows between them. */
static bool is_of_elbows(const csg_path *path)
{
    size_t arcs = 0, held = 0;
    elbow e;
    for (size_t i = 0; i < path->count; i++) {
        const csg_path_piece *piece = &path->pieces[i];
        if (piece->turn != 0 || csg_path_is_corner(path, i))
            return false;
        arcs += piece->radius > 0;
        if (piece->radius > 0 || csg_path_after(path, i) == SIZE_MAX)
            continue;
        if (!find_elbow(path, i, &e))
            return false;
        for (size_t k = e.first; k != e.behind; k = csg_path_after(path, k))
            held++;
    }
    return arcs > 0 && held == arcs;
}

/* Around the figure at a frame. */
static csg_box box_at(const sweeping *s, const csg_path_frame *f)
{
    csg_box box = csg_box_empty();
    for (size_t k = 0; k < s->figure.point_count; k++) {
        csg_vec3 p = csg_vec3_add(f->at, in_frame(f, s->figure.points[k]));
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

/* Where an arc is farthest along an axis, between its ends, the figure reaches no farther. */
static csg_box box_of_arc(const sweeping *s, const csg_path_piece *arc)
{
    csg_box box = csg_box_hull(box_at(s, &arc->start), box_at(s, &arc->end));
    csg_vec3 out = csg_vec3_scale(arc->inward, -1), t = arc->start.tangent, center = center_of(arc);
    const double outs[3] = {out.x, out.y, out.z}, ways[3] = {t.x, t.y, t.z};
    for (int k = 0; k < 6; k++) {
        double sign = k < 3 ? 1 : -1;
        double angle = csg_atan2(sign * ways[k % 3], sign * outs[k % 3]);
        if (!(angle > 0 && angle < arc->angle * csg_acos(-1) / 180))
            continue;
        csg_vec3 way =
            csg_vec3_add(csg_vec3_scale(out, csg_cos(angle)), csg_vec3_scale(t, csg_sin(angle)));
        csg_vec3 p = csg_vec3_add(center, csg_vec3_scale(way, arc->radius));
        box = csg_box_hull(box, csg_box_grow((csg_box){p, p}, s->reach));
    }
    return box;
}

/* All places inside are as far from its faces as from the surface, since it holds the body. */
static csg_box box_of_elbow(const sweeping *s, const elbow *e)
{
    const csg_path *path = s->path;
    csg_box box = csg_box_hull(box_at(s, &path->pieces[e->before].start),
                               box_at(s, &path->pieces[e->behind].end));
    for (size_t k = e->first; k != e->behind; k = csg_path_after(path, k))
        box = csg_box_hull(box, box_of_arc(s, &path->pieces[k]));
    return csg_box_grow(box, 1e-3 * s->reach);
}

/* The end of one of its lines, `length` behind the arc, which lies on both sides of +x. It must
 * leave alone the other line, which turns back beyond it where the arc goes round by more than a
 * right angle, but stays on the other side of y = 0. */
static csg_node_id end_of_line(sweeping *s, double half_deg, double side, double length)
{
    csg_solid_job *job = s->job;
    csg_vec3 out = {-csg_sine_deg(half_deg), side * csg_cosine_deg(half_deg), 0};
    csg_node_id end =
        csg_solid_done(job, csg_build_half_space(job->builder, out, length, job->where));
    if (half_deg <= 45 || end == CSG_NODE_NONE)
        return end;
    csg_node_id other = csg_solid_done(
        job, csg_build_half_space(job->builder, csg_vec3_make(0, side, 0), 0, job->where));
    if (other == CSG_NODE_NONE)
        return other;
    return csg_solid_done(job, csg_build_operator(job->builder, CSG_NODE_UNION, CSG_SHARP,
                                                  (csg_node_id[]){end, other}, 2, job->where));
}

static csg_node_id make_elbow(sweeping *s, const elbow *e)
{
    csg_solid_job *job = s->job;
    const csg_path_piece *arc = &s->path->pieces[e->first];
    double half = e->angle / 2;
    const csg_warp warp = {.kind = CSG_WARP_ELBOW, .parameters = {half}};
    csg_affine place = middle_of_arc(arc, half);
    csg_node_id parts[3] = {standing(s, arc)};
    if (parts[0] == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    parts[0] = csg_solid_done(job, csg_build_warp(job->builder, &warp, parts[0], job->where));
    parts[1] = end_of_line(s, half, -1, s->path->pieces[e->before].length);
    parts[2] = end_of_line(s, half, 1, s->path->pieces[e->behind].length);
    for (int k = 0; k < 3; k++)
        if (parts[k] == CSG_NODE_NONE || job->stop)
            return CSG_NODE_NONE;
    csg_node_id node = csg_solid_done(job, csg_build_operator(job->builder, CSG_NODE_INTERSECTION,
                                                              CSG_SHARP, parts, 3, job->where));
    if (node == CSG_NODE_NONE)
        return node;
    node = csg_solid_moved(job, node, &place);
    if (node == CSG_NODE_NONE)
        return node;
    return csg_solid_done(job, csg_build_cut(job->builder, node, box_of_elbow(s, e), job->where));
}

/* ---- joints ---------------------------------------------------------------------------------- */

enum { MOST_PARTS = 4 };

typedef struct parts {
    csg_node_id of[MOST_PARTS];
    size_t count;
} parts;

/* What lies on one side of the plane through a point. */
static void add_side(sweeping *s, parts *to, csg_vec3 normal, csg_vec3 at, bool behind)
{
    csg_solid_job *job = s->job;
    csg_vec3 out = csg_vec3_scale(normal, behind ? -1 : 1);
    to->of[to->count++] = csg_solid_done(
        job, csg_build_half_space(job->builder, out, csg_vec3_dot(out, at), job->where));
}

/* Behind the corner where piece i begins, and before the one where it ends. */
static void add_start(sweeping *s, parts *to, size_t i)
{
    if (csg_path_is_corner(s->path, i))
        add_side(s, to, csg_path_joint(s->path, i), s->path->pieces[i].start.at, true);
}

static void add_end(sweeping *s, parts *to, size_t i)
{
    if (is_corner_after(s->path, i))
        add_side(s, to, joint_after(s->path, i), s->path->pieces[i].end.at, false);
}

static csg_node_id common(sweeping *s, const parts *of)
{
    csg_solid_job *job = s->job;
    for (size_t i = 0; i < of->count; i++)
        if (of->of[i] == CSG_NODE_NONE || job->stop)
            return CSG_NODE_NONE;
    return csg_solid_done(job, csg_build_operator(job->builder, CSG_NODE_INTERSECTION, CSG_SHARP,
                                                  of->of, of->count, job->where));
}

/* The piece as far as its joints. */
static csg_node_id between_joints(sweeping *s, size_t i)
{
    parts all = {.count = 0};
    all.of[all.count++] = body(s, i, 0, 0);
    add_start(s, &all, i);
    add_end(s, &all, i);
    return common(s, &all);
}

/* What is in piece i and the next one where both go on beyond their joint: so far that one of the
 * two ends, the joint's or this, is farther away than the figure is deep. */
static csg_node_id across_joint(sweeping *s, size_t i, size_t next)
{
    parts all = {.count = 0};
    all.of[all.count++] = body(s, i, 0, 2 * s->reach);
    all.of[all.count++] = body(s, next, 2 * s->reach, 0);
    add_start(s, &all, i);
    add_end(s, &all, next);
    return common(s, &all);
}

static csg_node_id sweep(sweeping *s)
{
    csg_solid_job *job = s->job;
    csg_memory *memory = job->memory;
    size_t most = 2 * s->path->count, count = 0, bytes = most * sizeof(csg_node_id);
    csg_node_id *pieces = csg_memory_alloc(memory, bytes), node = CSG_NODE_NONE;
    if (!pieces) {
        csg_solid_no_memory(job);
        return node;
    }
    bool elbows = is_of_elbows(s->path);
    for (size_t i = 0; i < s->path->count && !job->stop && elbows; i++) {
        elbow e;
        if (s->path->pieces[i].radius == 0 && find_elbow(s->path, i, &e))
            pieces[count++] = make_elbow(s, &e);
    }
    for (size_t i = 0; i < s->path->count && !job->stop && !elbows; i++) {
        size_t next = csg_path_after(s->path, i);
        pieces[count++] = between_joints(s, i);
        if (next != SIZE_MAX && !job->stop)
            pieces[count++] = across_joint(s, i, next);
    }
    if (!job->stop)
        node = csg_solid_union(job, pieces, count);
    csg_memory_release(memory, pieces, bytes);
    return node;
}

csg_node_id csg_solid_along(csg_solid_job *job, csg_node_id flat, const csg_path *path,
                            csg_path_finding *found)
{
    sweeping s = {.job = job, .path = path};
    csg_node_id node = CSG_NODE_NONE;
    *found = (csg_path_finding){.fault = CSG_PATH_SOUND};
    s.flat = csg_solid_done(job, csg_unite(job->builder, flat));
    if (s.flat == CSG_NODE_NONE || job->stop)
        return CSG_NODE_NONE;
    csgm_status status = csg_flat_outline(job, s.flat, &s.figure);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make polygons of this figure");
    for (size_t k = 0; k < s.figure.point_count; k++)
        s.reach = fmax(s.reach, csg_hypot(s.figure.points[k].x, s.figure.points[k].y));
    node = fits(&s, found) ? sweep(&s) : csg_solid_empty(job);
    csg_outline_release(&s.figure);
    return node;
}
