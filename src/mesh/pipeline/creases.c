/* SPDX-License-Identifier: MIT
 * The stage of the pipeline that finds sharp features (features/features.h): between sampling and
 * numbering of a slab's blocks. In a slab that is sampled again they are known.
 */
#include <string.h>

#include "base/pool.h"
#include "mesh/features/bare.h"
#include "mesh/features/cross.h"
#include "mesh/features/join.h"
#include "mesh/features/move.h"
#include "mesh/work.h"

/* What one item of the parallel loop has found, in the room of one worker. */
typedef struct csg_found_item {
    uint32_t worker;
    size_t first, count; /* of the room's blocks */
} found_item;

static bool find_item(void *user, uint32_t worker_index, size_t item)
{
    csg_mesh_work *w = user;
    if (csg_mesh_should_stop(w))
        return false;
    csg_mesh_worker *self = &w->workers[worker_index];
    found_item *found = &w->found[item];
    *found = (found_item){.worker = worker_index, .first = self->features->block_count};
    size_t end = (item + 1) * CSG_BLOCKS_PER_ITEM;
    for (size_t i = item * CSG_BLOCKS_PER_ITEM; i < end && i < w->block_count; i++)
        if (!csg_feature_find(&w->marching, w->blocks[i], self->features, &w->context->memory,
                              self->scratch, w->scratch_floats) ||
            self->features->around.out_of_memory) {
            atomic_store(&w->out_of_memory, true);
            return false;
        }
    found->count = self->features->block_count - found->first;
    return true;
}

static void empty_rooms(csg_mesh_work *w)
{
    for (uint32_t i = 0; i < w->worker_count; i++) {
        csg_feature_room *room = w->workers[i].features;
        w->features.smooth += room->smooth;
        w->features.fading += room->fading;
        w->workers[i].point_evaluations += room->evaluations;
        room->count = room->block_count = 0;
        room->smooth = room->fading = room->evaluations = 0;
    }
}

/* Joined in the order of the items, whoever did them. */
static bool collect(csg_mesh_work *w, size_t items)
{
    bool done = true;
    for (size_t i = 0; i < items && done; i++) {
        const found_item *found = &w->found[i];
        done = csg_feature_store_add(&w->features, w->workers[found->worker].features, found->first,
                                     found->count);
    }
    empty_rooms(w);
    return done;
}

/* Two triangles a feature more than without; in a cell with a joined face all loops are features,
 * and others than before. */
static uint32_t triangles_of(const csg_mesh_work *w, const csg_feature *f, uint32_t count)
{
    uint32_t triangles = 0;
    for (uint32_t k = 0; k < count; k++) {
        triangles += f[k].joined ? f[k].side_count : 2u;
        if (f[k].joined && (k == 0 || f[k].cell != f[k - 1].cell))
            triangles -= w->tables.count[f[k].pattern];
    }
    return triangles;
}

static void count_vertices(csg_mesh_work *w, size_t first_block)
{
    csg_feature_store *store = &w->features;
    for (size_t i = first_block; i < store->block_count; i++) {
        csg_feature_block *block = &store->blocks[i];
        block->vertices = block->count;
        for (uint32_t k = 0; w->split && k < block->count; k++)
            block->vertices += store->features[block->first + k].sheet_count - 1u;
        block->triangles = triangles_of(w, store->features + block->first, block->count);
    }
}

static void add_counts(csg_block *block, const csg_feature_block *features)
{
    block->vertex_count += features->vertices;
    block->triangle_count += features->triangles;
}

static void look_up(csg_mesh_work *w)
{
    for (size_t i = 0; i < w->block_count; i++) {
        const csg_feature_block *features = csg_feature_store_find(&w->features, w->blocks[i]->at);
        if (features)
            add_counts(w->blocks[i], features);
    }
}

/* Blocks at hand and blocks with features are both in Morton order. */
static void merge(csg_mesh_work *w, size_t first_block)
{
    const csg_feature_store *store = &w->features;
    size_t next = first_block;
    for (size_t i = 0; i < w->block_count && next < store->block_count; i++)
        if (!memcmp(w->blocks[i]->at, store->blocks[next].at, sizeof w->blocks[i]->at))
            add_counts(w->blocks[i], &store->blocks[next++]);
}

csgm_status csg_mesh_find_features(csg_mesh_work *w)
{
    if (w->options->features != CSGM_FEATURES_SHARP)
        return CSGM_OK;
    if (w->features.slots) { /* all were found before */
        look_up(w);
        return CSGM_OK;
    }
    csg_memory *memory = &w->context->memory;
    size_t items = csg_mesh_item_count(w), first_block = w->features.block_count;
    w->features.memory = memory;
    w->features.cell_size = w->lattice.cell_size;
    w->found = csg_memory_alloc(memory, (items + !items) * sizeof(found_item));
    if (!w->found)
        return csg_context_no_memory(w->context);
    memset(w->found, 0, items * sizeof(found_item));
    bool done = csg_pool_run(w->context->pool, items, find_item, NULL, w);
    if (done && !collect(w, items)) {
        atomic_store(&w->out_of_memory, true);
        done = false;
    }
    csg_memory_release(memory, w->found, (items + !items) * sizeof(found_item));
    w->found = NULL;
    if (!done)
        return csg_mesh_why_stopped(w);
    count_vertices(w, first_block);
    merge(w, first_block);
    return CSGM_OK;
}

void csg_mesh_number_features(csg_mesh_work *w)
{
    csg_feature_store *store = &w->features;
    if (w->options->features != CSGM_FEATURES_SHARP || store->slots)
        return;
    for (size_t i = 0; i < w->block_count && store->numbered < store->block_count; i++) {
        const csg_block *block = w->blocks[i];
        const csg_feature_block *features = &store->blocks[store->numbered];
        if (memcmp(block->at, features->at, sizeof block->at) != 0)
            continue;
        uint32_t vertex = block->first_vertex + block->vertex_count - features->vertices;
        for (uint32_t k = 0; k < features->count; k++) {
            csg_feature *f = &store->features[features->first + k];
            f->vertex = vertex;
            vertex += w->split ? f->sheet_count : 1u;
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
    csg_mesh_work *w = user;
    (void)worker;
    csg_feature_link(&w->features, &w->tables, item);
    return true;
}

static bool flip_item(void *user, uint32_t worker, size_t item)
{
    csg_mesh_work *w = user;
    (void)worker;
    csg_feature_flip(&w->features, &w->tables, item);
    return true;
}

/* Apexes out of order between their neighbours, in the order of the features, so that the outcome
 * does not depend on threads: there are few. Each sees where those before it have gone. */
static bool order_features(csg_mesh_work *w, csg_feature_probe *probe)
{
    enum { ROUNDS = 3 };
    csg_feature_store *store = &w->features;
    size_t moved = 1;
    for (int round = 0; round < ROUNDS && moved; round++) {
        moved = 0;
        for (uint32_t i = 0; i < store->count; i++) {
            csg_feature fresh;
            if (i % FEATURES_PER_QUESTION == 0 && csg_mesh_should_stop(w))
                return false;
            if (!csg_feature_move(store, i, probe, &fresh))
                continue;
            store->features[i] = fresh;
            moved++;
        }
    }
    return true;
}

/* ---- where features meet -----------------------------------------------------------------------
 */

typedef struct crossing_work {
    csg_mesh_work *w;
    csg_feature_probe *probe;
    csg_feature_cross cross;
} crossing_work;

static bool look_item(void *user, uint32_t worker, size_t item)
{
    crossing_work *c = user;
    (void)worker;
    csg_feature_cross_look(&c->cross, item);
    return true;
}

static bool test_item(void *user, uint32_t worker, size_t item)
{
    crossing_work *c = user;
    if (item % BLOCKS_PER_QUESTION == 0 && csg_mesh_should_stop(c->w))
        return false;
    if (csg_feature_cross_test(&c->cross, worker, item))
        return true;
    atomic_store(&c->w->out_of_memory, true);
    return false;
}

/* Until nothing folds over and nothing meets anything else: in the end all are smooth. */
static bool settle_rounds(crossing_work *c)
{
    csg_mesh_work *w = c->w;
    csg_feature_store *store = &w->features;
    for (size_t changed = 1; changed;) {
        while (csg_feature_settle(store, &w->tables, c->probe))
            if (csg_mesh_should_stop(w))
                return false;
        csg_pool_run(w->context->pool, store->block_count, flip_item, NULL, w);
        csg_pool_run(w->context->pool, store->block_count, look_item, NULL, c);
        csg_feature_cross_wake(&c->cross);
        if (!csg_pool_run(w->context->pool, store->block_count, test_item, NULL, c))
            return false;
        if (!csg_feature_cross_mend(&c->cross, &changed)) {
            atomic_store(&w->out_of_memory, true);
            return false;
        }
    }
    return true;
}

/* False: asked to stop, or out of memory. */
static bool uncross_features(csg_mesh_work *w, csg_feature_probe *probe)
{
    csg_memory *memory = &w->context->memory;
    size_t bytes = w->worker_count * sizeof(csg_near_room);
    crossing_work c = {.w = w,
                       .probe = probe,
                       .cross = {.near = {.store = &w->features,
                                          .marching = &w->marching,
                                          .octree = w->octree,
                                          .memory = memory},
                                 .rooms = csg_memory_alloc(memory, bytes),
                                 .room_count = w->worker_count}};
    if (!c.cross.rooms) {
        atomic_store(&w->out_of_memory, true);
        return false;
    }
    for (uint32_t i = 0; i < w->worker_count; i++)
        c.cross.rooms[i] = (csg_near_room){.edges = &w->workers[i].room->edges,
                                           .scratch = w->workers[i].scratch,
                                           .scratch_floats = w->scratch_floats};
    bool done = csg_feature_cross_begin(&c.cross);
    if (!done)
        atomic_store(&w->out_of_memory, true);
    done = done && settle_rounds(&c);
    for (uint32_t i = 0; i < w->worker_count; i++)
        w->workers[i].point_evaluations += c.cross.rooms[i].evaluations;
    csg_feature_cross_end(&c.cross);
    csg_memory_release(memory, c.cross.rooms, bytes);
    return done;
}

/* False: asked to stop, or out of memory. */
static bool settle_features(csg_mesh_work *w)
{
    csg_feature_probe probe =
        csg_feature_probe_of(&w->marching, NULL, &w->workers[0].features->around,
                             &w->context->memory, w->workers[0].scratch, w->scratch_floats);
    bool done = order_features(w, &probe) && uncross_features(w, &probe);
    w->workers[0].point_evaluations += probe.evaluations;
    if (w->workers[0].features->around.out_of_memory) {
        atomic_store(&w->out_of_memory, true);
        return false;
    }
    return done;
}

csgm_status csg_mesh_link_features(csg_mesh_work *w)
{
    if (w->options->features != CSGM_FEATURES_SHARP || !w->octree)
        return CSGM_OK;
    csg_mesh_worker *self = &w->workers[0];
    if (!csg_feature_store_index(&w->features) ||
        !csg_feature_add_bare(&w->features, &w->marching, w->octree, &self->room->edges,
                              self->scratch, w->scratch_floats, &self->point_evaluations))
        return csg_context_no_memory(w->context);
    csg_pool_run(w->context->pool, w->features.block_count, link_item, NULL, w);
    return settle_features(w) ? CSGM_OK : csg_mesh_why_stopped(w);
}
