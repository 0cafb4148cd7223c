/* SPDX-License-Identifier: MIT
 * Three parallel loops over the leaves: edges, faces, cells. What each finds is joined in the order
 * of the leaves, and found again by the place of the edge or face. See extract.h.
 */
#include "mesh/adaptive/extract.h"

#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/trace.h"

enum { E = CSG_BRICK_EDGE, LEAVES_PER_ITEM = 16 };

/* A vertex and the edge or face that it lies on, by its middle. */
typedef struct placed_vertex {
    uint64_t place;
    float at[3], gradient[3];
    bool is_crease;
} placed_vertex;

/* Of an apex, in a triangle: its number in the item, later in the mesh. */
#define OWN UINT32_C(0x80000000)

/* What one item of a loop made, and where it is. */
typedef struct segment {
    uint32_t worker;
    size_t first, count, first_corner, corner_count;
} segment;

typedef struct worker {
    placed_vertex *vertices;
    uint32_t *corners;
    size_t count, capacity, corner_count, corner_capacity;
    size_t item; /* at hand */
    uint64_t creases, smooth;
} worker;

typedef struct work {
    csg_extraction *x;
    uint32_t *leaves;
    size_t leaf_count, leaf_capacity, item_count;
    worker *workers;
    uint32_t worker_count;
    segment *segments;
    placed_vertex *vertices; /* joined: of edges, then of faces, then of cells */
    size_t count, capacity;
    csg_table index; /* of those of edges and faces, by place */
    uint32_t *corners;
    size_t corner_count;
    bool (*visit)(struct work *w, uint32_t worker, const csg_shell *shell);
    double before, amount; /* of the stage's progress */
    atomic_bool any;
    atomic_bool broken; /* an edge or face has not what its cells expect of it */
} work;

/* ---- places ------------------------------------------------------------------------------------
 */

/* The middle of an edge or face of a cell, in half cells of the finest level: it is no other's. */
static uint64_t place_of(const csg_bricks *b, const csg_brick *brick, const unsigned cell[3],
                         unsigned local)
{
    unsigned q[3];
    uint64_t place = 0, size = csg_bricks_cell(b, brick->level);
    csg_local_place(local, q);
    for (int axis = 0; axis < 3; axis++)
        place |= (2 * (uint64_t)csg_brick_point(b, brick, axis, cell[axis]) + q[axis] * size / 2)
                 << (21 * axis);
    return place;
}

static uint64_t hash_of_place(uint64_t place)
{
    return csg_hash_word(CSG_HASH_START, place);
}

static uint32_t find_vertex(const work *w, uint64_t place)
{
    size_t slot;
    uint32_t found = csg_table_first(&w->index, hash_of_place(place), &slot);
    while (found != CSG_TABLE_NONE && w->vertices[found].place != place)
        found = csg_table_next(&w->index, &slot);
    return found;
}

/* A point of an edge along an axis, both in quarters of the cell at its lower point. */
static unsigned local_on_edge(int axis, unsigned quarters)
{
    static const unsigned stride[3] = {1, 5, 25};
    return quarters * stride[axis];
}

/* ---- what is made ------------------------------------------------------------------------------
 */

static bool add_vertex(work *w, worker *self, const placed_vertex *vertex)
{
    if (!csg_memory_reserve(&w->x->context->memory, (void **)&self->vertices, &self->capacity,
                            self->count + 1, sizeof *vertex))
        return csg_mesh_stop_without_memory(w->x->watch);
    self->vertices[self->count++] = *vertex;
    return true;
}

static bool add_triangle(work *w, worker *self, uint32_t a, uint32_t b, uint32_t c)
{
    if (!csg_memory_reserve(&w->x->context->memory, (void **)&self->corners, &self->corner_capacity,
                            self->corner_count + 3, sizeof a))
        return csg_mesh_stop_without_memory(w->x->watch);
    self->corners[self->corner_count++] = a;
    self->corners[self->corner_count++] = b;
    self->corners[self->corner_count++] = c;
    return true;
}

/* ---- edges -------------------------------------------------------------------------------------
 */

static bool is_divided(const csg_shell *s, int axis, const unsigned low[3])
{
    return s->has_finer && s->divided_edges[axis][low[2]][low[1]] >> low[0] & 1;
}

/* Those that the judge has found. */
static bool visit_edges(work *w, uint32_t worker_index, const csg_shell *s)
{
    const csg_judged *judged = s->brick->judged;
    for (unsigned i = 0; judged && i < judged->root_count; i++) {
        const csg_judged_root *root = &judged->roots[i];
        unsigned low[3];
        int axis = csg_slot_place(root->slot, low);
        if (is_divided(s, axis, low) || !csg_shell_owns_edge(s, axis, low))
            continue;
        placed_vertex v = {
            .place = place_of(w->x->bricks, s->brick, low, local_on_edge(axis, root->quarters))};
        memcpy(v.at, root->at, sizeof v.at);
        memcpy(v.gradient, root->gradient, sizeof v.gradient);
        if (!add_vertex(w, &w->workers[worker_index], &v))
            return false;
    }
    return true;
}

/* ---- cells -------------------------------------------------------------------------------------
 */

typedef struct cell_at_hand {
    work *w;
    uint32_t worker;
    const csg_shell *shell;
    unsigned at[3];
    bool is_whole;  /* none of its edges and faces is divided */
    bool is_border; /* finer leaves divide some of them: the judge has not seen it like that */
    csg_cell_polygons polygons;
    csg_sheet_probe *probe;
} cell_at_hand;

typedef bool visit_cell(cell_at_hand *cell);

/* Calls visit for each cell that has a polygon. */
static bool each_cell(work *w, uint32_t worker_index, const csg_shell *s, visit_cell *visit)
{
    csg_tape tape;
    csg_judge_room *room = &w->x->judge->rooms[worker_index];
    csg_sheet_probe probe = csg_judge_probe(w->x->judge, w->x->bricks, s->brick, room, &tape);
    const csg_pierced *pierced = csg_judged_pierced(s->brick->judged);
    unsigned cells = s->has_finer ? CSG_BRICK_ALL_CELLS : s->brick->crossed;
    for (cells &= ~(unsigned)s->brick->divided; cells; cells &= cells - 1) {
        unsigned bit = (unsigned)__builtin_ctz(cells);
        cell_at_hand cell = {.w = w,
                             .worker = worker_index,
                             .shell = s,
                             .at = {bit % E, bit / E % E, bit / (E * E)},
                             .probe = &probe};
        csg_shell_cell place = csg_shell_cell_of(s, cell.at[0], cell.at[1], cell.at[2]);
        cell.is_whole = !place.divided;
        cell.is_border = place.divided & ~place.pierced;
        csg_cell_faces faces = {w->x->bricks, s->brick, cell.at, &probe, pierced};
        csg_cell_polygons_make(&cell.polygons, &place, csg_cell_face_is_inside, &faces);
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

static csg_surface_point point_of(const placed_vertex *v)
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
static bool is_for(const cell_at_hand *c, int axis, unsigned side, bool pierced)
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
    if (!pierced && beyond != CSG_BRICK_NONE && has_several(&c->w->x->bricks->items[beyond], next))
        return false;
    return csg_shell_owns_face(s, axis, low);
}

/* Whether a side of a polygon goes from one edge of the cell to another that nothing finer divides:
 * then the judge has seen it. */
static bool is_judged(const cell_at_hand *c, const csg_polygon_side *side)
{
    unsigned from[3], to[3];
    csg_local_place(side->from, from);
    csg_local_place(side->to, to);
    bool whole = true;
    for (int k = 0; k < 3; k++)
        whole = whole && from[k] % 2 == 0 && to[k] % 2 == 0;
    return whole || !c->is_border;
}

/* What is in a face that the judge has not seen. False: nothing, or, which the cell will say, there
 * is no vertex at one end. */
static bool find_crease(cell_at_hand *c, const csg_polygon_side *side, int axis, unsigned upper,
                        float at[3])
{
    work *w = c->w;
    const csg_bricks *b = w->x->bricks;
    const csg_brick *brick = c->shell->brick;
    csg_face_crease face = {.face = csg_judge_cell_box(b, brick, c->at), .is_wedge = side->pierced};
    double plane = upper ? face.face.high[axis] : face.face.low[axis];
    face.face.low[axis] = face.face.high[axis] = plane;
    unsigned first = side->from < side->to ? side->from : side->to;
    unsigned last = side->from < side->to ? side->to : side->from;
    uint32_t a = find_vertex(w, place_of(b, brick, c->at, first));
    uint32_t z = find_vertex(w, place_of(b, brick, c->at, last));
    if (a == CSG_TABLE_NONE || z == CSG_TABLE_NONE)
        return false;
    face.ends[0] = point_of(&w->vertices[a]);
    face.ends[1] = point_of(&w->vertices[z]);
    csg_sheets_meet_in_faces(c->probe, &face, 1);
    csg_vec3_to_floats(at, face.at);
    return face.is_there;
}

static bool look_into_faces(cell_at_hand *c)
{
    work *w = c->w;
    const csg_brick *brick = c->shell->brick;
    for (unsigned i = 0; i < c->polygons.first[c->polygons.count]; i++) {
        const csg_polygon_side *side = &c->polygons.side[i];
        unsigned upper;
        int axis = axis_of_face(side->face, &upper);
        if (axis < 0 || (!side->alone && !side->pierced) || side->along_edge ||
            (!side->pierced && !w->x->judge->sharp) || !is_for(c, axis, upper, side->pierced))
            continue;
        placed_vertex v = {.place = place_of(w->x->bricks, brick, c->at, side->crease),
                           .is_crease = true};
        if (is_judged(c, side)) {
            unsigned low[3] = {c->at[0], c->at[1], c->at[2]};
            low[axis] += upper;
            const csg_judged_crease *found =
                csg_judged_crease_in(brick->judged, csg_brick_slot(axis, low));
            if (!found)
                continue;
            memcpy(v.at, found->at, sizeof v.at);
        } else if (!find_crease(c, side, axis, upper, v.at)) {
            continue;
        }
        w->workers[c->worker].creases++;
        if (!add_vertex(w, &w->workers[c->worker], &v))
            return false;
    }
    return true;
}

static bool visit_faces(work *w, uint32_t worker_index, const csg_shell *s)
{
    return each_cell(w, worker_index, s, look_into_faces);
}

/* ---- triangles ---------------------------------------------------------------------------------
 */

static bool is_missing(const cell_at_hand *c)
{
    atomic_store(&c->w->broken, true);
    return false;
}

/* Vertices of one of the cell's polygons, crease points between them. False: one is missing, or
 * there are too many, which cannot be. */
static bool gather(cell_at_hand *c, unsigned polygon, csg_polygon *out)
{
    work *w = c->w;
    const csg_brick *brick = c->shell->brick;
    bool creased = !has_several(brick, c->at);
    out->count = 0;
    for (unsigned i = c->polygons.first[polygon]; i < c->polygons.first[polygon + 1]; i++) {
        const csg_polygon_side *side = &c->polygons.side[i];
        uint32_t v = find_vertex(w, place_of(w->x->bricks, brick, c->at, side->from));
        if (v == CSG_TABLE_NONE || out->count + 2 > CSG_POLYGON_MOST)
            return is_missing(c);
        out->vertex[out->count] = v;
        out->is_crease[out->count] = false;
        out->point[out->count++] = point_of(&w->vertices[v]);
        uint32_t crease = CSG_TABLE_NONE;
        if (side->pierced || (creased && side->alone && !side->along_edge))
            crease = find_vertex(w, place_of(w->x->bricks, brick, c->at, side->crease));
        if (side->pierced && crease == CSG_TABLE_NONE)
            return is_missing(c);
        if (crease == CSG_TABLE_NONE)
            continue;
        out->vertex[out->count] = crease;
        out->is_crease[out->count] = true;
        out->point[out->count++] = point_of(&w->vertices[crease]);
    }
    return true;
}

/* Wants a cell divided, as long as there are smaller ones. */
static void want_divided(const cell_at_hand *c)
{
    csg_bricks *b = c->w->x->bricks;
    csg_brick *brick = &b->items[c->shell->number];
    if (brick->level == b->finest)
        return;
    brick->wanted |= (uint8_t)(1u << csg_brick_cell(c->at[0], c->at[1], c->at[2]));
    atomic_store(&c->w->any, true);
}

/* The point in the middle of a fan that the judge has not seen. Beside finer leaves the fan may
 * turn out to be too far from the surface. */
static csg_apex_kind find_apex(cell_at_hand *c, const csg_polygon *p, float at[3])
{
    const csg_extraction *x = c->w->x;
    csg_apex_search search = {.box = csg_judge_cell_box(x->bricks, c->shell->brick, c->at),
                              .polygon = p};
    csg_polygons_find_apexes(c->probe, &search, 1);
    csg_vec3_to_floats(at, search.at);
    if (c->is_whole)
        return search.kind;
    csg_piece piece = {.polygon = *p, .is_fan = true, .apex = search.at};
    csg_piece *const pieces[] = {&piece};
    csg_pieces_find_distances(c->probe, pieces, 1, x->judge->tolerance);
    if (piece.distance > x->farthest)
        want_divided(c);
    return search.kind;
}

/* A fan around a point of the cell. */
static bool fan(cell_at_hand *c, unsigned polygon, const csg_polygon *p)
{
    work *w = c->w;
    worker *self = &w->workers[c->worker];
    unsigned creases = 0;
    for (int i = 0; i < p->count; i++)
        creases += p->is_crease[i];
    const csg_judged_apex *judged =
        c->is_border
            ? NULL
            : csg_judged_apex_of(c->shell->brick->judged,
                                 csg_brick_cell(c->at[0], c->at[1], c->at[2]), polygon, creases);
    placed_vertex v;
    memset(&v, 0, sizeof v);
    csg_apex_kind kind = judged ? (csg_apex_kind)judged->kind : find_apex(c, p, v.at);
    if (judged)
        memcpy(v.at, judged->at, sizeof v.at);
    self->creases += kind == CSG_APEX_CREASE;
    self->smooth += kind == CSG_APEX_FAILED;
    v.is_crease = kind == CSG_APEX_CREASE;
    uint32_t number = OWN | (uint32_t)(self->count - w->segments[self->item].first);
    if (!add_vertex(w, self, &v))
        return false;
    for (int i = 0; i < p->count; i++)
        if (!add_triangle(w, self, number, p->vertex[i], p->vertex[(i + 1) % p->count]))
            return false;
    return true;
}

/* Triangles without a point inside, as csg_cell_cut cuts polygons of a whole cell. */
static bool cut_whole(cell_at_hand *c)
{
    work *w = c->w;
    for (unsigned polygon = 0; polygon < c->polygons.count; polygon++) {
        uint32_t vertex[CSG_CELL_EDGES] = {0};
        uint8_t edge[CSG_CELL_EDGES], triangles[CSG_CELL_MOST_INDICES + 3 * CSG_CELL_EDGES];
        int sides = 0;
        for (unsigned i = c->polygons.first[polygon]; i < c->polygons.first[polygon + 1]; i++) {
            unsigned from = c->polygons.side[i].from;
            uint32_t v = find_vertex(w, place_of(w->x->bricks, c->shell->brick, c->at, from));
            if (v == CSG_TABLE_NONE)
                return is_missing(c);
            edge[sides] = csg_local_edge(from);
            vertex[edge[sides++]] = v;
        }
        if (!csg_cell_cut(edge, sides, triangles)) {
            csg_polygon p; /* joined through faces: a loop that has no cut */
            if (!gather(c, polygon, &p) || !fan(c, polygon, &p))
                return false;
            continue;
        }
        for (int i = 0; i < 3 * (sides - 2); i += 3)
            if (!add_triangle(w, &w->workers[c->worker], vertex[triangles[i]],
                              vertex[triangles[i + 1]], vertex[triangles[i + 2]]))
                return false;
    }
    return true;
}

static bool make_triangles(cell_at_hand *c)
{
    const csg_brick *brick = c->shell->brick;
    csg_polygon p;
    if (has_several(brick, c->at) && c->is_whole)
        return cut_whole(c);
    for (unsigned polygon = 0; polygon < c->polygons.count; polygon++) {
        if (!gather(c, polygon, &p))
            return false;
        unsigned sides = c->polygons.first[polygon + 1] - c->polygons.first[polygon];
        bool plain = c->is_whole && (unsigned)p.count == sides;
        bool flat = brick->flat >> csg_brick_cell(c->at[0], c->at[1], c->at[2]) & 1;
        if (plain && c->polygons.count == 1 && flat)
            return cut_whole(c);
        if (!fan(c, polygon, &p))
            return false;
    }
    return true;
}

static bool visit_cells(work *w, uint32_t worker_index, const csg_shell *s)
{
    return each_cell(w, worker_index, s, make_triangles);
}

/* ---- borders -----------------------------------------------------------------------------------
 */

static bool want_simple(cell_at_hand *c)
{
    if (!c->is_whole && (c->polygons.count > 1 || has_several(c->shell->brick, c->at) ||
                         csg_cell_polygons_are_mixed(&c->polygons)))
        want_divided(c);
    return true;
}

static bool visit_borders(work *w, uint32_t worker_index, const csg_shell *s)
{
    csg_brick *brick = &w->x->bricks->items[s->number];
    if (s->pierced_beyond & ~brick->divided) {
        brick->wanted |= s->pierced_beyond & (uint8_t)~brick->divided;
        atomic_store(&w->any, true);
    }
    return !s->has_finer || each_cell(w, worker_index, s, want_simple);
}

/* Marks what a new brick, in the place of a cell, changes the border of: itself, and the bricks
 * around that cell. */
static void mark_changed(const csg_bricks *b, size_t number, uint8_t *changed)
{
    const csg_brick *brick = &b->items[number];
    changed[number] = 1;
    if (brick->level <= b->options.coarse)
        return;
    for (unsigned part = 0; part < CSG_OCTANTS; part++) {
        uint32_t at[3];
        csg_brick_beside(brick, part, at);
        uint32_t found = csg_bricks_find(b, brick->level - 1u, at);
        if (found != CSG_BRICK_NONE)
            changed[found] = 1;
    }
}

/* Lists the bricks whose borders are not known to be simple. False: out of memory. */
static bool list_unchecked(work *w)
{
    csg_memory *memory = &w->x->context->memory;
    const csg_bricks *b = w->x->bricks;
    uint8_t *changed = csg_memory_alloc(memory, b->count);
    if (!changed)
        return false;
    memset(changed, 0, b->count);
    for (size_t i = w->x->checked; i < b->count; i++)
        mark_changed(b, i, changed);
    bool done = true;
    for (size_t i = 0; i < b->count && done; i++) {
        bool has_leaves =
            b->items[i].divided != CSG_BRICK_ALL_CELLS && b->items[i].level >= b->options.coarse;
        if (!changed[i] || !has_leaves)
            continue;
        done = csg_memory_reserve(memory, (void **)&w->leaves, &w->leaf_capacity, w->leaf_count + 1,
                                  sizeof *w->leaves);
        if (done)
            w->leaves[w->leaf_count++] = (uint32_t)i;
    }
    csg_memory_release(memory, changed, b->count);
    w->x->checked = b->count;
    return done;
}

/* ---- loops -------------------------------------------------------------------------------------
 */

static bool visit_item(void *user, uint32_t worker_index, size_t item)
{
    work *w = user;
    worker *self = &w->workers[worker_index];
    csg_shell shell;
    if (csg_mesh_should_stop(w->x->watch))
        return false;
    self->item = item;
    w->segments[item] =
        (segment){.worker = worker_index, .first = self->count, .first_corner = self->corner_count};
    size_t end = (item + 1) * LEAVES_PER_ITEM;
    for (size_t i = item * LEAVES_PER_ITEM; i < end && i < w->leaf_count; i++) {
        csg_shell_make(&shell, w->x->bricks, w->leaves[i]);
        if (!w->visit(w, worker_index, &shell))
            return false;
    }
    w->segments[item].count = self->count - w->segments[item].first;
    w->segments[item].corner_count = self->corner_count - w->segments[item].first_corner;
    return true;
}

static void report(void *user, size_t done, size_t count)
{
    work *w = user;
    csg_mesh_report_progress(w->x->watch, w->before + w->amount * ((double)done / (double)count));
}

/* Vertices of all items behind those that are there, and corners, in the order of the leaves. */
static bool join_items(work *w)
{
    csg_memory *memory = &w->x->context->memory;
    size_t vertices = 0, corners = 0;
    for (size_t i = 0; i < w->item_count; i++) {
        vertices += w->segments[i].count;
        corners += w->segments[i].corner_count;
    }
    if (!csg_memory_reserve(memory, (void **)&w->vertices, &w->capacity, w->count + vertices + 1,
                            sizeof *w->vertices))
        return false;
    w->corners = corners ? csg_memory_alloc(memory, corners * sizeof *w->corners) : NULL;
    if (corners && !w->corners)
        return false;
    w->corner_count = corners;
    size_t at = 0;
    for (size_t i = 0; i < w->item_count; i++) {
        const segment *s = &w->segments[i];
        const worker *from = &w->workers[s->worker];
        for (size_t k = 0; k < s->corner_count; k++) {
            uint32_t v = from->corners[s->first_corner + k];
            w->corners[at++] = v & OWN ? (uint32_t)w->count + (v & ~OWN) : v;
        }
        if (s->count)
            memcpy(w->vertices + w->count, from->vertices + s->first,
                   s->count * sizeof *w->vertices);
        w->count += s->count;
    }
    for (uint32_t i = 0; i < w->worker_count; i++)
        w->workers[i].count = w->workers[i].corner_count = 0;
    return true;
}

/* Enters vertices from `first` on by their places. */
static bool enter(work *w, size_t first)
{
    csg_table_release(&w->index);
    csg_table_init(&w->index, &w->x->context->memory);
    if (!csg_table_reserve(&w->index, w->count + 1, NULL, NULL))
        return false;
    for (size_t i = first; i < w->count; i++)
        csg_table_add(&w->index, hash_of_place(w->vertices[i].place), (uint32_t)i);
    return true;
}

static csgm_status go(work *w, bool (*visit)(work *, uint32_t, const csg_shell *), double before,
                      double amount)
{
    w->visit = visit;
    w->before = before;
    w->amount = amount;
    bool done = csg_pool_run(w->x->context->pool, w->item_count, visit_item, report, w);
    if (!done)
        return atomic_load(&w->broken) ? csg_mesh_report_open(w->x->watch)
                                       : csg_mesh_why_stopped(w->x->watch);
    if (!join_items(w))
        return csg_context_no_memory(w->x->context);
    if (w->count < OWN)
        return CSGM_OK;
    csg_diag_plain(&w->x->context->diags, CSG_DIAG_TOO_FINE, NULL,
                   "mesh more coarsely: --quality draft, or -r",
                   "the mesh would have more than %u vertices", OWN - 1);
    return CSGM_ERR_LIMIT;
}

/* Of all leaves in Morton order. */
static bool list_all(work *w)
{
    bool done = csg_bricks_leaves(w->x->bricks, &w->leaves, &w->leaf_count);
    w->leaf_capacity = w->leaf_count;
    return done;
}

/* What is visited is listed by `list`. */
static csgm_status begin(work *w, csg_extraction *x, bool (*list)(work *))
{
    csg_memory *memory = &x->context->memory;
    *w = (work){.x = x, .worker_count = csg_pool_threads(x->context->pool)};
    csg_table_init(&w->index, memory);
    w->workers = csg_memory_alloc(memory, w->worker_count * sizeof(worker));
    if (w->workers)
        memset(w->workers, 0, w->worker_count * sizeof(worker));
    bool done = w->workers && list(w);
    w->item_count = (w->leaf_count + LEAVES_PER_ITEM - 1) / LEAVES_PER_ITEM;
    w->segments = done ? csg_memory_alloc(memory, (w->item_count + 1) * sizeof(segment)) : NULL;
    return w->segments ? CSGM_OK : csg_context_no_memory(x->context);
}

static void end(work *w)
{
    csg_memory *memory = &w->x->context->memory;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        worker *self = &w->workers[i];
        csg_memory_release(memory, self->vertices, self->capacity * sizeof *self->vertices);
        csg_memory_release(memory, self->corners, self->corner_capacity * sizeof *self->corners);
        w->x->creases += self->creases;
        w->x->smooth += self->smooth;
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof(worker));
    csg_memory_release(memory, w->leaves, w->leaf_capacity * sizeof *w->leaves);
    csg_memory_release(memory, w->segments, (w->item_count + 1) * sizeof(segment));
    csg_memory_release(memory, w->vertices, w->capacity * sizeof *w->vertices);
    csg_memory_release(memory, w->corners, w->corner_count * sizeof *w->corners);
    csg_table_release(&w->index);
}

csgm_status csg_extraction_check_borders(csg_extraction *x, bool *any)
{
    work w;
    csgm_status status = begin(&w, x, list_unchecked);
    if (status == CSGM_OK)
        status = go(&w, visit_borders, x->bricks->reported, 0);
    *any = atomic_load(&w.any);
    end(&w);
    return status;
}

static csgm_status fill_mesh(work *w)
{
    csg_extraction *x = w->x;
    csgm_status status =
        csg_mesh_create(x->context, w->count, w->corner_count / 3, false, x->colors, &x->mesh);
    if (status != CSGM_OK)
        return status;
    for (size_t i = 0; i < w->count; i++) {
        csg_vec3 at = csg_vec3_add(csg_vec3_from_floats(w->vertices[i].at), x->shift);
        csg_vec3_to_floats(x->mesh->positions + 3 * i, at);
    }
    if (w->corner_count)
        memcpy(x->mesh->indices, w->corners, w->corner_count * sizeof *w->corners);
    return CSGM_OK;
}

csgm_status csg_extract(csg_extraction *x, bool *any)
{
    CSG_ZONE(x->context, "extraction");
    work w;
    x->creases = x->smooth = 0;
    csgm_status status = begin(&w, x, list_all);
    if (status == CSGM_OK)
        status = go(&w, visit_edges, 0, 0.3);
    if (status == CSGM_OK && !enter(&w, 0))
        status = csg_context_no_memory(x->context);
    size_t edges = w.count;
    if (status == CSGM_OK)
        status = go(&w, visit_faces, 0.3, 0.3);
    if (status == CSGM_OK && w.count > edges && !enter(&w, 0))
        status = csg_context_no_memory(x->context);
    if (status == CSGM_OK)
        status = go(&w, visit_cells, 0.6, 0.4);
    *any = status == CSGM_OK && atomic_load(&w.any);
    if (status == CSGM_OK && !*any)
        status = fill_mesh(&w);
    end(&w);
    return status;
}
