/* SPDX-License-Identifier: MIT
 * Cells one by one; see judge.h.
 */
#include "mesh/adaptive/judge.h"

#include <math.h>
#include <string.h>

#include "mesh/adaptive/hunt.h"

enum { E = CSG_BRICK_EDGE };

/* Where sheets do not meet although they should, and triangles are near the surface all the same,
 * cells of so many tolerances are small enough. */
static const double FAILURE = 1;
/* The same where a cell has several polygons. */
static const double SEVERAL = 1;
/* Of the tolerance: how near triangles between vertices in faces are; else a fan is made. */
static const double NEARER = 0.6;
/* The same: how far from where sheets meet the point may be in which their triangles do. */
static const double NEAR = 0.1;
/* Of a cell: how far beside each other's triangles its polygons are. */
static const double APART = 1e-3;

/* ---- edges -------------------------------------------------------------------------------------
 */

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

/* Appends an edge of the brick; of a pierced one its lower half, then its upper. */
static void add_edge(csg_judge_room *room, const csg_bricks *b, const csg_brick *brick, int axis,
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

/* Roots along edges that are collected, and gradients there. */
static void solve_edges(const csg_judge *judge, const csg_bricks *b, const csg_brick *brick,
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

/* Whether an edge of the brick has a vertex, or, pierced, two. */
static bool has_edge(const csg_judge_room *room, const csg_brick *brick, int axis,
                     const unsigned low[3])
{
    return csg_brick_is_crossed(brick, axis, low) ||
           (room->pierced.edges >> csg_brick_edge(axis, low) & 1);
}

static void collect_edges(const csg_bricks *b, const csg_brick *brick, csg_judge_room *room)
{
    room->edges.count = 0;
    room->edges.has_ends = false;
    for (unsigned slot = 0; slot < CSG_BRICK_SLOTS; slot++) {
        unsigned low[3];
        int axis = csg_slot_place(slot, low);
        if (low[axis] == E || !has_edge(room, brick, axis, low))
            continue;
        room->edge[0][slot] = (uint16_t)room->edges.count;
        add_edge(room, b, brick, axis, low);
        room->edge[1][slot] = (uint16_t)(room->edges.count - 1);
    }
}

bool csg_judge_may_fail(const csg_judge *judge, double cell)
{
    return cell <= FAILURE * judge->tolerance;
}

csg_sheet_probe csg_judge_probe(const csg_judge *judge, const csg_bricks *b, const csg_brick *brick,
                                csg_judge_room *room, csg_tape *tape)
{
    *tape = csg_bricks_tape(b, brick);
    return (csg_sheet_probe){.kernel = b->kernel,
                             .tape = tape,
                             .scratch = room->scratch,
                             .scratch_floats = room->scratch_floats,
                             .noise = (double)judge->noise,
                             .near = NEAR * judge->tolerance};
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
    return csg_brick_slot(axis, low);
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
    csg_face_crease f = {.face = *box, .is_wedge = side->pierced};
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

/* Looks for creases in the faces of cells with one polygon, and for those that all wedges have, in
 * each face once for both cells. */
static void find_creases(csg_sheet_probe *probe, csg_judge_room *room, const csg_bricks *b,
                         const csg_brick *brick, const csg_judge *judge)
{
    memset(room->face, CSG_NO_FACE, sizeof room->face);
    room->face_count = 0;
    for (unsigned rest = brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest), at[3];
        csg_brick_cell_place(cell, at);
        const csg_cell_polygons *polygons = &room->polygons[cell];
        csg_cell_box box = csg_judge_cell_box(b, brick, at);
        bool creased = judge->sharp && polygons->count == 1;
        for (unsigned i = 0; i < polygons->first[polygons->count]; i++) {
            const csg_polygon_side *side = &polygons->side[i];
            unsigned slot = slot_of_place(side->face, at, true);
            if (room->face[slot] != CSG_NO_FACE || !(side->pierced || (creased && side->alone)))
                continue;
            room->face[slot] = (uint8_t)room->face_count;
            room->faces[room->face_count++].part[CSG_BETWEEN] = face_of(room, &box, at, side);
        }
    }
    csg_sheets_find_in_faces(probe, room->faces, room->face_count, judge->bulge,
                             csg_judge_divides_sides(csg_bricks_cell(b, brick->level)));
}

typedef struct brick_work {
    const csg_judge *judge;
    const csg_bricks *bricks;
    csg_brick *brick;
    csg_judge_room *room;
    csg_sheet_probe probe;
    double cell;
    bool is_small; /* sheets may fail to meet */
    bool out_of_memory;
    double least; /* height of triangles that must look outwards */
    unsigned bad; /* cells that are to be divided */
    csg_cover cover;
} brick_work;

/* Keeps the triangles of a cell that is good. */
static void keep_triangles(csg_judge_room *room, unsigned cell)
{
    csg_brick_triangles *to = &room->triangles;
    to->first[cell] = to->count;
    for (int k = room->first_piece[cell]; k < room->end_piece[cell]; k++)
        for (int t = 0; t < csg_cut_triangle_count(&room->pieces[k]); t++) {
            int corner[3];
            if (to->count == CSG_COVER_MOST_TRIANGLES)
                return;
            csg_cut_triangle(&room->pieces[k], t, corner, to->at[to->count++]);
        }
    to->end[cell] = to->count;
}

/* Looks for what is hidden in cells, and for the surface away from their triangles. Those that are
 * to be divided. */
static uint8_t search(brick_work *w, const float *f, uint8_t cells)
{
    const csg_judge *judge = w->judge;
    csg_judge_room *room = w->room;
    csg_cover *cover = &w->cover;
    csg_hunted hunted;
    unsigned hidden = csg_hunt(&w->probe, w->bricks, w->brick, judge->tolerance, f, cells, &hunted);
    csg_cover_find(&room->triangles, w->bricks, w->brick, &hunted, judge->tolerance,
                   cells & (uint8_t)~hidden, cover);
    size_t count = room->unsure_count + (size_t)cover->unsure_count;
    if (!csg_memory_reserve(judge->memory, (void **)&room->unsure, &room->unsure_capacity, count,
                            sizeof *room->unsure)) {
        w->out_of_memory = true;
        return 0;
    }
    for (int i = 0; i < cover->unsure_count; i++)
        room->unsure[room->unsure_count++] = cover->unsure[i];
    return (uint8_t)(hidden | cover->uncovered);
}

/* ---- verdict -----------------------------------------------------------------------------------
 */

static bool has_pierced_edge(const csg_brick *brick, const unsigned low[3])
{
    const unsigned high[3] = {low[0] + 1, low[1] + 1, low[2] + 1};
    return csg_brick_is_pierced(brick, low, high);
}

/* Cells that a pierced edge belongs to are crossed whatever their corners say. */
static void cross_pierced(csg_brick *brick)
{
    for (unsigned cell = 0; cell < CSG_BRICK_CELLS && brick->pierced; cell++) {
        unsigned low[3];
        csg_brick_cell_place(cell, low);
        brick->crossed |= (uint8_t)((unsigned)has_pierced_edge(brick, low) << cell);
    }
}

/* The polygons of all cells; notes which have several. */
static void make_polygons(brick_work *w)
{
    csg_shell shell = {.brick = w->brick};
    for (unsigned rest = w->brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest), at[3];
        csg_brick_cell_place(cell, at);
        csg_shell_cell place = csg_shell_cell_of(&shell, at[0], at[1], at[2]);
        csg_cell_faces faces = {w->bricks, w->brick, at, &w->probe, &w->room->pierced};
        csg_cell_polygons *polygons = &w->room->polygons[cell];
        csg_cell_polygons_make(polygons, &w->judge->plain, &place, csg_cell_face_is_inside, &faces);
        if (polygons->count > 1)
            w->brick->several |= (uint8_t)(1u << cell);
    }
}

/* A vertex in a face. */
static void gather_part(const csg_face_crease *part, const csg_polygon_side *side, csg_polygon *p)
{
    if (!part->is_there)
        return;
    p->faces[p->count] = csg_local_faces(side->face);
    p->is_crease[p->count] = !part->is_smooth;
    p->point[p->count++] = (csg_surface_point){part->at, part->gradient};
    p->in_faces++;
}

/* The vertices of a polygon, and what is found in the faces between them. */
static void gather(const brick_work *w, unsigned cell, unsigned polygon, csg_polygon *p)
{
    const csg_judge_room *room = w->room;
    const csg_cell_polygons *polygons = &room->polygons[cell];
    unsigned at[3];
    csg_brick_cell_place(cell, at);
    p->count = p->in_faces = 0;
    p->is_torn = false;
    for (unsigned i = polygons->first[polygon]; i < polygons->first[polygon + 1]; i++) {
        const csg_polygon_side *side = &polygons->side[i];
        uint8_t face = room->face[slot_of_place(side->face, at, true)];
        p->vertex[p->count] = csg_local_edge(side->from);
        p->faces[p->count] = csg_local_faces(side->from);
        p->is_crease[p->count] = false;
        p->point[p->count++] = point_of(room, side->from, at);
        bool creased = polygons->count == 1 && side->alone;
        if (!(side->pierced || creased) || face == CSG_NO_FACE)
            continue;
        p->is_torn |= csg_face_side_is_torn(&room->faces[face]);
        for (unsigned k = 0; k < CSG_SIDE_PARTS; k++)
            gather_part(&room->faces[face].part[csg_side_part(side, k)], side, p);
    }
}

/* The polygons of the cells that may be good. */
static void gather_pieces(brick_work *w)
{
    csg_judge_room *room = w->room;
    room->piece_count = 0;
    for (unsigned rest = w->brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest);
        const csg_cell_polygons *polygons = &room->polygons[cell];
        room->first_piece[cell] = room->end_piece[cell] = (uint8_t)room->piece_count;
        if (polygons->count > CSG_JUDGED_MOST_PIECES || csg_cell_polygons_are_mixed(polygons)) {
            w->bad |= 1u << cell;
            continue;
        }
        for (unsigned i = 0; i < polygons->count; i++) {
            csg_cut_polygon *piece = &room->pieces[room->piece_count++];
            piece->cell = (uint8_t)cell;
            piece->number = (uint8_t)i;
            piece->is_cut = piece->is_fan = false;
            gather(w, cell, i, &piece->polygon);
        }
        room->end_piece[cell] = (uint8_t)room->piece_count;
    }
}

/* Cuts what can be cut without a point inside: polygons that have no creases. */
static void cut_plain(brick_work *w)
{
    csg_judge_room *room = w->room;
    csg_cut_polygon *tried[CSG_JUDGED_MOST_APEXES];
    int count = 0;
    for (int i = 0; i < room->piece_count; i++) {
        csg_cut_polygon *piece = &room->pieces[i];
        unsigned at[3];
        csg_brick_cell_place(piece->cell, at);
        if (!has_pierced_edge(w->brick, at) && !piece->polygon.is_torn &&
            csg_cut_without_apex(piece))
            tried[count++] = piece;
    }
    csg_cuts_find_distances(&w->probe, tried, count, w->least);
    for (int i = 0; i < count; i++) {
        double most = (tried[i]->polygon.in_faces ? NEARER : 1) * w->judge->tolerance;
        tried[i]->is_cut = tried[i]->distance <= most;
        if (tried[i]->is_cut && room->polygons[tried[i]->cell].count == 1)
            w->brick->flat |= (uint8_t)(1u << tried[i]->cell);
    }
}

/* Cuts the rest into fans. Several polygons of a whole cell have none: the points in their middles
 * know nothing of each other. */
static void cut_fans(brick_work *w)
{
    csg_judge_room *room = w->room;
    csg_apex_search searches[CSG_JUDGED_MOST_APEXES];
    csg_cut_polygon *fans[CSG_JUDGED_MOST_APEXES];
    int count = 0;
    for (int i = 0; i < room->piece_count; i++) {
        csg_cut_polygon *piece = &room->pieces[i];
        unsigned at[3];
        csg_brick_cell_place(piece->cell, at);
        if (piece->is_cut)
            continue;
        if (room->polygons[piece->cell].count > 1 && !has_pierced_edge(w->brick, at)) {
            w->bad |= 1u << piece->cell;
            continue;
        }
        searches[count] = (csg_apex_search){.box = csg_judge_cell_box(w->bricks, w->brick, at),
                                            .polygon = &piece->polygon};
        fans[count++] = piece;
    }
    csg_polygons_find_apexes(&w->probe, searches, count);
    for (int i = 0; i < count; i++) {
        fans[i]->is_fan = fans[i]->is_cut = true;
        fans[i]->apex = searches[i].at;
        fans[i]->kind = searches[i].kind;
    }
    csg_cuts_find_distances(&w->probe, fans, count, w->least);
    csg_cuts_settle_near(fans, count, w->judge->tolerance);
    for (int i = 0; i < count; i++)
        if ((csg_cut_has_failed(fans[i]) && !w->is_small) ||
            fans[i]->distance > w->judge->tolerance)
            w->bad |= 1u << fans[i]->cell;
}

bool csg_judge_are_apart(const csg_judge_room *room, unsigned cell, double size)
{
    for (int i = room->first_piece[cell]; i < room->end_piece[cell]; i++)
        for (int k = room->first_piece[cell]; k < i; k++)
            if (!csg_cuts_are_apart(&room->pieces[i], &room->pieces[k], APART * size))
                return false;
    return true;
}

/* Which cells are small enough. Several polygons must be on their own sides of each other where the
 * cell has pierced edges; those of a whole cell are whatever their vertices. */
static uint8_t find_bad(brick_work *w)
{
    csg_judge_room *room = w->room;
    gather_pieces(w);
    cut_plain(w);
    cut_fans(w);
    for (unsigned rest = w->brick->crossed; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest), at[3];
        csg_brick_cell_place(cell, at);
        bool pierced = has_pierced_edge(w->brick, at);
        if (pierced && !csg_judge_are_apart(room, cell, w->cell))
            w->bad |= 1u << cell;
        if (!(w->bad >> cell & 1))
            keep_triangles(room, cell);
        else if (room->polygons[cell].count > 1 && w->cell <= SEVERAL * w->judge->tolerance &&
                 !pierced)
            w->bad &= ~(1u << cell);
    }
    return (uint8_t)w->bad;
}

/* ---- what is kept for the mesh -----------------------------------------------------------------
 */

/* Vertices on edges of these cells. */
static uint8_t list_roots(const csg_judge_room *room, const csg_brick *brick, uint8_t cells,
                          csg_judged_root *roots)
{
    unsigned count = 0;
    for (unsigned slot = 0; slot < CSG_BRICK_SLOTS; slot++) {
        unsigned low[3];
        int axis = csg_slot_place(slot, low), from[3], to[3];
        for (int k = 0; k < 3; k++) {
            from[k] = 2 * (int)low[k];
            to[k] = from[k] + (k == axis ? 2 : 0);
        }
        if (low[axis] == E || !has_edge(room, brick, axis, low) ||
            !(csg_brick_cells_at(from, to) & cells))
            continue;
        unsigned first = room->edge[0][slot], last = room->edge[1][slot];
        for (unsigned i = first; i <= last; i++) {
            const csg_edges *e = &room->edges;
            const float(*g)[CSG_BLOCK_MOST_EDGES] = room->gradient;
            roots[count++] =
                (csg_judged_root){.at = {e->x[i], e->y[i], e->z[i]},
                                  .gradient = {g[0][i], g[1][i], g[2][i]},
                                  .slot = (uint8_t)slot,
                                  .quarters = (uint8_t)(first == last ? 2 : 1 + 2 * (i - first))};
        }
    }
    return (uint8_t)count;
}

static uint8_t list_creases(const csg_judge_room *room, csg_judged_crease *creases)
{
    unsigned count = 0;
    for (unsigned slot = 0; slot < CSG_BRICK_SLOTS; slot++) {
        uint8_t face = room->face[slot];
        for (unsigned k = 0; face != CSG_NO_FACE && k < CSG_SIDE_PARTS; k++)
            if (csg_judged_crease_of(&room->faces[face], k, &creases[count]))
                creases[count++].slot = (uint8_t)slot;
    }
    return (uint8_t)count;
}

static uint8_t list_apexes(const csg_judge_room *room, uint8_t cells, csg_judged_apex *apexes)
{
    unsigned count = 0;
    for (int i = 0; i < room->piece_count; i++) {
        const csg_cut_polygon *piece = &room->pieces[i];
        if (!piece->is_fan || !(cells >> piece->cell & 1))
            continue;
        apexes[count] = (csg_judged_apex){.cell = piece->cell,
                                          .polygon = piece->number,
                                          .in_faces = (uint8_t)piece->polygon.in_faces,
                                          .kind = (uint8_t)piece->kind};
        csg_vec3_to_floats(apexes[count++].at, piece->apex);
    }
    return (uint8_t)count;
}

/* The place of the surface that is farthest from its triangles, of each cell that was searched. */
static uint8_t list_places(const csg_cover *cover, uint8_t cells, csg_judged_apex *places)
{
    unsigned count = 0;
    for (unsigned rest = cover->off & cells; rest; rest &= rest - 1) {
        unsigned cell = (unsigned)__builtin_ctz(rest);
        places[count] = (csg_judged_apex){.cell = (uint8_t)cell, .polygon = CSG_JUDGED_NO_POLYGON};
        csg_vec3_to_floats(places[count++].at, cover->farthest[cell]);
    }
    return (uint8_t)count;
}

/* Of the cells that are not to be divided. False: out of memory. */
static bool keep(const brick_work *w, uint8_t cells)
{
    csg_judge_room *room = w->room;
    csg_judged_root roots[CSG_JUDGED_MOST_ROOTS];
    csg_judged_crease creases[CSG_JUDGED_MOST_CREASES];
    csg_judged_apex apexes[CSG_JUDGED_MOST_APEXES + CSG_BRICK_CELLS];
    csg_judged judged = {.roots = roots, .creases = creases, .apexes = apexes};
    if (!cells)
        return true;
    judged.root_count = list_roots(room, w->brick, cells, roots);
    judged.crease_count = list_creases(room, creases);
    judged.apex_count = list_apexes(room, cells, apexes);
    if (w->judge->tells_seen)
        judged.apex_count += list_places(&w->cover, cells, apexes + judged.apex_count);
    judged.pierced = &room->pierced;
    w->brick->judged = csg_judged_keep(&room->found, &judged);
    return w->brick->judged != NULL;
}

/* ---- a brick -----------------------------------------------------------------------------------
 */

bool csg_judge_brick(void *user, uint32_t worker, const csg_bricks *b, csg_brick *brick,
                     const float *f)
{
    const csg_judge *judge = user;
    csg_judge_room *room = &judge->rooms[worker];
    bool is_finest = brick->level == b->finest;
    double cell = csg_bricks_cell(b, brick->level) * b->lattice->cell_size;
    csg_tape tape;
    brick_work w = {.judge = judge,
                    .bricks = b,
                    .brick = brick,
                    .room = room,
                    .probe = csg_judge_probe(judge, b, brick, room, &tape),
                    .cell = cell,
                    .is_small = csg_judge_may_fail(judge, cell),
                    .cover = {.off = 0}};
    w.least = w.is_small ? judge->tolerance : 0.1 * judge->tolerance;
    csg_pierce(&w.probe, b, brick, f, &room->pierced);
    brick->pierced = room->pierced.edges;
    cross_pierced(brick);
    brick->flat = brick->several = 0;
    collect_edges(b, brick, room);
    solve_edges(judge, b, brick, room);
    room->triangles.count = 0;
    memset(room->triangles.first, 0, sizeof room->triangles.first);
    memset(room->triangles.end, 0, sizeof room->triangles.end);
    make_polygons(&w);
    find_creases(&w.probe, room, b, brick, judge);
    unsigned wanted = find_bad(&w);
    /* Where nothing is hidden in a cell, nothing is in a brick in its place. */
    uint8_t cells = (uint8_t)(CSG_BRICK_ALL_CELLS & ~(wanted | brick->searched));
    if (cells && !is_finest) {
        wanted |= search(&w, f, cells);
        brick->searched |= cells & (uint8_t)~wanted;
    }
    room->evaluations += w.probe.evaluations;
    brick->wanted = is_finest ? 0 : (uint8_t)wanted;
    return !w.out_of_memory && keep(&w, brick->crossed & (uint8_t)~brick->wanted);
}

bool csg_judge_joined(void *user, csg_bricks *bricks, size_t first)
{
    csg_judge *judge = user;
    bool done = csg_judged_keep_own(&judge->kept, bricks, first);
    for (uint32_t i = 0; i < bricks->worker_count && done; i++)
        csg_arena_reset(&judge->rooms[i].found);
    return done;
}

/* ---- other ranks -------------------------------------------------------------------------------
 */

bool csg_judge_tell(void *user, const csg_brick *brick, csg_records *records)
{
    const csg_judge *judge = user;
    return csg_judged_pack(judge->memory, brick->judged, records);
}

bool csg_judge_hear(void *user, csg_brick *brick, csg_record_reader *reader, size_t item)
{
    const csg_judge *judge = user;
    return csg_judged_unpack(&judge->rooms[0].found, reader, item, &brick->judged);
}
