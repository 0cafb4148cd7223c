/* SPDX-License-Identifier: MIT
 * Records of counted and made slabs; see keep.h. Slabs are of one size as long as anything is kept,
 * so that those of a later process are the same: the size is a record, too.
 */
#include "mesh/pipeline/keep.h"

#include <string.h>

#include "base/mesh_codes.h"
#include "base/ranks.h"
#include "base/trace.h"

enum { DIVISION = 1, COUNTED = 2, MADE = 3 }; /* kinds of records */

/* A counted slab; behind it stand its cubes' counts, and its features, their lists, their blocks
 * and all doubts until then. */
typedef struct counted {
    uint64_t first_cell, end_cell;
    uint64_t vertices, triangles; /* of the slab */
    uint64_t features, list_bytes, blocks, doubts;
    uint64_t smooth, fading; /* of all slabs until then */
} counted;

/* A made slab; behind it stands what the receiver has seen until then. */
typedef struct made {
    uint64_t first_cell, end_cell;
    csg_box bounds; /* of clipped vertices until then */
} made;

static csgm_status fail(const csg_mesh_slabs *s, int error)
{
    csgm_context *context = s->watch->context;
    csg_diag_plain(&context->diags, CSG_DIAG_CANNOT_WRITE, context->ranks->folder, NULL,
                   "cannot keep what is finished: %s", strerror(error));
    return CSGM_ERR_IO;
}

static csgm_status append(const csg_mesh_slabs *s, uint32_t kind, const csg_journal_piece *pieces,
                          int count)
{
    csg_ranks *ranks = s->watch->context->ranks;
    int error = csg_journal_write(&ranks->journal, kind, pieces, count, ranks->keeps_synced);
    return error ? fail(s, error) : CSGM_OK;
}

/* The size of slabs: that of the journal, or the one that memory allows now, but small enough that
 * little is lost when the job is stopped. */
static csgm_status choose_size(csg_mesh_slabs *s)
{
    enum { MOST_CELLS = 2048 }; /* of 16^3 cells of the lattice */
    csg_memory *memory = &s->watch->context->memory;
    uint64_t bytes = 0, size = csg_mesh_cells_per_slab(s);
    uint64_t *kept = csg_journal_read(&s->watch->context->ranks->journal, DIVISION, &bytes);
    bool is_there = kept && bytes == sizeof *kept && *kept > 0;
    s->cells_per_slab = (size_t)(is_there ? *kept : size < MOST_CELLS ? size : MOST_CELLS);
    csg_memory_release(memory, kept, (size_t)bytes);
    if (is_there)
        return CSGM_OK;
    size = s->cells_per_slab;
    const csg_journal_piece piece = {&size, sizeof size};
    return append(s, DIVISION, &piece, 1);
}

/* ---- counted slabs ----------------------------------------------------------------------------- */

/* Whether a record has all that it says, and is of this slab. */
static bool is_sound(const counted *c, uint64_t bytes, const csg_slab *slab)
{
    if (bytes < sizeof *c || c->first_cell != slab->first_cell || c->end_cell != slab->end_cell)
        return false;
    if (c->features > bytes || c->list_bytes > bytes || c->blocks > bytes || c->doubts > bytes)
        return false; /* or their sizes' sum might be more than a number holds */
    uint64_t rest = (slab->end_cell - slab->first_cell) * sizeof(csg_cell_count) +
                    c->features * sizeof(csg_feature) + c->list_bytes +
                    c->blocks * sizeof(csg_feature_block) + c->doubts * sizeof(csg_scan);
    return bytes - sizeof *c == rest;
}

static bool take(csg_mesh_slabs *s, const csg_slab *slab, const counted *c)
{
    size_t cells = slab->end_cell - slab->first_cell;
    const uint8_t *at = (const uint8_t *)(c + 1);
    memcpy(&s->counts[slab->first_cell - s->first_cell], at, cells * sizeof *s->counts);
    at += cells * sizeof *s->counts;
    csg_feature_store *store = &s->creases->store;
    store->memory = store->lists.memory = &s->watch->context->memory;
    store->cell_size = s->workers->marching.lattice->cell_size;
    const void *features = at, *lists = at + c->features * sizeof(csg_feature);
    const void *blocks = (const uint8_t *)lists + c->list_bytes;
    at = (const uint8_t *)blocks + c->blocks * sizeof(csg_feature_block);
    if (!csg_feature_store_adopt(store, features, (size_t)c->features, lists, (size_t)c->list_bytes,
                                 blocks, (size_t)c->blocks) ||
        !csg_octree_adopt_doubts(s->octree, (const csg_scan *)(const void *)at, (size_t)c->doubts))
        return false;
    store->smooth = c->smooth;
    store->fading = c->fading;
    s->vertex_count += c->vertices;
    s->triangle_count += c->triangles;
    s->at_hand = (csg_mesh_blocks){0};
    return true;
}

static bool load(csg_mesh_slabs *s, size_t i, csgm_status *status)
{
    csgm_context *context = s->watch->context;
    csg_ranks *ranks = context->ranks;
    uint64_t bytes = 0, before = ranks->journal.at;
    counted *c = csg_journal_read(&ranks->journal, COUNTED, &bytes);
    if (!c)
        return false;
    bool sound = is_sound(c, bytes, &s->slabs[i]);
    if (!sound)
        ranks->journal.at = before;
    else if (!take(s, &s->slabs[i], c))
        *status = csg_context_no_memory(context);
    else
        ranks->work.resumed_cubes += s->slabs[i].end_cell - s->slabs[i].first_cell;
    csg_memory_release(&context->memory, c, (size_t)bytes);
    return sound && *status == CSGM_OK;
}

static csgm_status keep_counted(csg_mesh_slabs *s, size_t i)
{
    csgm_context *context = s->watch->context;
    const csg_feature_store *store = &s->creases->store;
    const csg_slab *slab = &s->slabs[i];
    size_t doubt_count, list_bytes;
    uint64_t edges;
    const csg_scan *doubts = csg_octree_doubts(s->octree, &doubt_count, &edges);
    size_t first = slab->first_block < store->block_count ? store->blocks[slab->first_block].first
                                                          : store->count;
    counted c = {.first_cell = slab->first_cell,
                 .end_cell = slab->end_cell,
                 .vertices = s->vertex_count - slab->vertices,
                 .triangles = s->triangle_count - slab->triangles,
                 .features = store->count - first,
                 .blocks = store->block_count - slab->first_block,
                 .doubts = doubt_count,
                 .smooth = store->smooth,
                 .fading = store->fading};
    void *lists = csg_feature_store_pack(store, first, &list_bytes);
    c.list_bytes = list_bytes;
    if ((list_bytes && !lists) || (doubt_count && !doubts)) {
        csg_memory_release(&context->memory, lists, lists ? list_bytes : 0);
        return csg_context_no_memory(context);
    }
    const csg_journal_piece pieces[] = {
        {&c, sizeof c},
        {&s->counts[slab->first_cell - s->first_cell],
         (slab->end_cell - slab->first_cell) * sizeof *s->counts},
        {store->features + first, c.features * sizeof(csg_feature)},
        {lists, list_bytes},
        {store->blocks + slab->first_block, c.blocks * sizeof(csg_feature_block)},
        {doubts, doubt_count * sizeof *doubts}};
    csgm_status status = append(s, COUNTED, pieces, (int)(sizeof pieces / sizeof *pieces));
    csg_memory_release(&context->memory, lists, list_bytes);
    return status;
}

/* ---- made slabs -------------------------------------------------------------------------------- */

/* The next slab that is made already and ends at *end, which goes to its begin. */
static bool read_made(csg_mesh_output *o, csg_mesh_slabs *s, size_t *end)
{
    csg_ranks *ranks = s->watch->context->ranks;
    uint64_t bytes = 0, seen_bytes = 0, before = ranks->journal.at;
    made *m = csg_journal_read(&ranks->journal, MADE, &bytes);
    if (!m)
        return false;
    void *seen = o->receiver->seen(o->receiver->user, &seen_bytes);
    bool fits = bytes == sizeof *m + seen_bytes && m->end_cell == *end && m->first_cell < *end &&
                m->first_cell >= s->first_cell;
    if (fits) {
        *end = (size_t)m->first_cell;
        o->workers->each[0].bounds = csg_box_hull(o->workers->each[0].bounds, m->bounds);
        if (seen_bytes)
            memcpy(seen, m + 1, (size_t)seen_bytes);
    } else {
        ranks->journal.at = before;
    }
    csg_memory_release(&s->watch->context->memory, m, (size_t)bytes);
    return fits;
}

size_t csg_mesh_keep_skip_made(csg_mesh_output *o, csg_mesh_slabs *s)
{
    csg_ranks *ranks = s->watch->context->ranks;
    size_t end = s->end_cell;
    while (s->keeper && ranks->is_begun && read_made(o, s, &end))
        ;
    if (end == s->end_cell)
        return end;
    ranks->work.resumed_cubes += s->end_cell - end;
    while (s->to_make && s->slabs[s->to_make - 1].first_cell >= end)
        s->to_make--;
    return end;
}

static csgm_status keep_made(csg_mesh_output *o, const csg_mesh_slabs *s, size_t i)
{
    uint64_t seen_bytes = 0;
    made m;
    memset(&m, 0, sizeof m);
    m.first_cell = s->slabs[i].first_cell;
    m.end_cell = s->slabs[i].end_cell;
    m.bounds = csg_box_empty();
    for (uint32_t k = 0; k < o->workers->count; k++)
        m.bounds = csg_box_hull(m.bounds, o->workers->each[k].bounds);
    const void *seen = o->receiver->seen(o->receiver->user, &seen_bytes);
    if (!o->receiver->flush(o->receiver->user)) {
        atomic_store(&o->watch->refused, true);
        return csg_mesh_why_stopped(o->watch);
    }
    const csg_journal_piece pieces[] = {{&m, sizeof m}, {seen, seen_bytes}};
    return append(s, MADE, pieces, 2);
}

/* ---- both -------------------------------------------------------------------------------------- */

csgm_status csg_mesh_keep_begin(csg_mesh_slabs *s, const void *common, size_t bytes)
{
    csgm_context *context = s->watch->context;
    static const csg_slab_keeper keeper = {load, keep_counted, keep_made};
    csg_ranks *ranks = context->ranks;
    if (!ranks->keeps)
        return CSGM_OK;
    csg_arena names;
    csg_arena_init(&names, &context->memory);
    const uint32_t own[] = {ranks->by.rank, ranks->by.count, s->workers->count, sizeof(csg_feature),
                            sizeof(csg_scan)};
    size_t head_bytes = bytes + sizeof own;
    uint8_t *head = csg_arena_alloc(&names, head_bytes);
    const char *path = csg_arena_printf(&names, "%s/rank-%u", ranks->folder, ranks->by.rank);
    csgm_status status = head && path ? CSGM_OK : csg_context_no_memory(context);
    if (status == CSGM_OK) {
        memcpy(head, common, bytes);
        memcpy(head + bytes, own, sizeof own);
        int error = csg_journal_open(&ranks->journal, &context->memory, path, head, head_bytes);
        status = error ? fail(s, error) : choose_size(s);
    }
    csg_arena_reset(&names);
    if (status == CSGM_OK)
        s->keeper = &keeper;
    return status;
}
