/* SPDX-License-Identifier: MIT
 * Items of a few bricks each; see cell_loop.h.
 */
#include "mesh/adaptive/cell_loop.h"

#include <string.h>

#include "base/mesh_codes.h"
#include "base/rank_loop.h"

enum { BRICKS_PER_ITEM = 16 };

static size_t item_count(const csg_cell_loop *w)
{
    return (w->leaf_count + BRICKS_PER_ITEM - 1) / BRICKS_PER_ITEM;
}

/* ---- places ------------------------------------------------------------------------------------
 */

uint64_t csg_cells_place(const csg_bricks *b, const csg_brick *brick, const unsigned cell[3],
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

uint64_t csg_cells_place_of_part(const csg_bricks *b, const csg_brick *brick,
                                 const unsigned cell[3], const csg_polygon_side *side,
                                 unsigned part)
{
    unsigned q[3], axis = 0;
    csg_local_place(side->face, q);
    while (q[axis] % 4)
        axis++;
    axis = (axis + 1) % 3;
    uint64_t size = csg_bricks_cell(b, brick->level) / (q[axis] == 2 ? 1 : 2);
    uint64_t quarter = (size / 2) << (21 * axis);
    uint64_t place = csg_cells_place(b, brick, cell, side->crease);
    if (part == CSG_BETWEEN)
        return place;
    if (!csg_judge_divides_sides((uint32_t)size))
        return CSG_CELLS_NO_PLACE;
    return part == CSG_BELOW ? place - quarter : place + quarter;
}

static uint64_t hash_of_place(uint64_t place)
{
    return csg_hash_word(CSG_HASH_START, place);
}

uint32_t csg_cells_find_vertex(const csg_cell_loop *w, uint64_t place)
{
    size_t slot;
    uint32_t found = csg_table_first(&w->index, hash_of_place(place), &slot);
    while (found != CSG_TABLE_NONE && w->vertices[found].place != place)
        found = csg_table_next(&w->index, &slot);
    return found;
}

/* ---- what is made ------------------------------------------------------------------------------
 */

bool csg_cells_add_vertex(csg_cell_loop *w, uint32_t worker, const csg_placed_vertex *vertex)
{
    csg_cell_worker *self = &w->workers[worker];
    if (!csg_memory_reserve(&w->x->context->memory, (void **)&self->vertices, &self->capacity,
                            self->count + 1, sizeof *vertex))
        return csg_mesh_stop_without_memory(w->x->watch);
    self->vertices[self->count++] = *vertex;
    return true;
}

bool csg_cells_add_triangle(csg_cell_loop *w, uint32_t worker, uint32_t a, uint32_t b, uint32_t c)
{
    csg_cell_worker *self = &w->workers[worker];
    if (!csg_memory_reserve(&w->x->context->memory, (void **)&self->corners, &self->corner_capacity,
                            self->corner_count + 3, sizeof a))
        return csg_mesh_stop_without_memory(w->x->watch);
    self->corners[self->corner_count++] = a;
    self->corners[self->corner_count++] = b;
    self->corners[self->corner_count++] = c;
    return true;
}

/* ---- loops -------------------------------------------------------------------------------------
 */

static bool visit_item(void *user, uint32_t worker_index, size_t item)
{
    csg_cell_loop *w = user;
    csg_cell_worker *self = &w->workers[worker_index];
    csg_shell own;
    if (csg_mesh_should_stop(w->x->watch))
        return false;
    self->first = self->count;
    self->creases = self->smooth = 0;
    w->segments[item] = (csg_cell_segment){
        .worker = worker_index, .first = self->count, .first_corner = self->corner_count};
    size_t end = (item + 1) * BRICKS_PER_ITEM;
    for (size_t i = item * BRICKS_PER_ITEM; i < end && i < w->leaf_count; i++) {
        csg_shell *shell = w->shells ? &w->shells[i] : &own;
        if (!w->has_shells)
            csg_shell_make(shell, w->x->bricks, w->leaves[i]);
        if (!w->visit(w, worker_index, shell))
            return false;
    }
    w->segments[item].count = self->count - w->segments[item].first;
    w->segments[item].corner_count = self->corner_count - w->segments[item].first_corner;
    w->segments[item].creases = self->creases;
    w->segments[item].smooth = self->smooth;
    return true;
}

static void report(void *user, size_t done, size_t count)
{
    csg_cell_loop *w = user;
    csg_mesh_report_progress(w->x->watch, w->before + w->amount * ((double)done / (double)count));
}

/* ---- what other ranks have made ----------------------------------------------------------------
 */

/* The leaves of an item. */
static size_t end_of_item(const csg_cell_loop *w, size_t item)
{
    size_t end = (item + 1) * BRICKS_PER_ITEM;
    return end < w->leaf_count ? end : w->leaf_count;
}

/* An item's record: its segment, vertices, corners, and of each leaf which cells are wanted
 * divided. False: out of memory. */
static bool pack_item(const csg_cell_loop *w, size_t item, csg_records *records)
{
    csg_memory *memory = &w->x->context->memory;
    const csg_cell_segment *s = &w->segments[item];
    const csg_cell_worker *from = &w->workers[s->worker];
    bool done =
        csg_records_add(memory, records, s, sizeof *s) &&
        csg_records_add(memory, records, s->count ? from->vertices + s->first : NULL,
                        s->count * sizeof *from->vertices) &&
        csg_records_add(memory, records, s->corner_count ? from->corners + s->first_corner : NULL,
                        s->corner_count * sizeof *from->corners);
    for (size_t i = item * BRICKS_PER_ITEM; done && i < end_of_item(w, item); i++)
        done = csg_records_add(memory, records, &w->x->bricks->items[w->leaves[i]].wanted, 1);
    return done;
}

/* Puts another rank's item behind what the first worker has made. False: out of memory. */
static bool unpack_item(csg_cell_loop *w, size_t item, csg_record_reader *records)
{
    csg_memory *memory = &w->x->context->memory;
    csg_cell_worker *to = &w->workers[0];
    csg_cell_segment *s = &w->segments[item];
    csg_record_read(records, item, s, sizeof *s);
    s->worker = 0;
    s->first = to->count;
    s->first_corner = to->corner_count;
    if (!csg_record_read_behind(memory, records, item, (void **)&to->vertices, &to->count,
                                &to->capacity, s->count, sizeof *to->vertices) ||
        !csg_record_read_behind(memory, records, item, (void **)&to->corners, &to->corner_count,
                                &to->corner_capacity, s->corner_count, sizeof *to->corners))
        return false;
    for (size_t i = item * BRICKS_PER_ITEM; i < end_of_item(w, item); i++) {
        uint8_t wanted;
        csg_record_read(records, item, &wanted, sizeof wanted);
        w->x->bricks->items[w->leaves[i]].wanted |= wanted;
        if (wanted)
            atomic_store(&w->any, true);
    }
    return true;
}

static void note_work(const csg_cell_loop *w)
{
    csgm_rank_work *work = &w->x->context->ranks->work;
    for (uint32_t i = 0; i < w->worker_count; i++) {
        work->vertices += w->workers[i].count;
        work->triangles += w->workers[i].corner_count / 3;
    }
}

/* What each rank's items have made, to all. */
static csgm_status exchange_items(csg_cell_loop *w, csgm_status own)
{
    csgm_context *context = w->x->context;
    const size_t count = item_count(w);
    csg_records records = {0};
    csg_record_reader reader;
    size_t bytes = count * sizeof *w->segments + w->leaf_count; /* of this rank, and more */
    for (uint32_t i = 0; i < w->worker_count; i++)
        bytes += w->workers[i].count * sizeof *w->vertices +
                 w->workers[i].corner_count * sizeof *w->corners;
    if (own == CSGM_OK && !csg_records_reserve(&context->memory, &records, bytes))
        own = csg_context_no_memory(context);
    for (size_t i = 0; i < count && own == CSGM_OK; i++)
        if (csg_ranks_have(context, i) && !pack_item(w, i, &records))
            own = csg_context_no_memory(context);
    note_work(w);
    csgm_status status = csg_ranks_exchange(context, own, count, &records, &reader);
    for (uint32_t i = 0; i < w->worker_count && status == CSGM_OK; i++)
        w->workers[i].count = w->workers[i].corner_count = 0;
    for (size_t i = 0; i < count && status == CSGM_OK; i++)
        if (!unpack_item(w, i, &reader))
            status = csg_context_no_memory(context);
    csg_record_reader_end(&context->memory, &reader);
    return status;
}

/* ---- what is joined ----------------------------------------------------------------------------
 */

/* Vertices of all items behind those that are there, and corners, in the order of the leaves. */
static bool join_items(csg_cell_loop *w)
{
    csg_memory *memory = &w->x->context->memory;
    size_t vertices = 0, corners = 0;
    for (size_t i = 0; i < item_count(w); i++) {
        vertices += w->segments[i].count;
        corners += w->segments[i].corner_count;
    }
    if (!csg_memory_reserve(memory, (void **)&w->vertices, &w->capacity, w->count + vertices + 1,
                            sizeof *w->vertices))
        return false;
    if (corners) {
        w->corners = csg_memory_alloc(memory, corners * sizeof *w->corners);
        w->corner_count = w->corners ? corners : 0;
    }
    if (corners && !w->corners)
        return false;
    size_t at = 0;
    for (size_t i = 0; i < item_count(w); i++) {
        const csg_cell_segment *s = &w->segments[i];
        const csg_cell_worker *from = &w->workers[s->worker];
        for (size_t k = 0; k < s->corner_count; k++) {
            uint32_t v = from->corners[s->first_corner + k];
            w->corners[at++] = v & CSG_OWN_VERTEX ? (uint32_t)w->count + (v & ~CSG_OWN_VERTEX) : v;
        }
        if (s->count)
            memcpy(w->vertices + w->count, from->vertices + s->first,
                   s->count * sizeof *w->vertices);
        w->count += s->count;
        w->creases += s->creases;
        w->smooth += s->smooth;
    }
    for (uint32_t i = 0; i < w->worker_count; i++)
        w->workers[i].count = w->workers[i].corner_count = 0;
    return true;
}

csgm_status csg_cell_loop_enter(csg_cell_loop *w)
{
    csg_table_release(&w->index);
    csg_table_init(&w->index, &w->x->context->memory);
    if (!csg_table_reserve(&w->index, w->count + 1, NULL, NULL))
        return csg_context_no_memory(w->x->context);
    for (size_t i = 0; i < w->count; i++)
        csg_table_add(&w->index, hash_of_place(w->vertices[i].place), (uint32_t)i);
    return CSGM_OK;
}

/* Room for what each item makes. False: out of memory. */
static bool reserve_segments(csg_cell_loop *w)
{
    return csg_memory_reserve(&w->x->context->memory, (void **)&w->segments, &w->segment_capacity,
                              item_count(w) + 1, sizeof *w->segments);
}

csgm_status csg_cell_loop_run(csg_cell_loop *w, csg_visit_brick *visit, double before,
                              double amount)
{
    w->visit = visit;
    w->before = before;
    w->amount = amount;
    if (!reserve_segments(w))
        return csg_context_no_memory(w->x->context);
    csgm_status status = CSGM_OK;
    if (!csg_ranks_run(w->x->context, item_count(w), CSG_ITEMS_SMALL, visit_item, report, w))
        status = atomic_load(&w->broken) ? csg_mesh_report_open(w->x->watch)
                                         : csg_mesh_why_stopped(w->x->watch);
    if (csg_ranks_share(w->x->context, item_count(w), CSG_ITEMS_SMALL))
        status = exchange_items(w, status);
    if (status != CSGM_OK)
        return status;
    w->has_shells = w->shells != NULL;
    if (!join_items(w))
        return csg_context_no_memory(w->x->context);
    if (w->count < CSG_OWN_VERTEX)
        return CSGM_OK;
    csg_diag_plain(&w->x->context->diags, CSG_DIAG_TOO_FINE, NULL,
                   "mesh more coarsely: --quality draft, or -r",
                   "the mesh would have more than %u vertices", CSG_OWN_VERTEX - 1);
    return CSGM_ERR_LIMIT;
}

bool csg_cell_loop_list(csg_cell_loop *w, uint32_t brick)
{
    if (!csg_memory_reserve(&w->x->context->memory, (void **)&w->leaves, &w->leaf_capacity,
                            w->leaf_count + 1, sizeof *w->leaves))
        return false;
    w->leaves[w->leaf_count++] = brick;
    return true;
}

void csg_cell_loop_mark_around(const csg_bricks *b, uint32_t number, uint8_t *marks)
{
    uint32_t around[CSG_BRICKS_AROUND];
    csg_bricks_around(b, number, around);
    for (int i = 0; i < CSG_BRICKS_AROUND; i++) {
        if (around[i] == CSG_BRICK_NONE)
            continue;
        const csg_brick *brick = &b->items[around[i]];
        marks[around[i]] |= CSG_MARK_AROUND;
        for (unsigned rest = brick->divided; rest; rest &= rest - 1) {
            unsigned octant = (unsigned)__builtin_ctz(rest);
            uint32_t below[3];
            for (int axis = 0; axis < 3; axis++)
                below[axis] = 2 * brick->at[axis] + (octant >> axis & 1);
            uint32_t finer = csg_bricks_find(b, brick->level + 1u, below);
            if (finer != CSG_BRICK_NONE)
                marks[finer] |= CSG_MARK_AROUND;
        }
    }
}

csgm_status csg_cell_loop_list_marked(csg_cell_loop *w, const uint8_t *marks, uint8_t mark)
{
    const csg_bricks *b = w->x->bricks;
    csg_cell_loop_clear(w);
    for (size_t i = 0; i < b->count; i++)
        if (marks[i] & mark && csg_brick_has_leaves(&b->items[i]) &&
            !csg_cell_loop_list(w, (uint32_t)i))
            return csg_context_no_memory(w->x->context);
    return CSGM_OK;
}

static void release_shells(csg_cell_loop *w)
{
    csg_memory_release(&w->x->context->memory, w->shells, w->shell_count * sizeof *w->shells);
    w->shells = NULL;
    w->shell_count = 0;
    w->has_shells = false;
}

void csg_cell_loop_clear(csg_cell_loop *w)
{
    release_shells(w);
    w->leaf_count = 0;
}

void csg_cell_loop_keep_shells(csg_cell_loop *w)
{
    release_shells(w);
    if (w->leaf_count)
        w->shells = csg_memory_alloc(&w->x->context->memory, w->leaf_count * sizeof *w->shells);
    w->shell_count = w->shells ? w->leaf_count : 0;
}

csgm_status csg_cell_loop_begin(csg_cell_loop *w, csg_extraction *x)
{
    csg_memory *memory = &x->context->memory;
    *w = (csg_cell_loop){.x = x, .worker_count = csg_pool_threads(x->context->pool)};
    csg_table_init(&w->index, memory);
    w->workers = csg_memory_alloc(memory, w->worker_count * sizeof *w->workers);
    if (!w->workers)
        return csg_context_no_memory(x->context);
    memset(w->workers, 0, w->worker_count * sizeof *w->workers);
    return CSGM_OK;
}

void csg_cell_loop_end(csg_cell_loop *w)
{
    csg_memory *memory = &w->x->context->memory;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        csg_cell_worker *self = &w->workers[i];
        csg_memory_release(memory, self->vertices, self->capacity * sizeof *self->vertices);
        csg_memory_release(memory, self->corners, self->corner_capacity * sizeof *self->corners);
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof *w->workers);
    release_shells(w);
    csg_memory_release(memory, w->leaves, w->leaf_capacity * sizeof *w->leaves);
    csg_memory_release(memory, w->segments, w->segment_capacity * sizeof *w->segments);
    csg_memory_release(memory, w->vertices, w->capacity * sizeof *w->vertices);
    csg_memory_release(memory, w->corners, w->corner_count * sizeof *w->corners);
    csg_table_release(&w->index);
}
