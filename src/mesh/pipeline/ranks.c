/* SPDX-License-Identifier: MIT
 * Sharing, numbering and joining; see ranks.h.
 */
#include "mesh/pipeline/ranks.h"

#include <stdlib.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/ranks.h"
#include "base/trace.h"
#include "mesh/pipeline/keep.h"

/* ---- sharing ------------------------------------------------------------------------------------
 */

typedef uint64_t weigh(const csg_mesh_slabs *s, size_t cell);

/* What a frontier cube will cost: its samples are as long as its tape, and two nodes more are what
 * a block of a sphere costs besides. */
static uint64_t work_of_tape(const csg_mesh_slabs *s, size_t cell)
{
    uint32_t at[3];
    return csg_octree_frontier_tape(s->octree, cell, at).count + 2;
}

/* What it costs to make, once it is counted: its vertices, and to be sampled again three fifths of
 * that on the average (measured on S1). */
static uint64_t work_of_counts(const csg_mesh_slabs *s, size_t cell)
{
    size_t cells = csg_octree_frontier_count(s->octree);
    uint64_t vertices = s->before[cell + 1].vertices - s->before[cell].vertices;
    return 5 * vertices + 3 * (s->vertex_count / cells) + 1;
}

/* This rank's stretch of the frontier: where the sums of work reach its share and the next one's.
 */
static void choose_stretch(csg_mesh_slabs *s, weigh *work)
{
    const csgm_communicator *by = &s->watch->context->ranks->by;
    size_t cells = csg_octree_frontier_count(s->octree);
    uint64_t total = 0, sum = 0;
    for (size_t i = 0; i < cells; i++)
        total += work(s, i);
    s->first_cell = s->end_cell = cells;
    for (size_t i = cells; i-- > 0;) { /* sum: from i on */
        sum += work(s, i);
        double before = (double)(total - sum) * by->count;
        if (before >= (double)total * by->rank)
            s->first_cell = i;
        if (before >= (double)total * (by->rank + 1))
            s->end_cell = i;
    }
}

/* ---- the halo -----------------------------------------------------------------------------------
 */

static int compare_sizes(const void *a, const void *b)
{
    const size_t *one = a, *other = b;
    return *one < *other ? -1 : *one > *other;
}

/* The frontier cubes behind the stretch that touch one of it from above, in order, each once.
 * False: out of memory. */
static bool find_halo(csg_mesh_slabs *s)
{
    size_t cells = csg_octree_frontier_count(s->octree), count = 0;
    s->halo_count = 0;
    for (size_t i = s->first_cell; i < s->end_cell; i++)
        for (unsigned octant = 1; octant < CSG_OCTANTS; octant++) {
            const uint32_t *at = csg_octree_frontier_at(s->octree, i);
            const uint32_t above[3] = {at[0] + (octant & 1), at[1] + (octant >> 1 & 1),
                                       at[2] + (octant >> 2)};
            if (s->end_cell == cells ||
                csg_lattice_compare_morton(above, csg_octree_frontier_at(s->octree, s->end_cell)) <
                    0)
                continue;
            size_t found = csg_octree_find(s->octree, above);
            if (found == cells)
                continue;
            if (!csg_memory_reserve(&s->watch->context->memory, (void **)&s->halo_cells,
                                    &s->halo_capacity, count + 1, sizeof(size_t)))
                return false;
            s->halo_cells[count++] = found;
        }
    if (count)
        qsort(s->halo_cells, count, sizeof(size_t), compare_sizes);
    for (size_t i = 0; i < count; i++)
        if (!s->halo_count || s->halo_cells[s->halo_count - 1] != s->halo_cells[i])
            s->halo_cells[s->halo_count++] = s->halo_cells[i];
    return true;
}

/* ---- sharing the frontier out --------------------------------------------------------------------
 */

/* What ranks must have in common. */
typedef struct common {
    uint64_t cells, tape;
    double cell_size;
    csg_vec3 origin;
    uint32_t blocks[3], features;
} common;

/* Whether this process has a stretch of the frontier, and others have the rest. */
static bool has_stretch(const csg_mesh_slabs *s)
{
    return s->watch->context->ranks && !s->is_whole;
}

csgm_status csg_mesh_ranks_compare(csgm_context *context, const void *own, size_t bytes)
{
    csg_rank_pieces all;
    csgm_status status = csg_ranks_gather(context, CSGM_OK, CSGM_ALL_RANKS, own, bytes, &all);
    if (status != CSGM_OK)
        return status;
    const uint8_t *first = all.bytes;
    uint32_t other = 0;
    while (other < context->ranks->by.count && context->ranks->bytes[other] == bytes &&
           !memcmp(first, first + other * bytes, bytes))
        other++;
    csg_rank_pieces_release(&context->memory, &all);
    if (other == context->ranks->by.count)
        return CSGM_OK;
    if (csg_ranks_is_first(context))
        csg_diag_plain(&context->diags, CSG_DIAG_RANKS_FAILED, NULL,
                       "all need the same scene, options and build of csgmesh",
                       "rank %u makes another mesh than rank 0", (unsigned)other);
    return CSGM_ERR_ARGUMENT;
}

/* Another scene, or another build, would make another mesh, and so would what one has kept. */
static csgm_status compare(csg_mesh_slabs *s, csgm_status status)
{
    csgm_context *context = s->watch->context;
    common own;
    memset(&own, 0, sizeof own);
    if (status != CSGM_OK)
        return csg_ranks_agree(context, status);
    const csg_lattice *lattice = s->workers->marching.lattice;
    own.cells = csg_octree_frontier_count(s->octree);
    for (size_t i = 0; i < own.cells; i++)
        own.tape = own.tape * 31 + work_of_tape(s, i);
    own.cell_size = lattice->cell_size;
    own.origin = lattice->origin;
    memcpy(own.blocks, lattice->blocks, sizeof own.blocks);
    own.features = s->creases->sharp + 2u * s->creases->split;
    status = csg_mesh_ranks_compare(context, &own, sizeof own);
    return status == CSGM_OK ? csg_ranks_agree(context, csg_mesh_keep_begin(s, &own, sizeof own))
                             : status;
}

csgm_status csg_mesh_ranks_share(csg_mesh_slabs *s, csgm_status own)
{
    csgm_context *context = s->watch->context;
    if (!has_stretch(s) && own != CSGM_OK)
        return own;
    if (!has_stretch(s)) {
        s->end_cell = csg_octree_frontier_count(s->octree);
        return CSGM_OK;
    }
    CSG_ZONE(context, "sharing");
    csgm_status status = compare(s, own);
    if (status != CSGM_OK)
        return status;
    choose_stretch(s, work_of_tape);
    size_t bytes = (s->end_cell - s->first_cell + 1) * sizeof *s->counts;
    s->counts = csg_memory_alloc(&context->memory, bytes);
    s->counts_bytes = bytes;
    if (!s->counts || !find_halo(s))
        return csg_context_no_memory(context);
    memset(s->counts, 0, bytes);
    return csg_mesh_sample_halo(s);
}

/* ---- numbers ------------------------------------------------------------------------------------
 */

/* What comes before each frontier cube, from the counts of all ranks. */
static csgm_status sum_up(csg_mesh_slabs *s, const csg_cell_count *counts)
{
    csg_memory *memory = &s->watch->context->memory;
    size_t cells = csg_octree_frontier_count(s->octree);
    s->before = csg_memory_alloc(memory, (cells + 1) * sizeof *s->before);
    if (!s->before)
        return csg_context_no_memory(s->watch->context);
    csg_cell_sum sum = {0};
    for (size_t i = 0; i < cells; i++) {
        s->before[i] = sum;
        sum.vertices += counts[i].vertices;
        sum.triangles += counts[i].triangles;
    }
    s->before[cells] = sum;
    s->vertex_count = sum.vertices;
    s->triangle_count = sum.triangles;
    return CSGM_OK;
}

/* Whether the rank with the most to make has so much that all had better be sampled again: that is
 * as much as three fifths of making it. Known by all alike: bytes are those of the exchange. */
static bool is_unfair(const csg_mesh_slabs *s)
{
    enum { CELLS_WORTH_IT = 16 }; /* a rank: fewer are made before it is said who has them */
    const csg_ranks *ranks = s->watch->context->ranks;
    size_t cell = 0;
    uint64_t most = 0;
    for (uint32_t i = 0; i < ranks->by.count; i++) {
        size_t end = cell + (size_t)(ranks->bytes[i] / sizeof(csg_cell_count));
        uint64_t own = s->before[end].vertices - s->before[cell].vertices;
        most = own > most ? own : most;
        cell = end;
    }
    return cell >= (size_t)ranks->by.count * CELLS_WORTH_IT &&
           5 * most > 8 * (s->vertex_count / ranks->by.count + 1);
}

/* Everybody's features with their lists: those of the store go, and come back to `all`. */
static csgm_status gather_lists(csgm_context *context, const csg_feature_store *store,
                                csgm_status own, csg_feature_store *all)
{
    size_t bytes = 0, total;
    void *packed = own == CSGM_OK ? csg_feature_store_pack(store, 0, &bytes) : NULL, *lists = NULL;
    if (bytes && !packed)
        own = csg_context_no_memory(context);
    csg_rank_pieces features;
    csgm_status status = csg_ranks_gather(context, own, CSGM_ALL_RANKS, store->features,
                                          store->count * sizeof(csg_feature), &features);
    if (status == CSGM_OK) {
        all->features = features.bytes;
        all->count = all->capacity = (size_t)(features.total / sizeof(csg_feature));
        total = csg_feature_lists_bytes(all->features, all->count);
        lists = csg_arena_alloc(&all->lists, total);
        own = lists ? CSGM_OK : csg_context_no_memory(context);
        status = csg_ranks_gather_into(context, own, CSGM_ALL_RANKS, packed, bytes, lists);
    }
    csg_memory_release(&context->memory, packed, bytes);
    if (status == CSGM_OK)
        csg_features_lay_out(all->features, all->count, lists);
    return status;
}

/* Everybody's features in one store, as one process has them. The piece of each rank has them in
 * the order of its blocks, and ranks are in the order of the frontier. */
static csgm_status gather_features(csg_mesh_slabs *s, csgm_status own)
{
    csgm_context *context = s->watch->context;
    csg_feature_store *store = &s->creases->store;
    csg_rank_pieces blocks;
    csg_feature_store all = {.memory = &context->memory,
                             .lists = {.memory = &context->memory},
                             .cell_size = store->cell_size,
                             .smooth = store->smooth,
                             .fading = store->fading};
    for (size_t i = 0; own == CSGM_OK && i < store->count; i++)
        store->features[i].vertex += (uint32_t)s->before[s->first_cell].vertices;
    csgm_status status = gather_lists(context, store, own, &all);
    if (status == CSGM_OK)
        status = csg_ranks_gather(context, CSGM_OK, CSGM_ALL_RANKS, store->blocks,
                                  store->block_count * sizeof(csg_feature_block), &blocks);
    if (status != CSGM_OK) {
        csg_feature_store_release(&all);
        return status;
    }
    csg_feature_store_release(store);
    all.blocks = blocks.bytes;
    all.block_count = all.block_capacity = all.numbered =
        (size_t)(blocks.total / sizeof(csg_feature_block));
    *store = all;
    uint32_t first = 0;
    for (size_t i = 0; i < store->block_count; i++) {
        store->blocks[i].first = first;
        first += store->blocks[i].count;
    }
    return CSGM_OK;
}

/* The slabs and what is at hand get the numbers of the whole mesh. */
static void number_slabs(csg_mesh_slabs *s)
{
    const csg_cell_sum *before = s->before;
    for (size_t i = 0; i < s->count; i++) {
        s->slabs[i].vertices = before[s->slabs[i].first_cell].vertices;
        s->slabs[i].triangles = before[s->slabs[i].first_cell].triangles;
    }
    for (size_t i = 0; i < s->at_hand.count; i++) {
        s->at_hand.block[i]->first_vertex += (uint32_t)before[s->first_cell].vertices;
        s->at_hand.block[i]->first_triangle += before[s->first_cell].triangles;
    }
}

/* Blocks of the halo stand in the order of halo_cells, all of each cube. */
static void number_halo(csg_mesh_slabs *s)
{
    size_t cell = 0;
    uint64_t vertex = 0;
    const csg_feature_store *store = &s->creases->store;
    for (size_t i = 0; i < s->halo.count; i++) {
        csg_block *block = s->halo.blocks[i];
        const uint32_t cube[3] = {block->at[0] / 2, block->at[1] / 2, block->at[2] / 2};
        while (memcmp(csg_octree_frontier_at(s->octree, s->halo_cells[cell]), cube, sizeof cube)) {
            cell++;
            vertex = 0;
        }
        const csg_feature_block *features =
            s->creases->sharp ? csg_feature_store_find(store, block->at) : NULL;
        block->vertex_count += features ? features->vertices : 0;
        block->first_vertex = (uint32_t)(s->before[s->halo_cells[cell]].vertices + vertex);
        vertex += block->vertex_count;
    }
}

csgm_status csg_mesh_ranks_resume(csg_mesh_output *o, csg_mesh_slabs *s)
{
    size_t end = s->end_cell, left = csg_mesh_keep_skip_made(o, s);
    if (left == end)
        return CSGM_OK;
    s->end_cell = left;
    s->is_at_hand = false;
    csgm_status status =
        find_halo(s) ? csg_mesh_sample_halo(s) : csg_context_no_memory(s->watch->context);
    s->end_cell = end;
    if (status == CSGM_OK)
        number_halo(s);
    return status;
}

static csgm_status share_again(csg_mesh_slabs *s)
{
    csgm_context *context = s->watch->context;
    choose_stretch(s, work_of_counts);
    context->ranks->work.shared_again = true;
    if (!find_halo(s))
        return csg_context_no_memory(context);
    csgm_status status = csg_mesh_sample_halo(s);
    if (status == CSGM_OK)
        status = csg_mesh_divide_slabs(s);
    s->at_hand = (csg_mesh_blocks){0};
    s->is_at_hand = false;
    return status;
}

static void note_work(csg_mesh_slabs *s)
{
    csgm_rank_work *work = &s->watch->context->ranks->work;
    work->cubes += s->end_cell - s->first_cell;
    work->halo_cubes += s->halo_count;
    work->vertices += s->before[s->end_cell].vertices - s->before[s->first_cell].vertices;
    work->triangles += s->before[s->end_cell].triangles - s->before[s->first_cell].triangles;
}

static csgm_status number(csg_mesh_slabs *s, csgm_status own)
{
    csgm_context *context = s->watch->context;
    csg_rank_pieces counts;
    csgm_status status =
        csg_ranks_gather(context, own, CSGM_ALL_RANKS, s->counts,
                         (s->end_cell - s->first_cell) * sizeof *s->counts, &counts);
    if (status != CSGM_OK)
        return status;
    status = sum_up(s, counts.bytes);
    bool again = status == CSGM_OK && is_unfair(s);
    csg_rank_pieces_release(&context->memory, &counts);
    if (s->creases->sharp)
        status = gather_features(s, status);
    else
        status = csg_ranks_agree(context, status);
    if (status == CSGM_OK)
        status = csg_mesh_check_numbers(s);
    if (status == CSGM_OK && again)
        status = share_again(s);
    if (status == CSGM_OK && s->creases->sharp)
        status =
            csg_feature_store_index(&s->creases->store) ? CSGM_OK : csg_context_no_memory(context);
    if (status == CSGM_OK) {
        number_slabs(s);
        number_halo(s);
        note_work(s);
    }
    return status;
}

csgm_status csg_mesh_ranks_number(csg_mesh_slabs *s, csgm_status own)
{
    if (!has_stretch(s))
        return own == CSGM_OK ? csg_mesh_check_numbers(s) : own;
    CSG_ZONE(s->watch->context, "numbers of ranks");
    return number(s, own);
}
