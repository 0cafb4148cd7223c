/* SPDX-License-Identifier: MIT
 * Finding features in parallel, then settling them; see creases.h.
 */
#include "mesh/pipeline/creases.h"

#include <string.h>

#include "base/pool.h"
#include "base/ranks.h"
#include "base/trace.h"
#include "mesh/features/bare.h"
#include "mesh/features/cross.h"
#include "mesh/features/move.h"
#include "mesh/features/settle.h"

/* What one item of the parallel loop has found, in the room of one worker. */
typedef struct csg_found_item {
    uint32_t worker;
    size_t first, count; /* of the room's blocks */
} found_item;

static bool find_item(void *user, uint32_t worker_index, size_t item)
{
    csg_mesh_creases *c = user;
    if (csg_mesh_should_stop(c->watch))
        return false;
    csg_mesh_worker *self = &c->workers->each[worker_index];
    found_item *found = &c->found[item];
    *found = (found_item){.worker = worker_index, .first = self->features->block_count};
    size_t end = csg_mesh_item_end(&c->blocks, item);
    for (size_t i = item * CSG_BLOCKS_PER_ITEM; i < end; i++)
        if (!csg_feature_find(&c->workers->marching, c->blocks.block[i], self->features,
                              &c->watch->context->memory, self->scratch,
                              c->workers->scratch_floats) ||
            self->features->around.out_of_memory)
            return csg_mesh_stop_without_memory(c->watch);
    found->count = self->features->block_count - found->first;
    return true;
}

static bool empty_rooms(csg_mesh_creases *c)
{
    bool done = true;
    for (uint32_t i = 0; i < c->workers->count; i++) {
        csg_feature_room *room = c->workers->each[i].features;
        c->store.smooth += room->smooth;
        c->store.fading += room->fading;
        c->workers->each[i].point_evaluations += room->evaluations;
        done = csg_feature_store_take_lists(&c->store, room) && done;
    }
    return done;
}

/* Joined in the order of the items, whoever did them. */
static bool collect(csg_mesh_creases *c, size_t items)
{
    bool done = true;
    for (size_t i = 0; i < items && done; i++) {
        const found_item *found = &c->found[i];
        done = csg_feature_store_add(&c->store, c->workers->each[found->worker].features,
                                     found->first, found->count);
    }
    return empty_rooms(c) && done;
}

/* Two triangles a feature more than without; in a cell with a joined face all loops are features,
 * and others than before. */
static uint32_t triangles_of(const csg_mesh_creases *c, const csg_feature *f, uint32_t count)
{
    uint32_t triangles = 0;
    for (uint32_t k = 0; k < count; k++) {
        triangles += f[k].joined ? f[k].side_count : 2u;
        if (f[k].joined && (k == 0 || f[k].cell != f[k - 1].cell))
            triangles -= c->workers->tables.count[f[k].pattern];
    }
    return triangles;
}

static void count_vertices(csg_mesh_creases *c, size_t first_block)
{
    csg_feature_store *store = &c->store;
    for (size_t i = first_block; i < store->block_count; i++) {
        csg_feature_block *block = &store->blocks[i];
        block->vertices = block->count;
        for (uint32_t k = 0; c->split && k < block->count; k++)
            block->vertices += store->features[block->first + k].sheet_count - 1u;
        block->triangles = triangles_of(c, store->features + block->first, block->count);
    }
}

static void add_counts(csg_block *block, const csg_feature_block *features)
{
    block->vertex_count += features->vertices;
    block->triangle_count += features->triangles;
}

static void add_known(csg_mesh_creases *c)
{
    for (size_t i = 0; i < c->blocks.count; i++) {
        const csg_feature_block *features =
            csg_feature_store_find(&c->store, c->blocks.block[i]->at);
        if (features)
            add_counts(c->blocks.block[i], features);
    }
}

/* Blocks at hand and blocks with features are both in Morton order. */
static void add_to_blocks(csg_mesh_creases *c, size_t first_block)
{
    const csg_feature_store *store = &c->store;
    size_t next = first_block;
    for (size_t i = 0; i < c->blocks.count && next < store->block_count; i++)
        if (!memcmp(c->blocks.block[i]->at, store->blocks[next].at, sizeof c->blocks.block[i]->at))
            add_counts(c->blocks.block[i], &store->blocks[next++]);
}

csgm_status csg_mesh_find_features(csg_mesh_creases *c, csg_mesh_blocks blocks)
{
    CSG_ZONE(c->watch->context, "features: find");
    if (!c->sharp)
        return CSGM_OK;
    for (uint32_t i = 0; i < c->workers->count; i++) /* of blocks that were at hand before */
        csg_arena_reset(&c->workers->each[i].features->along);
    c->blocks = blocks;
    if (c->store.index.slots) { /* all were found before */
        add_known(c);
        return CSGM_OK;
    }
    csgm_context *context = c->watch->context;
    size_t items = csg_mesh_item_count(&blocks), first_block = c->store.block_count;
    size_t bytes = (items + !items) * sizeof(found_item);
    c->store.memory = c->store.lists.memory = &context->memory;
    c->store.cell_size = c->workers->marching.lattice->cell_size;
    c->found = csg_memory_alloc(&context->memory, bytes);
    if (!c->found)
        return csg_context_no_memory(context);
    memset(c->found, 0, bytes);
    bool done = csg_pool_run(context->pool, items, find_item, NULL, c);
    if (done && !collect(c, items))
        done = csg_mesh_stop_without_memory(c->watch);
    csg_memory_release(&context->memory, c->found, bytes);
    c->found = NULL;
    if (!done)
        return csg_mesh_why_stopped(c->watch);
    count_vertices(c, first_block);
    add_to_blocks(c, first_block);
    return CSGM_OK;
}

void csg_mesh_number_features(csg_mesh_creases *c, csg_mesh_blocks blocks)
{
    CSG_ZONE(c->watch->context, "numbering");
    csg_feature_store *store = &c->store;
    if (!c->sharp || store->index.slots)
        return;
    for (size_t i = 0; i < blocks.count && store->numbered < store->block_count; i++) {
        const csg_block *block = blocks.block[i];
        const csg_feature_block *features = &store->blocks[store->numbered];
        if (memcmp(block->at, features->at, sizeof block->at) != 0)
            continue;
        uint32_t vertex = block->first_vertex + block->vertex_count - features->vertices;
        for (uint32_t k = 0; k < features->count; k++) {
            csg_feature *f = &store->features[features->first + k];
            f->vertex = vertex;
            vertex += c->split ? f->sheet_count : 1u;
        }
        store->numbered++;
    }
}

/* How often what runs on one thread asks whether to stop. */
enum { FEATURES_PER_QUESTION = 1024, BLOCKS_PER_QUESTION = 64 };

/* ---- once all are found ------------------------------------------------------------------------
 */

static bool link_item(void *user, uint32_t worker, size_t item)
{
    csg_mesh_creases *c = user;
    (void)worker;
    csg_feature_link(&c->store, &c->workers->tables, item);
    return true;
}

static bool flip_item(void *user, uint32_t worker, size_t item)
{
    csg_mesh_creases *c = user;
    (void)worker;
    csg_feature_flip(&c->store, &c->workers->tables, item);
    return true;
}

/* Apexes out of order between their neighbours, in the order of the features, so that the outcome
 * does not depend on threads: there are few. Each sees where those before it have gone. */
static bool order_features(csg_mesh_creases *c, csg_feature_probe *probe)
{
    CSG_ZONE(c->watch->context, "features: move");
    enum { ROUNDS = 3 };
    csg_feature_store *store = &c->store;
    size_t moved = 1;
    for (int round = 0; round < ROUNDS && moved; round++) {
        moved = 0;
        for (uint32_t i = 0; i < store->count; i++) {
            csg_feature_whole fresh;
            if (i % FEATURES_PER_QUESTION == 0 && csg_mesh_should_stop(c->watch))
                return false;
            if (!csg_feature_move(store, i, probe, &fresh))
                continue;
            csg_feature_copy(&store->features[i], &fresh.feature);
            moved++;
        }
    }
    return true;
}

/* ---- where features meet -----------------------------------------------------------------------
 */

typedef struct uncrossing {
    csg_mesh_creases *creases;
    csg_feature_probe *probe;
    csg_feature_cross cross;
    size_t first, end; /* blocks that this process tests */
    csgm_status told;  /* all ranks know that one has failed: it is why */
} uncrossing;

static bool look_item(void *user, uint32_t worker, size_t item)
{
    uncrossing *u = user;
    (void)worker;
    csg_feature_cross_look(&u->cross, item);
    return true;
}

static bool measure_item(void *user, uint32_t worker, size_t item)
{
    uncrossing *u = user;
    (void)worker;
    csg_feature_cross_measure(&u->cross, item);
    return true;
}

static bool test_item(void *user, uint32_t worker, size_t item)
{
    uncrossing *u = user;
    csg_mesh_watch *watch = u->creases->watch;
    item += u->first;
    if (item % BLOCKS_PER_QUESTION == 0 && csg_mesh_should_stop(watch))
        return false;
    return csg_feature_cross_test(&u->cross, worker, item) || csg_mesh_stop_without_memory(watch);
}

/* The first block that rank `rank` tests: of those that are awake each has as many as the next. */
static size_t first_test_of(const uncrossing *u, uint32_t rank, size_t awake)
{
    const csg_ranks *ranks = u->creases->watch->context->ranks;
    size_t blocks = u->creases->store.block_count, before = 0;
    for (size_t i = 0; i < blocks && rank; i++) {
        if (!csg_feature_cross_is_awake(&u->cross, i))
            continue;
        if (before++ == awake * rank / ranks->by.count)
            return i;
    }
    return rank ? blocks : 0;
}

static void choose_tests(uncrossing *u)
{
    const csg_ranks *ranks = u->creases->watch->context->ranks;
    size_t blocks = u->creases->store.block_count, awake = 0;
    u->first = 0;
    u->end = blocks;
    if (!ranks)
        return;
    for (size_t i = 0; i < blocks; i++)
        awake += csg_feature_cross_is_awake(&u->cross, i);
    u->first = first_test_of(u, ranks->by.rank, awake);
    if (ranks->by.rank + 1 < ranks->by.count)
        u->end = first_test_of(u, ranks->by.rank + 1, awake);
}

/* What is known of a block is a byte: what the test says of it goes from the rank that has made it
 * to all others. All else is done by all alike, in one order. */
static bool test_blocks(uncrossing *u)
{
    csg_mesh_creases *c = u->creases;
    csgm_context *context = c->watch->context;
    choose_tests(u);
    bool done = csg_pool_run(context->pool, u->end - u->first, test_item, NULL, u);
    if (!context->ranks || !done)
        return done;
    csg_rank_pieces all;
    u->told = csg_ranks_gather(context, CSGM_OK, CSGM_ALL_RANKS, u->cross.blocks + u->first,
                               u->end - u->first, &all);
    if (u->told == CSGM_OK && all.total)
        memcpy(u->cross.blocks, all.bytes, (size_t)all.total);
    csg_rank_pieces_release(&context->memory, &all);
    return u->told == CSGM_OK;
}

/* Until nothing folds over and nothing meets anything else: in the end all are smooth. */
static bool settle_rounds(uncrossing *u)
{
    CSG_ZONE(u->creases->watch->context, "features: settle");
    csg_mesh_creases *c = u->creases;
    csg_pool *pool = c->watch->context->pool;
    for (size_t changed = 1; changed;) {
        while (csg_feature_settle(&c->store, &c->workers->tables, u->probe))
            if (csg_mesh_should_stop(c->watch))
                return false;
        csg_pool_run(pool, c->store.block_count, flip_item, NULL, c);
        csg_pool_run(pool, c->store.block_count, look_item, NULL, u);
        csg_feature_cross_wake(&u->cross);
        csg_pool_run(pool, c->store.block_count, measure_item, NULL, u);
        if (!test_blocks(u))
            return false;
        if (!csg_feature_cross_mend(&u->cross, &changed))
            return csg_mesh_stop_without_memory(c->watch);
    }
    return true;
}

/* False: asked to stop, or out of memory; *told is why where all ranks know it. */
static bool uncross_features(csg_mesh_creases *c, const csg_octree *octree,
                             csg_feature_probe *probe, csgm_status *told)
{
    csg_memory *memory = c->store.memory;
    csg_mesh_workers *workers = c->workers;
    size_t bytes = workers->count * sizeof(csg_near_room);
    uncrossing u = {.creases = c,
                    .probe = probe,
                    .cross = {.near = {.store = &c->store,
                                       .marching = &workers->marching,
                                       .octree = octree,
                                       .memory = memory},
                              .rooms = csg_memory_alloc(memory, bytes),
                              .room_count = workers->count}};
    if (!u.cross.rooms)
        return csg_mesh_stop_without_memory(c->watch);
    for (uint32_t i = 0; i < workers->count; i++)
        u.cross.rooms[i] = (csg_near_room){.edges = &workers->each[i].room->edges,
                                           .scratch = workers->each[i].scratch,
                                           .scratch_floats = workers->scratch_floats};
    bool done = csg_feature_cross_begin(&u.cross) || csg_mesh_stop_without_memory(c->watch);
    done = done && settle_rounds(&u);
    *told = u.told;
    for (uint32_t i = 0; i < workers->count; i++)
        workers->each[i].point_evaluations += u.cross.rooms[i].evaluations;
    csg_feature_cross_end(&u.cross);
    csg_memory_release(memory, u.cross.rooms, bytes);
    return done;
}

static csgm_status settle(csg_mesh_creases *c, const csg_octree *octree, csgm_status *told)
{
    CSG_ZONE(c->watch->context, "features: join");
    csgm_context *context = c->watch->context;
    csg_mesh_workers *workers = c->workers;
    csg_mesh_worker *self = &workers->each[0];
    if (!csg_feature_store_index(&c->store) ||
        !csg_feature_add_bare(&c->store, &workers->marching, octree, &self->room->edges,
                              self->scratch, workers->scratch_floats, &self->point_evaluations))
        return csg_context_no_memory(context);
    csg_pool_run(context->pool, c->store.block_count, link_item, NULL, c);
    csg_feature_around *around = &self->features->around;
    csg_feature_probe probe = csg_feature_probe_of(
        &workers->marching, NULL, around, &context->memory, self->scratch, workers->scratch_floats);
    bool done = order_features(c, &probe) && uncross_features(c, octree, &probe, told);
    self->point_evaluations += probe.evaluations;
    if (around->out_of_memory)
        done = csg_mesh_stop_without_memory(c->watch);
    return done || *told != CSGM_OK ? *told : csg_mesh_why_stopped(c->watch);
}

csgm_status csg_mesh_settle_features(csg_mesh_creases *c, const csg_octree *octree, csgm_status own)
{
    csgm_status told = CSGM_OK;
    if (own == CSGM_OK && c->sharp && octree)
        own = settle(c, octree, &told);
    return told != CSGM_OK ? told : csg_ranks_agree(c->watch->context, own);
}

void csg_mesh_creases_release(csg_mesh_creases *c)
{
    csg_feature_store_release(&c->store);
}
