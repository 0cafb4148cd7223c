/* SPDX-License-Identifier: MIT
 * Dividing, counting and numbering slabs, and what is kept between them; see slabs.h.
 */
#include "mesh/pipeline/slabs.h"

#include <string.h>

#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/ranks.h"
#include "base/trace.h"

csgm_status csg_mesh_walk_octree(csg_mesh_slabs *s, const csg_mesh_input *in)
{
    csg_octree_options options = {.prune = in->options->prune,
                                  .beads = in->options->features == CSGM_FEATURES_SHARP,
                                  .scan = !in->options->certify,
                                  .progress = csg_mesh_report_progress,
                                  .cancelled = csg_mesh_should_stop,
                                  .user = s->watch};
    csgm_status status =
        csg_octree_create(in->context, in->field, &in->lattice, &options, &s->octree);
    return status == CSGM_CANCELLED ? csg_mesh_why_stopped(s->watch) : status;
}

/* Frontier cells whose blocks may be in memory at once: as many as half of the memory left can
 * hold, a sixth where creases need the most of it, and not more than take a gigabyte at the very
 * worst (in practice a third of it). */
size_t csg_mesh_cells_per_slab(const csg_mesh_slabs *s)
{
    const csg_memory *memory = &s->watch->context->memory;
    bool sharp = s->creases->sharp;
    enum { BYTES_PER_CELL = 8 * 600, LEAST_CELLS = 16 }; /* eight blocks with tapes and index */
    enum { BYTES_OF_ROOTS = 8 * 640 };                   /* where they are kept */
    uint64_t per_cell = BYTES_PER_CELL;
    if (sharp && csg_marching_keeps_roots(&s->workers->marching))
        per_cell += BYTES_OF_ROOTS;
    uint64_t bytes = (uint64_t)1 << 30;
    if (memory->limit_bytes) {
        uint64_t used = atomic_load(&memory->used_bytes);
        uint64_t left = memory->limit_bytes > used ? memory->limit_bytes - used : 0;
        uint64_t share = left / (sharp ? 6 : 2);
        bytes = share < bytes ? share : bytes;
    }
    uint64_t cells = bytes / per_cell;
    return cells > LEAST_CELLS ? (size_t)cells : (size_t)LEAST_CELLS;
}

csgm_status csg_mesh_divide_slabs(csg_mesh_slabs *s)
{
    csg_memory *memory = &s->watch->context->memory;
    size_t cells = s->end_cell - s->first_cell;
    size_t per_slab = s->cells_per_slab ? s->cells_per_slab : csg_mesh_cells_per_slab(s);
    csg_memory_release(memory, s->slabs, s->count * sizeof(csg_slab));
    s->count = cells ? (cells + per_slab - 1) / per_slab : 1;
    s->slabs = csg_memory_alloc(memory, s->count * sizeof(csg_slab));
    s->to_make = s->count;
    if (!s->slabs) {
        s->count = s->to_make = 0;
        return csg_context_no_memory(s->watch->context);
    }
    for (size_t i = 0; i < s->count; i++) {
        size_t end = (i + 1) * per_slab;
        s->slabs[i] = (csg_slab){.first_cell = s->first_cell + i * per_slab,
                                 .end_cell = s->first_cell + (end < cells ? end : cells)};
    }
    return CSGM_OK;
}

/* ---- counting -----------------------------------------------------------------------------------
 */

static bool count_item(void *user, uint32_t worker_index, size_t item)
{
    csg_mesh_slabs *s = user;
    (void)worker_index;
    size_t end = csg_mesh_item_end(&s->at_hand, item);
    for (size_t i = item * CSG_BLOCKS_PER_ITEM; i < end; i++) {
        csg_block *block = s->at_hand.block[i];
        block->triangle_count = csg_marching_count(block, &s->workers->tables);
    }
    return true;
}

/* Blocks that nobody has seen before are counted for their cubes of the frontier. */
static void note_counts(csg_mesh_slabs *s, const csg_slab *slab)
{
    size_t cell = slab->first_cell;
    for (size_t i = 0; i < s->at_hand.count; i++) {
        const csg_block *block = s->at_hand.block[i];
        const uint32_t cube[3] = {block->at[0] / 2, block->at[1] / 2, block->at[2] / 2};
        while (memcmp(csg_octree_frontier_at(s->octree, cell), cube, sizeof cube) != 0)
            cell++;
        csg_cell_count *count = &s->counts[cell - s->first_cell];
        count->vertices += block->vertex_count;
        count->triangles += block->triangle_count;
    }
}

/* Samples a slab and numbers its vertices and triangles by prefix sums over its blocks in Morton
 * order, from the given numbers on; moves these behind the slab. */
static csgm_status sample_slab(csg_mesh_slabs *s, const csg_slab *slab, uint64_t *vertices,
                               uint64_t *triangles)
{
    CSG_ZONE(s->watch->context, "slab");
    csgm_status status = csg_octree_sample(s->octree, slab->first_cell, slab->end_cell);
    if (status != CSGM_OK)
        return status == CSGM_CANCELLED ? csg_mesh_why_stopped(s->watch) : status;
    s->at_hand.block = csg_octree_blocks(s->octree, &s->at_hand.count);
    csg_pool_run(s->watch->context->pool, csg_mesh_item_count(&s->at_hand), count_item, NULL, s);
    status = csg_mesh_find_features(s->creases, s->at_hand);
    if (status != CSGM_OK)
        return status;
    for (size_t i = 0; i < s->at_hand.count; i++) {
        csg_block *block = s->at_hand.block[i];
        block->first_vertex = (uint32_t)*vertices;
        block->first_triangle = *triangles;
        *vertices += block->vertex_count;
        *triangles += block->triangle_count;
    }
    csg_mesh_number_features(s->creases, s->at_hand);
    return CSGM_OK;
}

/* The part of the stage's progress that a slab is, with `done` slabs behind it. */
static void begin_part(csg_mesh_slabs *s, csgm_stage stage, size_t done)
{
    s->watch->stage = stage;
    s->watch->stage_share = 1.0 / (double)s->count;
    s->watch->stage_done = (double)done * s->watch->stage_share;
}

csgm_status csg_mesh_count_slabs(csg_mesh_slabs *s)
{
    csgm_status status = csg_mesh_divide_slabs(s);
    for (size_t i = 0; i < s->count && status == CSGM_OK; i++) {
        csg_slab *slab = &s->slabs[i];
        slab->vertices = s->vertex_count;
        slab->triangles = s->triangle_count;
        slab->first_block = s->creases->store.block_count;
        begin_part(s, CSGM_STAGE_OCTREE, i);
        s->is_at_hand = !(s->keeper && s->keeper->load(s, i, &status)) && status == CSGM_OK;
        if (!s->is_at_hand)
            continue;
        status = sample_slab(s, slab, &s->vertex_count, &s->triangle_count);
        if (status == CSGM_OK && s->counts)
            note_counts(s, slab);
        if (status == CSGM_OK && s->keeper)
            status = s->keeper->counted(s, i);
    }
    s->is_at_hand = s->is_at_hand && status == CSGM_OK;
    if (s->octree)
        csg_octree_end_scan(s->octree);
    return status;
}

csgm_status csg_mesh_check_numbers(csg_mesh_slabs *s)
{
    if (s->vertex_count <= UINT32_MAX)
        return CSGM_OK;
    if (!csg_ranks_is_first(s->watch->context))
        return CSGM_ERR_LIMIT;
    csg_diag_plain(&s->watch->context->diags, CSG_DIAG_TOO_FINE, NULL,
                   "lower -r, or raise -s or -e",
                   "the mesh would have %llu vertices, more than 32-bit indices can number",
                   (unsigned long long)s->vertex_count);
    return CSGM_ERR_LIMIT;
}

/* ---- the halo ----------------------------------------------------------------------------------
 */

/* Whether a block before the sampled slab has cells that use edges of this one. */
static bool is_needed_below(const csg_mesh_slabs *s, const csg_block *block)
{
    for (unsigned octant = 1; octant < CSG_OCTANTS; octant++) {
        uint32_t at[3];
        bool exists = true;
        for (int axis = 0; axis < 3; axis++) {
            uint32_t step = octant >> axis & 1;
            exists = exists && block->at[axis] >= step;
            at[axis] = block->at[axis] - step;
        }
        if (exists && csg_octree_is_before_sampled(s->octree, at))
            return true;
    }
    return false;
}

/* Adds a copy of the block. False: out of memory. */
static bool keep(csg_halo *halo, const csg_block *block)
{
    if (halo->count == halo->with_spare) {
        csg_block *fresh = csg_arena_alloc(&halo->arena, sizeof *fresh);
        if (!fresh || !csg_memory_reserve(halo->arena.memory, (void **)&halo->blocks,
                                          &halo->capacity, halo->with_spare + 1, sizeof fresh))
            return false;
        halo->blocks[halo->with_spare++] = fresh;
    }
    *halo->blocks[halo->count] = *block;
    csg_block *copy = halo->blocks[halo->count++];
    copy->along = copy->slopes = copy->ends = NULL; /* as long as the block is at hand */
    return true;
}

static void drop_unneeded(const csg_mesh_slabs *s, csg_halo *halo)
{
    for (size_t i = halo->count; i-- > 0;) {
        csg_block *block = halo->blocks[i];
        if (is_needed_below(s, block))
            continue;
        halo->blocks[i] = halo->blocks[--halo->count];
        halo->blocks[halo->count] = block;
    }
}

csgm_status csg_mesh_sample_halo(csg_mesh_slabs *s)
{
    csg_memory *memory = &s->watch->context->memory;
    csgm_status status =
        csg_octree_sample_picked(s->octree, s->halo_cells, s->halo_count, s->end_cell);
    s->at_hand = (csg_mesh_blocks){0};
    if (status != CSGM_OK)
        return status == CSGM_CANCELLED ? csg_mesh_why_stopped(s->watch) : status;
    csg_halo *halo = &s->halo;
    size_t count;
    csg_block *const *blocks = csg_octree_blocks(s->octree, &count);
    halo->arena.memory = memory;
    csg_arena_reset(&halo->arena);
    halo->count = halo->with_spare = 0;
    for (size_t i = 0; i < count; i++)
        if (!keep(halo, blocks[i]))
            return csg_context_no_memory(s->watch->context);
    return CSGM_OK;
}

/* After a slab is made: its lower rim, and what is still needed of the halo before. */
static csgm_status renew_halo(csg_mesh_slabs *s)
{
    s->halo.arena.memory = &s->watch->context->memory;
    drop_unneeded(s, &s->halo);
    for (size_t i = 0; i < s->at_hand.count; i++)
        if (is_needed_below(s, s->at_hand.block[i]) && !keep(&s->halo, s->at_hand.block[i]))
            return csg_context_no_memory(s->watch->context);
    return CSGM_OK;
}

/* The index over the blocks at hand and the halo. */
static csgm_status index_blocks(csg_mesh_slabs *s)
{
    csg_memory *memory = &s->watch->context->memory;
    size_t count = s->at_hand.count + s->halo.count;
    s->workers->marching.index = &s->index;
    s->workers->marching.blocks = s->at_hand.block;
    if (s->halo.count) {
        if (!csg_memory_reserve(memory, (void **)&s->reachable, &s->reachable_capacity, count,
                                sizeof(csg_block *)))
            return csg_context_no_memory(s->watch->context);
        if (s->at_hand.count)
            memcpy(s->reachable, s->at_hand.block, s->at_hand.count * sizeof(csg_block *));
        memcpy(s->reachable + s->at_hand.count, s->halo.blocks,
               s->halo.count * sizeof(csg_block *));
        s->workers->marching.blocks = s->reachable;
    }
    csg_table_release(&s->index);
    if (csg_block_index_make(&s->index, memory, s->workers->marching.blocks, count))
        return CSGM_OK;
    return csg_context_no_memory(s->watch->context);
}

csgm_status csg_mesh_take_slab(csg_mesh_slabs *s, size_t i)
{
    begin_part(s, CSGM_STAGE_MESH, s->count - 1 - i);
    if (i + 1 < s->count || !s->is_at_hand) {
        csg_slab slab = s->slabs[i];
        csgm_status status = sample_slab(s, &slab, &slab.vertices, &slab.triangles);
        if (status != CSGM_OK)
            return status;
    }
    return index_blocks(s);
}

csgm_status csg_mesh_leave_slab(csg_mesh_slabs *s, size_t i)
{
    return i > 0 ? renew_halo(s) : CSGM_OK;
}

void csg_mesh_slabs_release(csg_mesh_slabs *s)
{
    csg_memory *memory = &s->watch->context->memory;
    csg_arena_reset(&s->halo.arena);
    csg_memory_release(memory, s->halo.blocks, s->halo.capacity * sizeof(csg_block *));
    csg_memory_release(memory, s->reachable, s->reachable_capacity * sizeof(csg_block *));
    csg_memory_release(memory, s->slabs, s->count * sizeof(csg_slab));
    csg_table_release(&s->index);
    csg_memory_release(memory, s->counts, s->counts_bytes);
    csg_memory_release(memory, s->halo_cells, s->halo_capacity * sizeof(size_t));
    if (s->before)
        csg_memory_release(memory, s->before,
                           (csg_octree_frontier_count(s->octree) + 1) * sizeof *s->before);
    csg_octree_destroy(s->octree);
}
