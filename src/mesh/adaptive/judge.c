/* SPDX-License-Identifier: MIT
 * Cells one by one; see judge.h.
 */
#include "mesh/adaptive/judge.h"

#include <math.h>
#include <string.h>

#include "mesh/adaptive/hunt.h"
#include "mesh/remesh/triangle.h"

enum { N = CSG_BRICK_SAMPLES, E = CSG_BRICK_EDGE, P = CSG_BRICK_POINTS };

/* Where sheets do not meet although they should, and triangles are near the surface all the same,
 * cells of so many tolerances are small enough. */
static const double FAILURE = 4;
/* The same where a cell has several polygons. */
static const double SEVERAL = 1;

typedef enum csg_face_state { FACE_UNKNOWN, FACE_PLAIN, FACE_CREASED } face_state;

/* ---- edges -------------------------------------------------------------------------------------
 */

static unsigned slot_of(int axis, const unsigned low[3])
{
    return (unsigned)axis * P + low[0] + N * (low[1] + N * low[2]);
}

void csg_judge_add_edge(csg_judge_room *room, const csg_bricks *b, const csg_brick *brick, int axis,
                        const unsigned low[3])
{
    csg_edges *e = &room->edges;
    uint32_t n = e->count++;
    float from[3], step[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        from[k] = csg_brick_coordinate(b, brick, k, low[k]);
    step[axis] = csg_brick_coordinate(b, brick, axis, low[axis] + 1) - from[axis];
    e->ax[n] = from[0], e->ay[n] = from[1], e->az[n] = from[2];
    e->dx[n] = step[0], e->dy[n] = step[1], e->dz[n] = step[2];
    e->a_inside[n] = brick->inside[low[2]][low[1]] >> low[0] & 1;
    e->rank[n] = (uint16_t)n;
}

void csg_judge_solve_edges(const csg_judge *judge, const csg_bricks *b, const csg_brick *brick,
                           csg_judge_room *room)
{
    csg_edges *e = &room->edges;
    csg_tape tape = csg_bricks_tape(b, brick);
    if (!e->count)
        return;
    e->end_distance = judge->end_distance / (float)csg_bricks_cell(b, brick->level);
    room->evaluations +=
        b->kernel->roots(&tape, e, judge->noise, room->scratch, room->scratch_floats);
    b->kernel->gradients(&tape, e->x, e->y, e->z, e->count, room->gradient[0], room->gradient[1],
                         room->gradient[2], room->scratch, room->scratch_floats);
    room->gradients += e->count;
}

static void collect_edges(const csg_bricks *b, const csg_brick *brick, csg_judge_room *room)
{
    room->edges.count = 0;
    for (unsigned slot = 0; slot < CSG_BRICK_SLOTS; slot++) {
        int axis = (int)(slot / P);
        const unsigned low[3] = {slot % N, slot / N % N, slot % P / (N * N)};
        if (low[axis] == E || !csg_brick_is_crossed(brick, axis, low))
            continue;
        room->edge[slot] = (uint16_t)room->edges.count;
        csg_judge_add_edge(room, b, brick, axis, low);
    }
}

csg_sheet_probe csg_judge_probe(const csg_judge *judge, const csg_bricks *b, const csg_brick *brick,
                                csg_judge_room *room, csg_tape *tape)
{
    *tape = csg_bricks_tape(b, brick);
    return (csg_sheet_probe){.kernel = b->kernel,
                             .tape = tape,
                             .scratch = room->scratch,
                             .scratch_floats = room->scratch_floats,
                             .noise = (double)judge->noise};
}

/* ---- faces -------------------------------------------------------------------------------------
 */

bool csg_cell_face_is_inside(void *cell_faces, unsigned face)
{
    const csg_cell_faces *c = cell_faces;
    float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES], f[CSG_LANES], at[3];
    uint32_t size = csg_bricks_cell(c->bricks, c->brick->level);
    unsigned q[3];
    csg_local_place(face, q);
    for (int axis = 0; axis < 3; axis++) {
        uint32_t first = csg_brick_point(c->bricks, c->brick, axis, c->at[axis]);
        /* in half cells: between which points; a quarter's sides are halves of the cell's */
        uint32_t low = q[axis] / 2 * size / 2, high = (q[axis] + 1) / 2 * size / 2;
        if (q[axis] == 2)
            low = 0, high = size;
        at[axis] = 0.5f * (csg_lattice_coordinate(c->bricks->lattice, axis, first + low) +
                           csg_lattice_coordinate(c->bricks->lattice, axis, first + high));
    }
    for (int i = 0; i < CSG_LANES; i++)
        x[i] = at[0], y[i] = at[1], z[i] = at[2];
    c->probe->kernel->values(c->probe->tape, x, y, z, 1, f, c->probe->scratch,
                             c->probe->scratch_floats);
    c->probe->evaluations++;
    return f[0] >= 0;
}

/* ---- one cell ----------------------------------------------------------------------------------
 */

csg_cell_box csg_judge_cell_box(const csg_bricks *b, const csg_brick *brick, const unsigned at[3])
{
    csg_cell_box box;
    for (int axis = 0; axis < 3; axis++) {
        box.low[axis] = (double)csg_brick_coordinate(b, brick, axis, at[axis]);
        box.high[axis] = (double)csg_brick_coordinate(b, brick, axis, at[axis] + 1);
    }
    box.cell = box.high[0] - box.low[0];
    return box;
}

/* The slot of an edge or a face of a cell by its middle. */
static unsigned slot_of_place(unsigned place, const unsigned cell[3], bool is_face)
{
    unsigned q[3], low[3];
    int axis = 0;
    csg_local_place(place, q);
    for (int k = 0; k < 3; k++) {
        low[k] = cell[k] + (q[k] == 4);
        if ((q[k] == 2) != is_face)
            axis = k;
    }
    return slot_of(axis, low);
}

static csg_surface_point point_of(const csg_judge_room *room, unsigned slot)
{
    uint32_t n = room->edge[slot];
    const csg_edges *e = &room->edges;
    return (csg_surface_point){
        {(double)e->x[n], (double)e->y[n], (double)e->z[n]},
        {(double)room->gradient[0][n], (double)room->gradient[1][n], (double)room->gradient[2][n]}};
}

/* Looks for the crease in the face that a side runs through, once for both cells. */
static bool find_crease(csg_sheet_probe *probe, csg_judge_room *room, const csg_cell_box *box,
                        const unsigned cell[3], const csg_polygon_side *side, csg_vec3 *out)
{
    unsigned slot = slot_of_place(side->face, cell, true), q[3];
    if (room->face[slot] == FACE_UNKNOWN) {
        csg_cell_box face = *box;
        csg_local_place(side->face, q);
        for (int k = 0; k < 3; k++) {
            face.low[k] = q[k] == 4 ? box->high[k] : box->low[k];
            face.high[k] = q[k] == 0 ? box->low[k] : box->high[k];
        }
        /* ends in the order of their edges, whichever of both cells asks */
        uint8_t lower = side->from < side->to ? side->from : side->to;
        uint8_t upper = side->from < side->to ? side->to : side->from;
        const csg_surface_point ends[2] = {point_of(room, slot_of_place(lower, cell, false)),
                                           point_of(room, slot_of_place(upper, cell, false))};
        bool found = csg_sheets_meet_in_face(probe, &face, ends, &room->crease[slot]);
        room->face[slot] = found ? FACE_CREASED : FACE_PLAIN;
    }
    *out = room->crease[slot];
    return room->face[slot] == FACE_CREASED;
}

/* Triangle t around the apex, or, apex NULL, of those that the polygon is cut into: its corners as
 * vertices of the polygon, -1 for the apex, and their places. */
static void find_triangle(const csg_polygon *p, const csg_vec3 *apex, const uint8_t *cut, int t,
                          int corner[3], csg_vec3 at[3])
{
    const int around[3] = {-1, t, (t + 1) % p->count};
    for (int k = 0; k < 3; k++) {
        corner[k] = apex ? around[k] : cut[3 * t + k];
        at[k] = corner[k] < 0 ? *apex : p->point[corner[k]].at;
    }
}

static int triangle_count(const csg_polygon *p, const csg_vec3 *apex)
{
    return apex ? p->count : p->count - 2;
}

/* The gradient that a triangle's sheet has: of a vertex of it that is on no crease. */
static csg_vec3 gradient_of(const csg_polygon *p, const int corner[3])
{
    for (int k = 0; k < 3; k++)
        if (corner[k] >= 0 && !p->is_crease[corner[k]])
            return p->point[corner[k]].gradient;
    return csg_vec3_make(0, 0, 0);
}

double csg_polygon_distance(csg_sheet_probe *probe, const csg_polygon *p, const csg_vec3 *apex,
                            const uint8_t *cut, double least_length)
{
    enum { MOST = 3 * CSG_POLYGON_MOST + CSG_LANES };
    /* of the normals of a triangle and of its sheet */
    const double looks_away = 0.17;
    float x[MOST], y[MOST], z[MOST], f[MOST];
    size_t n = 0;
    x[0] = y[0] = z[0] = 0;
    int triangles = triangle_count(p, apex);
    double slope = INFINITY;
    for (int i = 0; i < p->count; i++)
        if (!p->is_crease[i])
            slope = fmin(slope, csg_vec3_norm(p->point[i].gradient));
    for (int t = 0; t < triangles; t++) {
        int corner[3];
        csg_vec3 v[3];
        find_triangle(p, apex, cut, t, corner, v);
        csg_vec3 a = v[0], b = v[1], c = v[2], g = gradient_of(p, corner);
        csg_vec3 cross = csg_vec3_cross(csg_vec3_sub(b, a), csg_vec3_sub(c, a));
        csg_vec3 longest = csg_vec3_sub(b, c);
        double height = csg_vec3_norm(cross) / fmax(csg_vec3_norm(longest), 1e-30);
        if (height > least_length && -csg_gradients_cosine(cross, g) < looks_away)
            return INFINITY;
        csg_vec3 at[3] = {csg_vec3_scale(csg_vec3_add(a, csg_vec3_add(b, c)), 1.0 / 3),
                          csg_vec3_scale(csg_vec3_add(a, b), 0.5),
                          csg_vec3_scale(csg_vec3_add(b, c), 0.5)};
        for (int k = 0; k < 3; k++, n++)
            x[n] = (float)at[k].x, y[n] = (float)at[k].y, z[n] = (float)at[k].z;
    }
    for (size_t i = n; i % CSG_LANES; i++)
        x[i] = x[0], y[i] = y[0], z[i] = z[0];
    probe->kernel->values(probe->tape, x, y, z, n, f, probe->scratch, probe->scratch_floats);
    probe->evaluations += n;
    double worst = 0;
    for (size_t i = 0; i < n; i++)
        worst = fmax(worst, fabs((double)f[i]));
    return slope > 0 ? fmax(worst - 4 * probe->noise, 0) / slope : INFINITY;
}

/* The polygon's corners in the order of csg_cell_cut, which numbers edges. False: it is none that
 * a whole cell has. */
static bool cut_of(unsigned pattern, const csg_polygon *p, uint8_t *cut)
{
    csg_cell_loops loops = csg_cell_loops_of(pattern, 0);
    uint8_t triangles[CSG_CELL_MOST_INDICES];
    if (loops.count != 1 || loops.sides[0] != p->count ||
        !csg_cell_cut(loops.edge[0], p->count, triangles))
        return false;
    for (int i = 0; i < 3 * (p->count - 2); i++) {
        int at = 0;
        while (at < p->count && p->vertex[at] != triangles[i])
            at++;
        if (at == p->count)
            return false;
        cut[i] = (uint8_t)at;
    }
    return true;
}

static bool is_near_side(const csg_cell_box *box, csg_vec3 p, double reach)
{
    const double at[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++)
        if (at[axis] - box->low[axis] < reach || box->high[axis] - at[axis] < reach)
            return true;
    return false;
}

typedef struct cell_work {
    const csg_judge *judge;
    const csg_bricks *bricks;
    csg_brick *brick;
    csg_judge_room *room;
    csg_sheet_probe probe;
    const csg_hunted *hunted;
} cell_work;

/* Whether all places of the surface that were found in the cell are near the polygon's triangles:
 * around an apex, or as they are cut. */
static bool has_all(const cell_work *w, unsigned cell, const csg_cell_box *box,
                    const csg_polygon *p, const csg_vec3 *apex, const uint8_t *cut)
{
    double tolerance = w->judge->tolerance;
    int triangles = triangle_count(p, apex);
    for (int i = 0; i < w->hunted->count; i++) {
        csg_vec3 at = w->hunted->at[i];
        double nearest = INFINITY, weights[3];
        if (w->hunted->cell[i] != cell || is_near_side(box, at, tolerance))
            continue; /* it may be near a polygon of the next cell */
        for (int t = 0; t < triangles; t++) {
            int corner[3];
            csg_vec3 v[3];
            find_triangle(p, apex, cut, t, corner, v);
            nearest = fmin(nearest, csg_triangle_nearest((const csg_vec3 *)v, at, weights));
        }
        if (nearest > tolerance * tolerance)
            return false;
    }
    return true;
}

/* Whether a cell with one polygon is good as it is. */
static bool is_good(cell_work *w, const unsigned at[3], unsigned pattern,
                    const csg_cell_polygons *polygons)
{
    csg_cell_box box = csg_judge_cell_box(w->bricks, w->brick, at);
    csg_polygon p = {.count = 0};
    double tolerance = w->judge->tolerance;
    double least = box.cell <= FAILURE * tolerance ? tolerance : 0.1 * tolerance;
    unsigned cell = csg_brick_cell(at[0], at[1], at[2]);
    int creases = 0;
    for (int i = 0; i < polygons->first[1]; i++) {
        const csg_polygon_side *side = &polygons->side[i];
        csg_vec3 crease;
        p.vertex[p.count] = csg_local_edge(side->from);
        p.point[p.count++] = point_of(w->room, slot_of_place(side->from, at, false));
        if (!w->judge->sharp || !side->alone ||
            !find_crease(&w->probe, w->room, &box, at, side, &crease))
            continue;
        p.is_crease[p.count] = true;
        p.point[p.count++].at = crease;
        creases++;
    }
    uint8_t cut[CSG_CELL_MOST_INDICES];
    if (!creases && cut_of(pattern, &p, cut) &&
        csg_polygon_distance(&w->probe, &p, NULL, cut, least) <= tolerance) {
        w->brick->flat |= (uint64_t)1 << cell;
        return has_all(w, cell, &box, &p, NULL, cut);
    }
    csg_vec3 apex;
    csg_apex_kind kind = csg_polygon_find_apex(&w->probe, &box, &p, &apex);
    return (kind != CSG_APEX_FAILED || box.cell <= FAILURE * tolerance) &&
           csg_polygon_distance(&w->probe, &p, &apex, NULL, least) <= tolerance &&
           has_all(w, cell, &box, &p, &apex, NULL);
}

bool csg_judge_brick(void *user, uint32_t worker, const csg_bricks *b, csg_brick *brick)
{
    const csg_judge *judge = user;
    csg_judge_room *room = &judge->rooms[worker];
    bool is_finest = brick->level == b->finest;
    csg_tape tape;
    csg_hunted hunted = {.count = 0};
    cell_work w = {.judge = judge,
                   .bricks = b,
                   .brick = brick,
                   .room = room,
                   .probe = csg_judge_probe(judge, b, brick, room, &tape),
                   .hunted = &hunted};
    if (!is_finest && csg_hunt(&w.probe, b, brick, judge->tolerance, &hunted)) {
        room->evaluations += w.probe.evaluations;
        return true;
    }
    if (!brick->crossed)
        return false;
    brick->flat = brick->several = 0;
    collect_edges(b, brick, room);
    memset(room->face, FACE_UNKNOWN, sizeof room->face);
    csg_judge_solve_edges(judge, b, brick, room);
    bool wants = false;
    double edge = csg_bricks_cell(b, brick->level) * b->lattice->cell_size;
    for (uint64_t rest = brick->crossed; rest && (!wants || is_finest); rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctzll(rest);
        const unsigned at[3] = {cell % E, cell / E % E, cell / (E * E)};
        unsigned pattern = csg_brick_pattern(brick, at[0], at[1], at[2]);
        csg_shell shell = {.brick = brick};
        csg_shell_cell place = csg_shell_cell_of(&shell, at[0], at[1], at[2]);
        csg_cell_polygons polygons;
        csg_cell_faces faces = {b, brick, at, &w.probe};
        csg_cell_polygons_make(&polygons, &place, csg_cell_face_is_inside, &faces);
        if (polygons.count > 1)
            brick->several |= (uint64_t)1 << cell;
        bool good = polygons.count > 1 ? edge <= SEVERAL * judge->tolerance
                                       : is_good(&w, at, pattern, &polygons);
        wants = wants || !good;
    }
    room->evaluations += w.probe.evaluations;
    return wants;
}
