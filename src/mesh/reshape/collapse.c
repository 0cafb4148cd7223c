/* SPDX-License-Identifier: MIT
 * One edge: what its collapse would cost, and whether it may be made. The place of the new vertex
 * is that of least error, brought back to the surface, or near it; at creases one of the edge's
 * ends, which lie on them.
 */
#include <math.h>
#include <string.h>

#include "mesh/reshape/decimation.h"

/* Places for the new vertex, the best first. */
typedef struct proposal {
    csg_vec3 at[3];
    uint32_t end[3]; /* of the edge, which lies there; NONE: neither does, and the place is to be
                        brought to the surface */
    int count;
} proposal;

static void propose(proposal *p, csg_vec3 at, uint32_t end)
{
    p->at[p->count] = at;
    p->end[p->count++] = end;
}

/* Creases are not left, corners do not move. Where the error is small an end does: the place of
 * least error would have to be brought back to the surface. */
static proposal places_of(const csg_decimation *d, const csg_quadric *q, uint32_t from, uint32_t to)
{
    static const double SMALL = 0.25; /* of the error, in the mean of squares */
    const csg_remesh *r = d->remesh;
    csg_vec3 a = r->at[from], b = r->at[to];
    uint8_t kind_a = r->kind[from], kind_b = r->kind[to];
    proposal p = {.count = 0};
    if (kind_a == CSG_VERTEX_CORNER && kind_b == CSG_VERTEX_CORNER)
        return p;
    if (kind_a != CSG_VERTEX_SMOOTH && kind_b != CSG_VERTEX_SMOOTH &&
        !csg_remesh_is_crease(r, csg_corners_find_edge(&r->corners, from, to)))
        return p;
    double error_a = csg_quadric_error(q, a), error_b = csg_quadric_error(q, b);
    bool a_first = error_a < error_b;
    if (kind_a != kind_b) {
        propose(&p, kind_a > kind_b ? a : b, kind_a > kind_b ? from : to);
        return p;
    }
    double small = SMALL * r->error;
    bool is_small = fmin(error_a, error_b) <= small * small * (q->xx + q->yy + q->zz);
    if (kind_a == CSG_VERTEX_SMOOTH && !is_small) {
        csg_vec3 middle = csg_vec3_scale(csg_vec3_add(a, b), 0.5), best;
        double reach = 2 * csg_vec3_norm(csg_vec3_sub(a, b));
        if (csg_quadric_least(q, middle, &best) &&
            csg_vec3_norm(csg_vec3_sub(best, middle)) <= reach)
            propose(&p, best, CSG_CORNER_NONE);
    }
    propose(&p, a_first ? a : b, a_first ? from : to);
    if (kind_a == CSG_VERTEX_CREASE)
        propose(&p, a_first ? b : a, a_first ? to : from);
    return p;
}

double csg_collapse_cost(const csg_decimation *d, uint32_t from, uint32_t to)
{
    /* Of two that cost nothing the shorter edge goes first: flat parts thin out evenly. */
    static const double LENGTH_SHARE = 1e-6;
    /* Of the error: what is farther than that from its planes, in the mean of squares, fails. */
    static const double HOPELESS = 2;
    const csg_remesh *r = d->remesh;
    csg_quadric q = csg_quadric_add(d->quadrics[from], d->quadrics[to]);
    proposal p = places_of(d, &q, from, to);
    csg_vec3 edge = csg_vec3_sub(r->at[from], r->at[to]);
    double square = csg_vec3_dot(edge, edge);
    if (!p.count)
        return -1;
    double error = csg_quadric_error(&q, p.at[0]), most = HOPELESS * r->error;
    if (error > most * most * (q.xx + q.yy + q.zz)) /* these are the planes' weights, summed up */
        return -1;
    return error + LENGTH_SHARE * square * square;
}

/* ---- the ring ----------------------------------------------------------------------------------
 */

static void add_fan(csg_decimation *d, uint32_t vertex, uint32_t other)
{
    csg_collapse_room *room = d->room;
    const csg_remesh *r = d->remesh;
    const csg_corners *m = &r->corners;
    uint32_t first = m->corner[vertex], c = first;
    do {
        uint32_t v = m->vertex[csg_corner_next(c)], w = m->vertex[csg_corner_previous(c)];
        if (v != other && w != other) {
            uint32_t i = room->count++;
            room->triangle[i] = c / 3;
            room->vertex[i][0] = vertex;
            room->vertex[i][1] = v;
            room->vertex[i][2] = w;
            for (int k = 0; k < 3; k++)
                room->before[i][k] = r->at[room->vertex[i][k]];
        }
        c = csg_corner_swing(m, c);
    } while (c != first);
}

/* The two triangles that go, behind those that stay. */
static void finish_ring(csg_decimation *d, uint32_t to, uint32_t corner)
{
    csg_collapse_room *room = d->room;
    const csg_corners *m = &d->remesh->corners;
    room->triangle[room->count] = corner / 3;
    room->triangle[room->count + 1] = m->across[csg_corner_previous(corner)] / 3;
    room->gone = 2;
    for (uint32_t i = 0; i < room->count; i++)
        room->vertex[i][0] = to;
}

/* What changes if the edge at this corner shrinks to its second end: only what is around the first
 * one, if the second one stays where it is. */
static void find_ring(csg_decimation *d, uint32_t from, uint32_t to, uint32_t corner, bool moves)
{
    d->room->count = 0;
    add_fan(d, from, to);
    if (moves)
        add_fan(d, to, from);
    finish_ring(d, to, corner);
}

static void move_ring(csg_collapse_room *room, csg_vec3 at)
{
    for (uint32_t i = 0; i < room->count; i++) {
        room->after[i][0] = at;
        room->after[i][1] = room->before[i][1];
        room->after[i][2] = room->before[i][2];
    }
}

/* The squared length of a normal, and that of the longest side. */
typedef struct shape {
    double normal, longest;
} shape;

static shape shape_of(const csg_vec3 v[3], csg_vec3 *normal)
{
    csg_vec3 a = csg_vec3_sub(v[1], v[0]), b = csg_vec3_sub(v[2], v[0]), c = csg_vec3_sub(b, a);
    double a2 = csg_vec3_dot(a, a), b2 = csg_vec3_dot(b, b), c2 = csg_vec3_dot(c, c);
    double most = a2 > b2 ? a2 : b2;
    *normal = csg_vec3_cross(a, b);
    return (shape){csg_vec3_dot(*normal, *normal), most > c2 ? most : c2};
}

/* Its quality as csg_triangle_quality has it, squared. */
static double quality_of(shape s)
{
    return s.longest > 0 ? s.normal / (s.longest * s.longest) : 0;
}

/* No triangle turns over, and none becomes a worse sliver than there is, or than is useful. */
static bool has_shape(const csg_decimation *d)
{
    static const double TURN_COS = 0.1, SOUND = 0.02 * 0.02;
    csg_collapse_room *room = d->room;
    double worst = d->least_quality * d->least_quality, least = 1;
    for (uint32_t i = 0; i < room->count; i++) {
        csg_vec3 old;
        shape before = shape_of(room->before[i], &old);
        shape after = shape_of(room->after[i], &room->normal[i]);
        room->longest[i] = after.longest;
        double quality = quality_of(before), own = quality_of(after);
        double dot = csg_vec3_dot(old, room->normal[i]);
        if (quality > SOUND &&
            (!(dot > 0) || dot * dot < TURN_COS * TURN_COS * before.normal * after.normal))
            return false;
        worst = quality < worst ? quality : worst;
        least = own < least ? own : least;
        if (!(own > 0))
            return false;
    }
    room->makes_slivers |= least < worst;
    return least >= worst;
}

/* ---- the collapse ------------------------------------------------------------------------------
 */

/* moves: so does the end that stays, with all that is around it. */
static bool crosses(const csg_decimation *d, uint32_t from, uint32_t to, bool moves,
                    bool *one_sheet)
{
    const csg_collapse_room *room = d->room;
    const csg_crossing_change change = {.at = (const csg_vec3(*)[3])room->after,
                                        .vertex = (const uint32_t(*)[3])room->vertex,
                                        .count = room->count,
                                        .vertices = {from, moves ? to : CSG_CORNER_NONE},
                                        .triangles = {CSG_CORNER_NONE, CSG_CORNER_NONE},
                                        .is_fan = moves};
    return csg_crossing_is_made(&d->remesh->tree, &change, one_sheet);
}

static bool is_within(const csg_decimation *d, csg_vec3 p)
{
    return p.x > d->low.x && p.y > d->low.y && p.z > d->low.z && p.x < d->high.x &&
           p.y < d->high.y && p.z < d->high.z;
}

/* As it is written: so what is checked is what comes out. */
static csg_vec3 round_place(const csg_remesh *r, csg_vec3 at)
{
    csg_vec3 shift = r->marching->shift;
    float written[3];
    csg_vec3_to_floats(written, csg_vec3_add(at, shift));
    return csg_vec3_sub(csg_vec3_from_floats(written), shift);
}

/* The field is asked only where not all around look the same. */
static csg_look_at_vertex look_at(const csg_decimation *d, csg_vec3 at, uint32_t from, uint32_t to)
{
    const csg_collapse_room *room = d->room;
    const csg_look_at_vertex *looks = d->remesh->looks;
    bool same = !memcmp(&looks[from], &looks[to], sizeof *looks);
    for (uint32_t i = 0; i < room->count && same; i++)
        for (int k = 1; k < 3 && same; k++)
            same = !memcmp(&looks[room->vertex[i][k]], &looks[to], sizeof *looks);
    return same ? looks[to] : csg_remesh_look(d->remesh, at);
}

/* What is near samples that face its way is near the surface. At other points the field is asked,
 * but where all are on one sheet and nothing is far. */
static bool is_near(csg_decimation *d, bool one_sheet)
{
    static const double NEAR = 0.5; /* of the error */
    csg_remesh *r = d->remesh;
    csg_collapse_room *room = d->room;
    double near = NEAR * r->error;
    if (one_sheet && room->farthest <= near * near)
        return true;
    csg_decimation_find_seen(d);
    return csg_remesh_brackets(r, (const csg_vec3(*)[3])room->after, room->seen, room->count);
}

/* Whether no crease is next to what changes. */
static bool is_smooth_around(const csg_decimation *d)
{
    const csg_collapse_room *room = d->room;
    for (uint32_t i = 0; i < room->count; i++)
        if (d->remesh->kind[room->vertex[i][1]] != CSG_VERTEX_SMOOTH)
            return false;
    return true;
}

/* Brings the place of least error as near to the surface as vertices have to be. Where samples are
 * too far from it by more than the way there could make good, the field is not asked. */
static bool bring_near_surface(csg_decimation *d, csg_vec3 *at, uint32_t to)
{
    static const double HOPEFUL = 1.25; /* of the error */
    csg_remesh *r = d->remesh;
    csg_vec3 least = *at;
    if (!csg_decimation_may_hand_over(d, to, HOPEFUL * r->error) ||
        !csg_remesh_come_to_surface(r, at, fmax(r->cell, 4 * r->error)))
        return false;
    csg_vec3 way = csg_vec3_sub(least, *at);
    double length = csg_vec3_norm(way);
    if (length > 0 && is_smooth_around(d))
        *at = csg_vec3_add(*at, csg_vec3_scale(way, fmin(length, d->farthest_vertex) / length));
    *at = round_place(r, *at);
    move_ring(d->room, *at);
    return has_shape(d);
}

/* Whether the edge may shrink to its end `to`, which comes to a place of its own. */
static bool new_place_is_good(csg_decimation *d, csg_vec3 *at, uint32_t from, uint32_t to)
{
    const csg_remesh *r = d->remesh;
    bool one_sheet;
    move_ring(d->room, *at);
    if (!has_shape(d) || !bring_near_surface(d, at, to) || !is_within(d, *at))
        return false;
    if (r->looks)
        d->room->look = look_at(d, *at, from, to);
    return csg_decimation_can_hand_over(d, to, r->error) &&
           !crosses(d, from, to, true, &one_sheet) && is_near(d, one_sheet);
}

/* Whether it may shrink to its end `to`, where that is. */
static bool end_is_good(csg_decimation *d, uint32_t from, uint32_t to)
{
    const csg_remesh *r = d->remesh;
    bool one_sheet;
    move_ring(d->room, r->at[to]);
    if (r->looks)
        d->room->look = r->looks[to];
    return has_shape(d) && csg_decimation_can_hand_over(d, to, r->error) &&
           !crosses(d, from, to, false, &one_sheet) && is_near(d, one_sheet);
}

static void collapse(csg_decimation *d, uint32_t corner, uint32_t from, uint32_t to, csg_vec3 at)
{
    csg_remesh *r = d->remesh;
    const csg_collapse_room *room = d->room;
    csg_decimation_hand_over(d);
    csg_corners_collapse(&r->corners, corner);
    r->at[to] = at;
    for (uint32_t i = 0; i < room->count; i++)
        csg_triangle_tree_include(&r->tree, room->triangle[i]);
    if (r->looks)
        r->looks[to] = d->room->look;
    d->quadrics[to] = csg_quadric_add(d->quadrics[from], d->quadrics[to]);
    d->version[to]++;
    d->version[from]++;
}

/* ---- where it is flat --------------------------------------------------------------------------
 */

/* Whether all triangles at a vertex go on through the place of a neighbour, to rounding, and look
 * the same: in a plane, or along a straight edge between two. Without the vertex they cover what
 * they covered before. */
static bool is_flat(const csg_remesh *r, uint32_t vertex, uint32_t neighbour)
{
    static const double ROUNDING = 4; /* of the tree's noise */
    const csg_corners *m = &r->corners;
    csg_vec3 at = r->at[vertex], off = csg_vec3_sub(r->at[neighbour], at);
    uint32_t first = m->corner[vertex], c = first;
    do {
        uint32_t v = m->vertex[csg_corner_next(c)], w = m->vertex[csg_corner_previous(c)];
        csg_vec3 n = csg_triangle_cross(at, r->at[v], r->at[w]);
        double height = csg_vec3_dot(n, off), most = ROUNDING * r->tree.noise;
        if (!(height * height <= most * most * csg_vec3_dot(n, n)) ||
            (r->looks && memcmp(&r->looks[v], &r->looks[vertex], sizeof r->looks[v]) != 0))
            return false;
        c = csg_corner_swing(m, c);
    } while (c != first);
    return true;
}

/* Slivers too, which has_shape lets pass. */
static bool faces_as_before(const csg_collapse_room *room)
{
    for (uint32_t i = 0; i < room->count; i++) {
        const csg_vec3 *v = room->before[i];
        if (!(csg_vec3_dot(csg_triangle_cross(v[0], v[1], v[2]), room->normal[i]) > 0))
            return false;
    }
    return true;
}

/* The field need not be asked; what else is there may be as near as rounding. */
static bool collapse_flat(csg_decimation *d, uint32_t from, uint32_t to)
{
    csg_remesh *r = d->remesh;
    csg_collapse_room *room = d->room;
    if (r->kind[from] == CSG_VERTEX_CORNER || !is_flat(r, from, to))
        return false;
    uint32_t corner = csg_corners_find_edge(&r->corners, from, to);
    find_ring(d, from, to, corner, false);
    move_ring(room, r->at[to]);
    if (r->looks)
        room->look = r->looks[to];
    if (!has_shape(d) || !faces_as_before(room) || !csg_decimation_can_hand_over(d, to, r->error) ||
        crosses(d, from, to, false, NULL))
        return false;
    collapse(d, corner, from, to, r->at[to]);
    return true;
}

/* ---- one edge ----------------------------------------------------------------------------------
 */

/* The two vertices that face the edge: their lists of triangles change too. */
static bool owns_apexes(const csg_decimation *d, uint32_t corner)
{
    const csg_corners *m = &d->remesh->corners;
    uint32_t apex = csg_corner_previous(corner);
    return csg_decimation_owns(d, m->vertex[apex]) &&
           csg_decimation_owns(d, m->vertex[m->across[apex]]);
}

uint32_t csg_collapse_try(csg_decimation *d, uint32_t from, uint32_t to)
{
    csg_remesh *r = d->remesh;
    uint32_t corner = csg_corners_find_edge(&r->corners, from, to);
    if (corner == CSG_CORNER_NONE)
        return CSG_CORNER_NONE;
    if (!owns_apexes(d, corner)) {
        d->state[from] = CSG_VERTEX_HELD_UP;
        return CSG_CORNER_NONE;
    }
    if (!csg_corners_can_collapse(&r->corners, corner))
        return CSG_CORNER_NONE;
    if (collapse_flat(d, from, to))
        return to;
    if (collapse_flat(d, to, from))
        return from;
    csg_quadric q = csg_quadric_add(d->quadrics[from], d->quadrics[to]);
    proposal p = places_of(d, &q, from, to);
    d->room->makes_slivers = false;
    for (int i = 0; i < p.count; i++) {
        bool moves = p.end[i] == CSG_CORNER_NONE;
        uint32_t kept = moves ? to : p.end[i], gone = kept == to ? from : to;
        uint32_t edge = kept == to ? corner : csg_corners_find_edge(&r->corners, gone, kept);
        find_ring(d, gone, kept, edge, moves);
        if (moves ? !new_place_is_good(d, &p.at[i], gone, kept) : !end_is_good(d, gone, kept))
            continue;
        collapse(d, edge, gone, kept, p.at[i]);
        r->kind[kept] = r->kind[from] > r->kind[to] ? r->kind[from] : r->kind[to];
        return kept;
    }
    if (d->room->makes_slivers && d->state[from] == CSG_VERTEX_SETTLED)
        d->state[from] = CSG_VERTEX_SLIVERED;
    return CSG_CORNER_NONE;
}
