/* SPDX-License-Identifier: MIT
 * Edges, faces, polygons; see cells.h. What the judge has found is taken from there; beside
 * finer leaves the rest is found here.
 */
#include "mesh/adaptive/cells.h"

#include <string.h>

enum { E = CSG_BRICK_EDGE };

/* ---- edges -------------------------------------------------------------------------------------
 */

/* A point of an edge along an axis, both in quarters of the cell at its lower point. */
static unsigned local_on_edge(int axis, unsigned quarters)
{
    static const unsigned stride[3] = {1, 5, 25};
    return quarters * stride[axis];
}

static bool is_divided(const csg_shell *s, int axis, const unsigned low[3])
{
    return s->has_finer && s->divided_edges[axis][low[2]][low[1]] >> low[0] & 1;
}

/* Those that the judge has found. */
static bool visit_edges(csg_cell_loop *w, uint32_t worker_index, const csg_shell *s)
{
    const csg_judged *judged = s->brick->judged;
    for (unsigned i = 0; judged && i < judged->root_count; i++) {
        const csg_judged_root *root = &judged->roots[i];
        unsigned low[3];
        int axis = csg_slot_place(root->slot, low);
        if (is_divided(s, axis, low) || !csg_brick_owns_edge(s->around, axis, low))
            continue;
        csg_placed_vertex v = {.place = csg_cells_place(w->x->bricks, s->brick, low,
                                                        local_on_edge(axis, root->quarters))};
        memcpy(v.at, root->at, sizeof v.at);
        memcpy(v.gradient, root->gradient, sizeof v.gradient);
        if (!csg_cells_add_vertex(w, worker_index, &v))
            return false;
    }
    return true;
}

/* ---- cells -------------------------------------------------------------------------------------
 */

bool csg_cells_each(csg_cell_loop *w, uint32_t worker_index, const csg_shell *s,
                    csg_visit_cell *visit)
{
    csg_tape tape;
    csg_judge_room *room = &w->x->judge->rooms[worker_index];
    csg_sheet_probe probe = csg_judge_probe(w->x->judge, w->x->bricks, s->brick, room, &tape);
    const csg_pierced *pierced = csg_judged_pierced(s->brick->judged);
    unsigned cells = s->has_finer ? CSG_BRICK_ALL_CELLS : s->brick->crossed;
    for (cells &= ~(unsigned)s->brick->divided; cells; cells &= cells - 1) {
        unsigned bit = (unsigned)__builtin_ctz(cells);
        csg_cell_at_hand cell = {.loop = w, .worker = worker_index, .shell = s, .probe = &probe};
        csg_brick_cell_place(bit, cell.at);
        csg_shell_cell place = csg_shell_cell_of(s, cell.at[0], cell.at[1], cell.at[2]);
        cell.is_whole = !place.divided;
        cell.is_border = place.divided & ~place.pierced;
        csg_cell_faces faces = {w->x->bricks, s->brick, cell.at, &probe, pierced};
        csg_cell_polygons_make(&cell.polygons, &w->x->judge->plain, &place, csg_cell_face_is_inside,
                               &faces);
        if (cell.polygons.count && !visit(&cell))
            return false;
    }
    room->evaluations += probe.evaluations;
    return true;
}

static bool has_several(const csg_brick *brick, const unsigned at[3])
{
    return brick->several >> csg_brick_cell(at[0], at[1], at[2]) & 1;
}

static csg_surface_point point_of(const csg_placed_vertex *v)
{
    return (csg_surface_point){csg_vec3_from_floats(v->at), csg_vec3_from_floats(v->gradient)};
}

/* ---- faces -------------------------------------------------------------------------------------
 */

/* The axis of a whole face by its middle, and its side; -1: of a quarter, which finer leaves have.
 */
static int axis_of_face(unsigned local, unsigned *side)
{
    unsigned q[3];
    csg_local_place(local, q);
    for (int axis = 0; axis < 3; axis++) {
        if (q[axis] % 2)
            return -1;
        if (q[axis] != 2) {
            *side = q[axis] / 4;
            return (q[(axis + 1) % 3] == 2 && q[(axis + 2) % 3] == 2) ? axis : -1;
        }
    }
    return -1;
}

/* Whether the face is for this cell to look into: of two cells the lower one's, of two leaves that
 * of the lower number, and, but beside a pierced edge, not where one cell has several polygons. */
static bool is_for(const csg_cell_at_hand *c, int axis, unsigned side, bool pierced)
{
    const csg_shell *s = c->shell;
    unsigned low[3] = {c->at[0], c->at[1], c->at[2]}, next[3] = {c->at[0], c->at[1], c->at[2]};
    low[axis] += side;
    if (!pierced && has_several(s->brick, c->at))
        return false;
    if (low[axis] > 0 && low[axis] < E) {
        next[axis] = side ? low[axis] : low[axis] - 1;
        return side && (pierced || !has_several(s->brick, next));
    }
    static const uint32_t stride[3] = {1, 3, 9};
    uint32_t beyond = s->around[side ? 13 + stride[axis] : 13 - stride[axis]];
    next[axis] = side ? 0 : E - 1;
    if (!pierced && beyond != CSG_BRICK_NONE &&
        has_several(&c->loop->x->bricks->items[beyond], next))
        return false;
    return csg_brick_owns_face(s->around, axis, low);
}

/* Whether a side of a polygon goes from one edge of the cell to another that nothing finer divides:
 * then the judge has seen it. */
static bool is_judged(const csg_cell_at_hand *c, const csg_polygon_side *side)
{
    unsigned from[3], to[3];
    csg_local_place(side->from, from);
    csg_local_place(side->to, to);
    bool whole = true;
    for (int k = 0; k < 3; k++)
        whole = whole && from[k] % 2 == 0 && to[k] % 2 == 0;
    return whole || !c->is_border;
}

/* What is in a face that the judge has not seen. False: which the cell will say, there is no vertex
 * at one end. */
static bool find_in_face(csg_cell_at_hand *c, const csg_polygon_side *side, int axis,
                         unsigned upper, csg_face_side *found)
{
    csg_cell_loop *w = c->loop;
    const csg_bricks *b = w->x->bricks;
    const csg_brick *brick = c->shell->brick;
    csg_face_crease *face = &found->part[CSG_BETWEEN];
    *face =
        (csg_face_crease){.face = csg_judge_cell_box(b, brick, c->at), .is_wedge = side->pierced};
    double plane = upper ? face->face.high[axis] : face->face.low[axis];
    face->face.low[axis] = face->face.high[axis] = plane;
    unsigned first = side->from < side->to ? side->from : side->to;
    unsigned last = side->from < side->to ? side->to : side->from;
    uint32_t a = csg_cells_find_vertex(w, csg_cells_place(b, brick, c->at, first));
    uint32_t z = csg_cells_find_vertex(w, csg_cells_place(b, brick, c->at, last));
    if (a == CSG_TABLE_NONE || z == CSG_TABLE_NONE)
        return false;
    face->ends[0] = point_of(&w->vertices[a]);
    face->ends[1] = point_of(&w->vertices[z]);
    csg_sheets_find_in_faces(c->probe, found, 1, w->x->judge->bulge,
                             csg_judge_divides_sides(csg_bricks_cell(b, brick->level)));
    return true;
}

/* Whether the judge knows a vertex in that part of the side. */
static bool take_judged(const csg_cell_at_hand *c, int axis, unsigned upper, unsigned part,
                        csg_judged_crease *out)
{
    unsigned low[3] = {c->at[0], c->at[1], c->at[2]};
    low[axis] += upper;
    const csg_judged_crease *found =
        csg_judged_crease_in(c->shell->brick->judged, csg_brick_slot(axis, low), part);
    if (found)
        *out = *found;
    return found != NULL;
}

static bool add_crease(csg_cell_at_hand *c, const csg_polygon_side *side,
                       const csg_judged_crease *found)
{
    csg_cell_loop *w = c->loop;
    csg_placed_vertex v = {
        .place = csg_cells_place_of_part(w->x->bricks, c->shell->brick, c->at, side, found->part),
        .is_crease = !found->is_smooth,
        .is_torn = found->is_torn};
    memcpy(v.at, found->at, sizeof v.at);
    memcpy(v.gradient, found->gradient, sizeof v.gradient);
    w->workers[c->worker].creases += v.is_crease;
    return csg_cells_add_vertex(w, c->worker, &v);
}

static bool look_into_faces(csg_cell_at_hand *c)
{
    csg_cell_loop *w = c->loop;
    for (unsigned i = 0; i < c->polygons.first[c->polygons.count]; i++) {
        const csg_polygon_side *side = &c->polygons.side[i];
        unsigned upper;
        int axis = axis_of_face(side->face, &upper);
        if (axis < 0 || (!side->alone && !side->pierced) || side->along_edge ||
            (!side->pierced && !w->x->judge->sharp) || !is_for(c, axis, upper, side->pierced))
            continue;
        csg_face_side found;
        bool judged = is_judged(c, side);
        if (!judged && !find_in_face(c, side, axis, upper, &found))
            continue;
        for (unsigned part = 0; part < CSG_SIDE_PARTS; part++) {
            csg_judged_crease crease;
            if ((judged ? take_judged(c, axis, upper, part, &crease)
                        : csg_judged_crease_of(&found, part, &crease)) &&
                !add_crease(c, side, &crease))
                return false;
        }
    }
    return true;
}

static bool visit_faces(csg_cell_loop *w, uint32_t worker_index, const csg_shell *s)
{
    return csg_cells_each(w, worker_index, s, look_into_faces);
}

csgm_status csg_cells_find_vertices(csg_cell_loop *w, double before, double amount)
{
    csgm_status status = csg_cell_loop_run(w, visit_edges, before, 0.5 * amount);
    if (status == CSGM_OK)
        status = csg_cell_loop_enter(w);
    size_t edges = w->count;
    if (status == CSGM_OK)
        status = csg_cell_loop_run(w, visit_faces, before + 0.5 * amount, 0.5 * amount);
    if (status == CSGM_OK && w->count > edges)
        status = csg_cell_loop_enter(w);
    return status;
}

csgm_status csg_cells_find_vertices_around(csg_cell_loop *w, const uint8_t *marks, double before,
                                           double amount)
{
    csgm_status status = csg_cell_loop_list_marked(w, marks, CSG_MARK_AROUND);
    if (status != CSGM_OK)
        return status;
    csg_cell_loop_keep_shells(w);
    return csg_cells_find_vertices(w, before, amount);
}

/* ---- polygons ----------------------------------------------------------------------------------
 */

bool csg_cells_is_missing(const csg_cell_at_hand *c)
{
    atomic_store(&c->loop->broken, true);
    return false;
}

/* Appends what is in a part of a side. False: there is no room. */
static bool gather_part(const csg_cell_at_hand *c, const csg_polygon_side *side, unsigned part,
                        csg_polygon *out)
{
    const csg_cell_loop *w = c->loop;
    uint32_t v = csg_cells_find_vertex(
        w, csg_cells_place_of_part(w->x->bricks, c->shell->brick, c->at, side, part));
    if (v == CSG_TABLE_NONE || (side->pierced && part != CSG_BETWEEN))
        return true;
    if (out->count == CSG_POLYGON_MOST)
        return false;
    out->vertex[out->count] = v;
    out->faces[out->count] = csg_local_faces(side->face);
    out->is_crease[out->count] = w->vertices[v].is_crease;
    out->is_torn |= w->vertices[v].is_torn;
    out->point[out->count++] = point_of(&w->vertices[v]);
    out->in_faces++;
    return true;
}

/* Whether there may be vertices in the side's face: not where the cell has several polygons, but
 * finer leaves beyond a quarter of one have theirs. */
static bool may_be_creased(const csg_cell_at_hand *c, const csg_polygon_side *side)
{
    unsigned upper;
    return !has_several(c->shell->brick, c->at) || axis_of_face(side->face, &upper) < 0;
}

bool csg_cells_gather(csg_cell_at_hand *c, unsigned polygon, csg_polygon *out)
{
    csg_cell_loop *w = c->loop;
    const csg_brick *brick = c->shell->brick;
    out->count = out->in_faces = 0;
    out->is_torn = false;
    for (unsigned i = c->polygons.first[polygon]; i < c->polygons.first[polygon + 1]; i++) {
        const csg_polygon_side *side = &c->polygons.side[i];
        uint32_t v =
            csg_cells_find_vertex(w, csg_cells_place(w->x->bricks, brick, c->at, side->from));
        if (v == CSG_TABLE_NONE || out->count == CSG_POLYGON_MOST)
            return csg_cells_is_missing(c);
        out->vertex[out->count] = v;
        out->faces[out->count] = csg_local_faces(side->from);
        out->is_crease[out->count] = false;
        out->point[out->count++] = point_of(&w->vertices[v]);
        if (!side->pierced && !(side->alone && !side->along_edge && may_be_creased(c, side)))
            continue;
        int before = out->count;
        for (unsigned k = 0; k < CSG_SIDE_PARTS; k++)
            if (!gather_part(c, side, csg_side_part(side, k), out))
                return csg_cells_is_missing(c);
        if (side->pierced && out->count == before)
            return csg_cells_is_missing(c);
    }
    return true;
}

csg_cut_polygon *csg_cells_set_aside(csg_cell_at_hand *c, unsigned polygon)
{
    csg_judge_room *room = &c->loop->x->judge->rooms[c->worker];
    csg_cut_polygon *piece = &room->pieces[room->piece_count];
    piece->cell = (uint8_t)csg_cells_bit(c);
    piece->is_fan = true;
    if (!csg_cells_gather(c, polygon, &piece->polygon))
        return NULL;
    room->piece_count++;
    return piece;
}

void csg_cells_find_apexes(csg_cell_loop *loop, uint32_t worker, const csg_shell *s)
{
    csg_judge_room *room = &loop->x->judge->rooms[worker];
    csg_apex_search searches[CSG_JUDGED_MOST_APEXES];
    csg_tape tape;
    csg_sheet_probe probe = csg_judge_probe(loop->x->judge, loop->x->bricks, s->brick, room, &tape);
    for (int i = 0; i < room->piece_count; i++) {
        unsigned at[3];
        csg_brick_cell_place(room->pieces[i].cell, at);
        searches[i] = (csg_apex_search){.box = csg_judge_cell_box(loop->x->bricks, s->brick, at),
                                        .polygon = &room->pieces[i].polygon};
    }
    csg_polygons_find_apexes(&probe, searches, room->piece_count);
    for (int i = 0; i < room->piece_count; i++) {
        room->pieces[i].apex = searches[i].at;
        room->pieces[i].kind = searches[i].kind;
    }
    room->evaluations += probe.evaluations;
}
