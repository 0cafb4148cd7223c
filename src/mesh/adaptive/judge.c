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
/* Of a cell: how far beside each other's triangles its polygons are. */
static const double APART = 1e-3;

/* ---- edges -------------------------------------------------------------------------------------
 */

static unsigned slot_of(int axis, const unsigned low[3])
{
    return (unsigned)axis * P + low[0] + N * (low[1] + N * low[2]);
}

/* From a point along an axis. */
static void add_span(csg_edges *e, int axis, const float from[3], float to, bool inside)
{
    uint32_t n = e->count++;
    float step[3] = {0, 0, 0};
    step[axis] = to - from[axis];
    e->ax[n] = from[0], e->ay[n] = from[1], e->az[n] = from[2];
    e->dx[n] = step[0], e->dy[n] = step[1], e->dz[n] = step[2];
    e->a_inside[n] = inside;
    e->rank[n] = (uint16_t)n;
}

void csg_judge_add_edge(csg_judge_room *room, const csg_bricks *b, const csg_brick *brick, int axis,
                        const unsigned low[3])
{
    float from[3], to = csg_brick_coordinate(b, brick, axis, low[axis] + 1);
    for (int k = 0; k < 3; k++)
        from[k] = csg_brick_coordinate(b, brick, k, low[k]);
    bool inside = brick->inside[low[2]][low[1]] >> low[0] & 1;
    unsigned edge = csg_brick_edge(axis, low);
    if (room->pierced.edges >> edge & 1) {
        float between = room->pierced.at[edge];
        add_span(&room->edges, axis, from, between, inside);
        from[axis] = between;
        inside = !inside;
    }
    add_span(&room->edges, axis, from, to, inside);
}

void csg_judge_solve_edges(const csg_judge *judge, const csg_bricks *b, const csg_brick *brick,
                           csg_judge_room *room)
{
    csg_edges *e = &room->edges;
    csg_tape tape = csg_bricks_tape(b, brick);
    if (!e->count)
        return;
    /* of the whole edge; spans of a pierced one are shorter, by CSG_LEAST_SPAN at most */
    e->end_distance = judge->end_distance / (float)csg_bricks_cell(b, brick->level);
    if (room->pierced.edges)
        e->end_distance = fminf(e->end_distance / CSG_LEAST_SPAN, 0.25f);
    room->evaluations +=
        b->kernel->roots(&tape, e, judge->noise, room->scratch, room->scratch_floats);
    b->kernel->gradients(&tape, e->x, e->y, e->z, e->count, room->gradient[0], room->gradient[1],
                         room->gradient[2], room->scratch, room->scratch_floats);
    room->gradients += e->count;
}

bool csg_judge_has_edge(const csg_judge_room *room, const csg_brick *brick, int axis,
                        const unsigned low[3])
{
    return csg_brick_is_crossed(brick, axis, low) ||
           (room->pierced.edges >> csg_brick_edge(axis, low) & 1);
}

static void collect_edges(const csg_bricks *b, const csg_brick *brick, csg_judge_room *room)
{
    room->edges.count = 0;
    for (unsigned slot = 0; slot < CSG_BRICK_SLOTS; slot++) {
        int axis = (int)(slot / P);
        const unsigned low[3] = {slot % N, slot / N % N, slot % P / (N * N)};
        if (low[axis] == E || !csg_judge_has_edge(room, brick, axis, low))
            continue;
        room->edge[0][slot] = (uint16_t)room->edges.count;
        csg_judge_add_edge(room, b, brick, axis, low);
        room->edge[1][slot] = (uint16_t)(room->edges.count - 1);
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

/* The middle of a face, or of a quarter of one. */
static void middle_of_face(const csg_cell_faces *c, unsigned face, float at[3])
{
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
}

/* A corner of the cell, or a point between two: where the edge is pierced. */
static float coordinate_of(const csg_cell_faces *c, const uint8_t point[3], int axis)
{
    unsigned low[3], edge_axis = 3;
    for (unsigned k = 0; k < 3; k++) {
        low[k] = c->at[k] + point[k] / 2u;
        if (point[k] == 1)
            edge_axis = k;
    }
    if ((int)edge_axis != axis)
        return csg_brick_coordinate(c->bricks, c->brick, axis, low[axis]);
    unsigned edge = csg_brick_edge(axis, low);
    if (c->pierced->edges >> edge & 1)
        return c->pierced->at[edge];
    uint32_t size = csg_bricks_cell(c->bricks, c->brick->level);
    return csg_lattice_coordinate(c->bricks->lattice, axis,
                                  csg_brick_point(c->bricks, c->brick, axis, low[axis]) + size / 2);
}

bool csg_cell_face_is_inside(void *cell_faces, const csg_face_look *look)
{
    const csg_cell_faces *c = cell_faces;
    float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES], f[CSG_LANES], at[3];
    if (!look->count)
        middle_of_face(c, look->face, at);
    for (int axis = 0; axis < 3 && look->count; axis++) {
        double sum = 0;
        for (int i = 0; i < look->count; i++)
            sum += look->weight[i] * (double)coordinate_of(c, look->point[i], axis);
        at[axis] = (float)sum;
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

/* The slot of an edge, or a half of one, or of a face of a cell by its middle. */
static unsigned slot_of_place(unsigned place, const unsigned cell[3], bool is_face)
{
    unsigned q[3], low[3];
    int axis = 0;
    csg_local_place(place, q);
    for (int k = 0; k < 3; k++) {
        low[k] = cell[k] + (q[k] == 4);
        if ((q[k] % 4 != 0) != is_face)
            axis = k;
    }
    return slot_of(axis, low);
}

/* The vertex on an edge of a cell, or on a half of one, by its middle. */
static csg_surface_point point_of(const csg_judge_room *room, unsigned place,
                                  const unsigned cell[3])
{
    unsigned q[3];
    csg_local_place(place, q);
    bool upper = q[0] == 3 || q[1] == 3 || q[2] == 3;
    uint32_t n = room->edge[upper][slot_of_place(place, cell, false)];
    const csg_edges *e = &room->edges;
    return (csg_surface_point){
        {(double)e->x[n], (double)e->y[n], (double)e->z[n]},
        {(double)room->gradient[0][n], (double)room->gradient[1][n], (double)room->gradient[2][n]}};
}

/* The face that a side runs through, and its ends in the order of their edges, whichever of both
 * cells asks. */
static csg_face_crease face_of(const csg_judge_room *room, const csg_cell_box *box,
                               const unsigned cell[3], const csg_polygon_side *side)
{
    csg_face_crease f = {.face = *box};
    unsigned q[3];
    csg_local_place(side->face, q);
    for (int k = 0; k < 3; k++) {
        f.face.low[k] = q[k] == 4 ? box->high[k] : box->low[k];
        f.face.high[k] = q[k] == 0 ? box->low[k] : box->high[k];
    }
    uint8_t lower = side->from < side->to ? side->from : side->to;
    uint8_t upper = side->from < side->to ? side->to : side->from;
    f.ends[0] = point_of(room, lower, cell);
    f.ends[1] = point_of(room, upper, cell);
    return f;
}

/* Looks for creases in the faces of cells with one polygon, in each once for both cells. */
static void find_creases(csg_sheet_probe *probe, csg_judge_room *room, const csg_bricks *b,
                         const csg_brick *brick)
{
    memset(room->face, CSG_NO_FACE, sizeof room->face);
    room->face_count = 0;
    for (unsigned rest = brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest);
        const unsigned at[3] = {cell % E, cell / E % E, cell / (E * E)};
        const csg_cell_polygons *polygons = &room->polygons[cell];
        csg_cell_box box = csg_judge_cell_box(b, brick, at);
        for (unsigned i = 0; polygons->count == 1 && i < polygons->first[1]; i++) {
            const csg_polygon_side *side = &polygons->side[i];
            unsigned slot = slot_of_place(side->face, at, true);
            if (!side->alone || side->pierced || room->face[slot] != CSG_NO_FACE)
                continue;
            room->face[slot] = (uint8_t)room->face_count;
            room->faces[room->face_count++] = face_of(room, &box, at, side);
        }
    }
    csg_sheets_meet_in_faces(probe, room->faces, room->face_count);
}

/* A polygon as it is cut into triangles: around an apex, or without a point inside. */
typedef struct cut_polygon {
    csg_polygon polygon;
    bool is_fan;
    csg_vec3 apex;
    uint8_t cut[CSG_CELL_MOST_INDICES]; /* three corners per triangle */
} cut_polygon;

enum { MOST_PIECES = 4 };

typedef struct cell_work {
    const csg_judge *judge;
    const csg_bricks *bricks;
    csg_brick *brick;
    csg_judge_room *room;
    csg_sheet_probe probe;
    const csg_hunted *hunted;
    cut_polygon pieces[MOST_PIECES]; /* of the cell at hand */
    int count;
} cell_work;

static int triangle_count(const cut_polygon *p)
{
    return p->is_fan ? p->polygon.count : p->polygon.count - 2;
}

/* The corners of a triangle as vertices of the polygon, -1 for the apex, and their places. */
static void find_triangle(const cut_polygon *p, int t, int corner[3], csg_vec3 at[3])
{
    const int around[3] = {-1, t, (t + 1) % p->polygon.count};
    for (int k = 0; k < 3; k++) {
        corner[k] = p->is_fan ? around[k] : p->cut[3 * t + k];
        at[k] = corner[k] < 0 ? p->apex : p->polygon.point[corner[k]].at;
    }
}

/* The gradient that a triangle's sheet has: of a vertex of it that is on no crease. */
static csg_vec3 gradient_of(const csg_polygon *p, const int corner[3])
{
    for (int k = 0; k < 3; k++)
        if (corner[k] >= 0 && !p->is_crease[corner[k]])
            return p->point[corner[k]].gradient;
    return csg_vec3_make(0, 0, 0);
}

/* The largest distance from the surface, as |f| over the slope, at points of the triangles.
 * INFINITY: a triangle higher than `least_height` looks inwards. */
static double find_distance(csg_sheet_probe *probe, const cut_polygon *piece, double least_height)
{
    enum { MOST = 3 * CSG_POLYGON_MOST + CSG_LANES };
    /* of the normals of a triangle and of its sheet */
    const double looks_away = 0.17;
    const csg_polygon *p = &piece->polygon;
    float x[MOST], y[MOST], z[MOST], f[MOST];
    size_t n = 0;
    x[0] = y[0] = z[0] = 0;
    double slope = INFINITY;
    for (int i = 0; i < p->count; i++)
        if (!p->is_crease[i])
            slope = fmin(slope, csg_vec3_norm(p->point[i].gradient));
    for (int t = 0; t < triangle_count(piece); t++) {
        int corner[3];
        csg_vec3 v[3];
        find_triangle(piece, t, corner, v);
        csg_vec3 a = v[0], b = v[1], c = v[2], g = gradient_of(p, corner);
        csg_vec3 cross = csg_vec3_cross(csg_vec3_sub(b, a), csg_vec3_sub(c, a));
        csg_vec3 longest = csg_vec3_sub(b, c);
        double height = csg_vec3_norm(cross) / fmax(csg_vec3_norm(longest), 1e-30);
        if (height > least_height && -csg_gradients_cosine(cross, g) < looks_away)
            return INFINITY;
        csg_vec3 at[4] = {csg_vec3_scale(csg_vec3_add(a, csg_vec3_add(b, c)), 1.0 / 3),
                          csg_vec3_scale(csg_vec3_add(a, b), 0.5),
                          csg_vec3_scale(csg_vec3_add(b, c), 0.5),
                          csg_vec3_scale(csg_vec3_add(c, a), 0.5)};
        int count =
            piece->is_fan ? 3 : 4; /* the next triangle of a fan has the last one's middle */
        for (int k = 0; k < count; k++, n++)
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

double csg_judge_fan_distance(const csg_judge *judge, csg_sheet_probe *probe,
                              const csg_polygon *polygon, csg_vec3 apex)
{
    cut_polygon piece = {.polygon = *polygon, .is_fan = true, .apex = apex};
    return find_distance(probe, &piece, judge->tolerance);
}

/* Cuts the polygon of a whole cell without a point inside, from the same vertex on as the mesh will
 * have it: other triangles have other distances. False: it has no such cut. */
static bool cut_without_apex(cut_polygon *piece)
{
    const csg_polygon *p = &piece->polygon;
    uint8_t edge[CSG_CELL_EDGES], triangles[CSG_CELL_MOST_INDICES];
    if (p->count > CSG_CELL_MOST_TRIANGLES + 2)
        return false; /* joined through faces: no loop of the tables, whose cuts meet nowhere */
    for (int i = 0; i < p->count; i++)
        edge[i] = (uint8_t)p->vertex[i];
    if (!csg_cell_cut(edge, p->count, triangles))
        return false;
    for (int i = 0; i < 3 * (p->count - 2); i++) {
        int at = 0;
        while (at < p->count - 1 && p->vertex[at] != triangles[i])
            at++;
        piece->cut[i] = (uint8_t)at;
    }
    return true;
}

/* Keeps the triangles of a cell that is good. */
static void keep_triangles(cell_work *w, unsigned cell)
{
    csg_judge_room *room = w->room;
    room->first_triangle[cell] = room->triangle_count;
    for (int k = 0; k < w->count; k++)
        for (int t = 0; t < triangle_count(&w->pieces[k]); t++) {
            int corner[3];
            if (room->triangle_count == CSG_JUDGE_MOST_TRIANGLES)
                return;
            find_triangle(&w->pieces[k], t, corner, room->triangles[room->triangle_count++]);
        }
    room->end_triangle[cell] = room->triangle_count;
}

static bool is_near_side(const csg_cell_box *box, csg_vec3 p, double reach)
{
    const double at[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++)
        if (at[axis] - box->low[axis] < reach || box->high[axis] - at[axis] < reach)
            return true;
    return false;
}

static bool is_near_triangles(const csg_judge_room *room, uint32_t first, uint32_t end, csg_vec3 at,
                              double reach)
{
    double weights[3];
    for (uint32_t t = first; t < end; t++)
        if (csg_triangle_nearest((const csg_vec3 *)room->triangles[t], at, weights) <=
            reach * reach)
            return true;
    return false;
}

/* The cells in which the surface was found away from triangles. Beside cells that are not searched,
 * and beside other bricks, it may be near triangles that are not there yet. */
static uint8_t find_uncovered(const cell_work *w, uint8_t cells)
{
    double tolerance = w->judge->tolerance;
    const csg_judge_room *room = w->room;
    bool all = cells == CSG_BRICK_ALL_CELLS;
    unsigned uncovered = 0;
    for (int i = 0; i < w->hunted->count; i++) {
        csg_vec3 at = w->hunted->at[i];
        unsigned cell = w->hunted->cell[i];
        csg_cell_box box;
        for (int axis = 0; axis < 3; axis++) {
            uint32_t low = all ? 0 : cell >> axis & 1;
            box.low[axis] = (double)csg_brick_coordinate(w->bricks, w->brick, axis, low);
            box.high[axis] =
                (double)csg_brick_coordinate(w->bricks, w->brick, axis, low + (all ? E : 1));
        }
        if (!(cells >> cell & 1) || is_near_side(&box, at, tolerance) ||
            is_near_triangles(room, room->first_triangle[cell], room->end_triangle[cell], at,
                              tolerance) ||
            is_near_triangles(room, 0, room->triangle_count, at, tolerance))
            continue;
        uncovered |= 1u << cell;
    }
    return (uint8_t)uncovered;
}

/* Whether all triangles of a piece have the other piece on one side: then they do not meet. */
static bool is_beside(const cut_polygon *p, const cut_polygon *other, double margin)
{
    for (int t = 0; t < triangle_count(p); t++) {
        int corner[3];
        csg_vec3 v[3];
        find_triangle(p, t, corner, v);
        csg_vec3 n =
            csg_vec3_normalize(csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0])));
        double low = INFINITY, high = -INFINITY;
        for (int i = other->is_fan ? -1 : 0; i < other->polygon.count; i++) {
            csg_vec3 at = i < 0 ? other->apex : other->polygon.point[i].at;
            double d = csg_vec3_dot(n, csg_vec3_sub(at, v[0]));
            low = fmin(low, d);
            high = fmax(high, d);
        }
        if (!(low > margin || high < -margin))
            return false;
    }
    return true;
}

static bool are_apart(const cell_work *w, double margin)
{
    for (int i = 0; i < w->count; i++)
        for (int k = 0; k < i; k++)
            if (!is_beside(&w->pieces[i], &w->pieces[k], margin) &&
                !is_beside(&w->pieces[k], &w->pieces[i], margin))
                return false;
    return true;
}

/* The vertices of a polygon, and, creased, what is found in the faces between them. */
static int gather(cell_work *w, const unsigned at[3], const csg_cell_polygons *polygons,
                  unsigned polygon, bool creased, csg_polygon *p)
{
    const csg_judge_room *room = w->room;
    csg_cell_box box = csg_judge_cell_box(w->bricks, w->brick, at);
    int creases = 0;
    p->count = 0;
    for (int i = polygons->first[polygon]; i < polygons->first[polygon + 1]; i++) {
        const csg_polygon_side *side = &polygons->side[i];
        csg_vec3 crease;
        uint8_t face = room->face[slot_of_place(side->face, at, true)];
        p->vertex[p->count] = csg_local_edge(side->from);
        p->is_crease[p->count] = false;
        p->point[p->count++] = point_of(room, side->from, at);
        if (side->pierced) {
            csg_face_crease wedge = face_of(room, &box, at, side);
            crease = csg_wedge_in_face(&w->probe, &wedge.face, wedge.ends);
        } else if (creased && side->alone && room->faces[face].is_there) {
            crease = room->faces[face].at;
        } else {
            continue;
        }
        p->is_crease[p->count] = true;
        p->point[p->count++].at = crease;
        creases++;
    }
    return creases;
}

/* Cuts one of a cell's polygons. False: its triangles are not what they should be. */
static bool cut_into_triangles(cell_work *w, const unsigned at[3], bool is_whole,
                               const csg_cell_polygons *polygons, unsigned polygon)
{
    csg_cell_box box = csg_judge_cell_box(w->bricks, w->brick, at);
    double tolerance = w->judge->tolerance;
    bool is_small = box.cell <= FAILURE * tolerance, alone = polygons->count == 1;
    double least = is_small ? tolerance : 0.1 * tolerance;
    if (w->count == MOST_PIECES)
        return false;
    cut_polygon *piece = &w->pieces[w->count++];
    int creases = gather(w, at, polygons, polygon, alone && w->judge->sharp, &piece->polygon);
    piece->is_fan = false;
    if (!creases && is_whole && cut_without_apex(piece) &&
        find_distance(&w->probe, piece, least) <= tolerance) {
        if (alone)
            w->brick->flat |= (uint8_t)(1u << csg_brick_cell(at[0], at[1], at[2]));
        return true;
    }
    if (is_whole && !alone)
        return false;
    piece->is_fan = true;
    csg_apex_kind kind = csg_polygon_find_apex(&w->probe, &box, &piece->polygon, &piece->apex);
    return (kind != CSG_APEX_FAILED || is_small) &&
           find_distance(&w->probe, piece, least) <= tolerance;
}

static bool has_pierced_edge(const csg_brick *brick, const unsigned low[3])
{
    const unsigned high[3] = {low[0] + 1, low[1] + 1, low[2] + 1};
    return csg_brick_is_pierced(brick, low, high);
}

/* Cells that a pierced edge belongs to are crossed whatever their corners say. */
static void cross_pierced(csg_brick *brick)
{
    for (unsigned cell = 0; cell < CSG_BRICK_CELLS && brick->pierced; cell++) {
        const unsigned low[3] = {cell % E, cell / E % E, cell / (E * E)};
        brick->crossed |= (uint8_t)((unsigned)has_pierced_edge(brick, low) << cell);
    }
}

/* The polygons of all cells; notes which have several. */
static void make_polygons(cell_work *w)
{
    csg_shell shell = {.brick = w->brick};
    for (unsigned rest = w->brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest);
        const unsigned at[3] = {cell % E, cell / E % E, cell / (E * E)};
        csg_shell_cell place = csg_shell_cell_of(&shell, at[0], at[1], at[2]);
        csg_cell_faces faces = {w->bricks, w->brick, at, &w->probe, &w->room->pierced};
        csg_cell_polygons *polygons = &w->room->polygons[cell];
        csg_cell_polygons_make(polygons, &place, csg_cell_face_is_inside, &faces);
        if (polygons->count > 1)
            w->brick->several |= (uint8_t)(1u << cell);
    }
}

/* Whether a cell is small enough. Several polygons must be on their own sides of each other where
 * the cell has pierced edges; those of a whole cell are whatever their vertices. */
static bool is_good(cell_work *w, unsigned cell)
{
    const unsigned at[3] = {cell % E, cell / E % E, cell / (E * E)};
    const csg_cell_polygons *polygons = &w->room->polygons[cell];
    bool pierced = has_pierced_edge(w->brick, at);
    csg_cell_box box = csg_judge_cell_box(w->bricks, w->brick, at);
    bool good = !csg_cell_polygons_are_mixed(polygons);
    w->count = 0;
    for (unsigned i = 0; i < polygons->count && good; i++)
        good = cut_into_triangles(w, at, !pierced, polygons, i);
    good = good && (!pierced || are_apart(w, APART * box.cell));
    if (good)
        keep_triangles(w, cell);
    bool is_small = box.cell <= SEVERAL * w->judge->tolerance && !pierced;
    return good || (polygons->count > 1 && is_small);
}

uint8_t csg_judge_brick(void *user, uint32_t worker, const csg_bricks *b, csg_brick *brick,
                        const float *f)
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
    csg_pierce(&w.probe, b, brick, f, &room->pierced);
    brick->pierced = room->pierced.edges;
    cross_pierced(brick);
    brick->flat = brick->several = 0;
    collect_edges(b, brick, room);
    csg_judge_solve_edges(judge, b, brick, room);
    room->triangle_count = 0;
    memset(room->first_triangle, 0, sizeof room->first_triangle);
    memset(room->end_triangle, 0, sizeof room->end_triangle);
    make_polygons(&w);
    if (judge->sharp)
        find_creases(&w.probe, room, b, brick);
    unsigned wanted = 0;
    for (unsigned rest = brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest);
        wanted |= (unsigned)!is_good(&w, cell) << cell;
    }
    /* Where nothing is hidden in a cell, nothing is in a brick in its place. */
    uint8_t cells = (uint8_t)(CSG_BRICK_ALL_CELLS & ~(wanted | brick->searched));
    if (cells && !is_finest) {
        wanted |= csg_hunt(&w.probe, b, brick, judge->tolerance, f, cells, &hunted);
        wanted |= find_uncovered(&w, cells & (uint8_t)~wanted);
        brick->searched |= cells & (uint8_t)~wanted;
    }
    room->evaluations += w.probe.evaluations;
    return (uint8_t)wanted;
}
