/* SPDX-License-Identifier: MIT
 * Blocks in slabs: stretches of the octree's frontier whose blocks are in memory at one time.
 * Ordinarily there is one. Where the memory limit asks for several, each is sampled twice: once to
 * count, once, from the last to the first, to make its triangles; between them only the rim blocks
 * that earlier slabs refer to (the halo) are kept. The mesh is the same for any number of slabs.
 */
#include <string.h>

#include "base/pool.h"
#include "mesh/work.h"

/* Frontier cells whose blocks may be in memory at once: as many as half of the memory left can
 * hold, and not more than take a gigabyte at the very worst (in practice a third of it). */
static size_t cells_per_slab(const csg_memory *memory)
{
    enum { BYTES_PER_CELL = 8 * 600, LEAST_CELLS = 16 }; /* eight blocks with tapes and index */
    uint64_t bytes = (uint64_t)1 << 30;
    if (memory->limit_bytes) {
        uint64_t used = atomic_load(&memory->used_bytes);
        uint64_t left = memory->limit_bytes > used ? memory->limit_bytes - used : 0;
        bytes = left / 2 < bytes ? left / 2 : bytes;
    }
    uint64_t cells = bytes / BYTES_PER_CELL;
    return cells > LEAST_CELLS ? (size_t)cells : (size_t)LEAST_CELLS;
}

static csgm_status divide(csg_mesh_work *w)
{
    csg_memory *memory = &w->context->memory;
    size_t cells = csg_octree_frontier_count(w->octree), per_slab = cells_per_slab(memory);
    w->slab_count = cells ? (cells + per_slab - 1) / per_slab : 1;
    w->slabs = csg_memory_alloc(memory, w->slab_count * sizeof(csg_slab));
    if (!w->slabs)
        return csg_context_no_memory(w->context);
    for (size_t i = 0; i < w->slab_count; i++) {
        size_t end = (i + 1) * per_slab;
        w->slabs[i] = (csg_slab){.first_cell = i * per_slab, .end_cell = end < cells ? end : cells};
    }
    return CSGM_OK;
}

/* ---- counting -----------------------------------------------------------------------------------
 */

static bool count_item(void *user, uint32_t worker_index, size_t item)
{
    csg_mesh_work *w = user;
    (void)worker_index;
    size_t end = (item + 1) * CSG_BLOCKS_PER_ITEM;
    for (size_t i = item * CSG_BLOCKS_PER_ITEM; i < end && i < w->block_count; i++)
        w->blocks[i]->triangle_count = csg_marching_count(w->blocks[i], &w->tables);
    return true;
}

/* Samples a slab and numbers its vertices and triangles by prefix sums over its blocks in Morton
 * order, from the given numbers on; moves these behind the slab. */
static csgm_status sample_slab(csg_mesh_work *w, const csg_slab *slab, uint64_t *vertices,
                               uint64_t *triangles)
{
    csgm_status status = csg_octree_sample(w->octree, slab->first_cell, slab->end_cell);
    if (status != CSGM_OK)
        return status == CSGM_CANCELLED ? csg_mesh_why_stopped(w) : status;
    w->blocks = csg_octree_blocks(w->octree, &w->block_count);
    csg_pool_run(w->context->pool, csg_mesh_item_count(w), count_item, NULL, w);
    status = csg_mesh_find_features(w);
    if (status != CSGM_OK)
        return status;
    for (size_t i = 0; i < w->block_count; i++) {
        csg_block *block = w->blocks[i];
        block->first_vertex = (uint32_t)*vertices;
        block->first_triangle = *triangles;
        *vertices += block->vertex_count;
        *triangles += block->triangle_count;
    }
    csg_mesh_number_features(w);
    return CSGM_OK;
}

/* The part of the stage's progress that slab i is. */
static void begin_part(csg_mesh_work *w, csgm_stage stage, size_t done)
{
    w->stage = stage;
    w->stage_share = 1.0 / (double)w->slab_count;
    w->stage_done = (double)done * w->stage_share;
}

csgm_status csg_mesh_count_slabs(csg_mesh_work *w)
{
    csgm_status status = divide(w);
    csg_mesh_counts *counts = &w->counts;
    for (size_t i = 0; i < w->slab_count && status == CSGM_OK; i++) {
        csg_slab *slab = &w->slabs[i];
        slab->vertices = counts->vertex_count;
        slab->triangles = counts->triangle_count;
        begin_part(w, CSGM_STAGE_OCTREE, i);
        status = sample_slab(w, slab, &counts->vertex_count, &counts->triangle_count);
    }
    if (status != CSGM_OK || counts->vertex_count <= UINT32_MAX)
        return status;
    csg_diag_plain(&w->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower the resolution",
                   "the mesh would have %llu vertices, more than 32-bit indices can number",
                   (unsigned long long)counts->vertex_count);
    return CSGM_ERR_LIMIT;
}

/* ---- the halo
 * ------------------------------------------------------------------------------------- */

/* Whether a block before the sampled slab has cells that use edges of this one. */
static bool is_needed_below(const csg_mesh_work *w, const csg_block *block)
{
    for (unsigned octant = 1; octant < CSG_OCTANTS; octant++) {
        uint32_t at[3];
        bool exists = true;
        for (int axis = 0; axis < 3; axis++) {
            uint32_t step = octant >> axis & 1;
            exists = exists && block->at[axis] >= step;
            at[axis] = block->at[axis] - step;
        }
        if (exists && csg_octree_is_before_sampled(w->octree, at))
            return true;
    }
    return false;
}

static bool keep_needed(csg_mesh_work *w, csg_halo *to, csg_block *const *blocks, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (!is_needed_below(w, blocks[i]))
            continue;
        csg_block *copy = csg_arena_alloc(&to->arena, sizeof *copy);
        if (!copy || !csg_memory_reserve(&w->context->memory, (void **)&to->blocks, &to->capacity,
                                         to->count + 1, sizeof copy))
            return false;
        *copy = *blocks[i];
        to->blocks[to->count++] = copy;
    }
    return true;
}

/* After a slab is made: its lower rim, and what is still needed of the halo before. */
static csgm_status renew_halo(csg_mesh_work *w)
{
    csg_halo fresh = w->old_halo;
    w->old_halo = w->halo;
    fresh.count = 0;
    csg_arena_init(&fresh.arena, &w->context->memory);
    bool done = keep_needed(w, &fresh, w->old_halo.blocks, w->old_halo.count) &&
                keep_needed(w, &fresh, w->blocks, w->block_count);
    if (w->old_halo.arena.memory)
        csg_arena_reset(&w->old_halo.arena);
    w->halo = fresh;
    return done ? CSGM_OK : csg_context_no_memory(w->context);
}

/* The index over the blocks at hand and the halo. */
static csgm_status index_blocks(csg_mesh_work *w)
{
    csg_memory *memory = &w->context->memory;
    size_t count = w->block_count + w->halo.count;
    w->marching.blocks = w->blocks;
    if (w->halo.count) {
        if (!csg_memory_reserve(memory, (void **)&w->reachable, &w->reachable_capacity, count,
                                sizeof(csg_block *)))
            return csg_context_no_memory(w->context);
        if (w->block_count)
            memcpy(w->reachable, w->blocks, w->block_count * sizeof(csg_block *));
        memcpy(w->reachable + w->block_count, w->halo.blocks, w->halo.count * sizeof(csg_block *));
        w->marching.blocks = w->reachable;
    }
    csg_block_index_release(&w->index);
    if (csg_block_index_make(&w->index, memory, w->marching.blocks, count))
        return CSGM_OK;
    return csg_context_no_memory(w->context);
}

csgm_status csg_mesh_each_slab(csg_mesh_work *w, csgm_status (*make)(csg_mesh_work *work))
{
    csgm_status status = CSGM_OK;
    for (size_t i = w->slab_count; i-- > 0 && status == CSGM_OK;) {
        begin_part(w, CSGM_STAGE_MESH, w->slab_count - 1 - i);
        if (i + 1 < w->slab_count) {
            csg_slab slab = w->slabs[i];
            status = sample_slab(w, &slab, &slab.vertices, &slab.triangles);
        }
        if (status == CSGM_OK)
            status = index_blocks(w);
        if (status == CSGM_OK)
            status = make(w);
        if (status == CSGM_OK && i > 0)
            status = renew_halo(w);
    }
    return status;
}

static void release_halo(csg_memory *memory, csg_halo *halo)
{
    if (halo->arena.memory)
        csg_arena_reset(&halo->arena);
    csg_memory_release(memory, halo->blocks, halo->capacity * sizeof(csg_block *));
}

void csg_mesh_release_slabs(csg_mesh_work *w)
{
    csg_memory *memory = &w->context->memory;
    release_halo(memory, &w->halo);
    release_halo(memory, &w->old_halo);
    csg_memory_release(memory, w->reachable, w->reachable_capacity * sizeof(csg_block *));
    csg_memory_release(memory, w->slabs, w->slab_count * sizeof(csg_slab));
    csg_block_index_release(&w->index);
}
