/* SPDX-License-Identifier: MIT
 * Features without an apex; see bare.h. First the cells and lattice edges are listed, in
 * the order of the features, then sorted and each cell made once, then all are merged into their
 * blocks; blocks that had no features come last.
 */
#include "mesh/features/bare.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/features/cell.h"
#include "mesh/features/smooth.h"

enum { E = CSG_BLOCK_EDGE };

/* A cell of the lattice and one of its edges. */
typedef struct place {
    uint32_t cell[3];
    uint32_t edge;
} place;

/* New features of one block. */
typedef struct run {
    size_t block; /* of the store's; those behind the last are new */
    uint32_t at[3];
    size_t first, count;
} run;

typedef struct adding {
    csg_feature_store *store;
    const csg_marching *m;
    place *places;
    csg_feature *features;
    run *runs;
    size_t place_count, place_capacity, count, capacity, run_count, run_capacity;
} adding;

/* ---- which ------------------------------------------------------------------------------------
 */

/* The faces of its cell that the apex lies beyond. */
static unsigned faces_passed(const csg_marching *m, const uint32_t cell[3], const float at[3])
{
    unsigned faces = 0;
    for (int axis = 0; axis < 3; axis++) {
        faces |= (unsigned)(at[axis] < csg_lattice_coordinate(m->lattice, axis, cell[axis]))
                 << (2 * axis);
        faces |= (unsigned)(at[axis] > csg_lattice_coordinate(m->lattice, axis, cell[axis] + 1))
                 << (2 * axis + 1);
    }
    return faces;
}

/* The other three cells at an edge of a cell. */
static bool list_around(adding *a, const uint32_t cell[3], uint8_t edge)
{
    const uint8_t *offset = a->m->tables->offset[edge];
    unsigned along = edge / 4, first = along == 0 ? 1 : 0, second = along == 2 ? 1 : 2;
    if (!csg_memory_reserve(a->store->memory, (void **)&a->places, &a->place_capacity,
                            a->place_count + 3, sizeof *a->places))
        return false;
    for (unsigned k = 0; k < 4; k++) {
        place q = {.cell = {cell[0], cell[1], cell[2]}, .edge = 4 * along + k};
        q.cell[first] += offset[first] - (k & 1);
        q.cell[second] += offset[second] - (k >> 1);
        if (memcmp(q.cell, cell, sizeof q.cell) != 0)
            a->places[a->place_count++] = q;
    }
    return true;
}

/* Around the vertices of a feature on some faces of its cell. */
static bool list_feature(adding *a, const uint32_t cell[3], const csg_feature *f, unsigned faces)
{
    for (int s = 0; s < f->side_count; s++)
        if (a->m->tables->faces[f->side[s].edge] & faces && !list_around(a, cell, f->side[s].edge))
            return false;
    return true;
}

/* The features of the cell beyond a face that the apex has passed, on the other faces passed. */
static bool list_beyond(adding *a, const uint32_t cell[3], int face, unsigned passed)
{
    const csg_feature_store *store = a->store;
    uint32_t beyond[3] = {cell[0], cell[1], cell[2]}, at[3];
    beyond[face / 2] += face % 2 ? 1 : UINT32_MAX;
    for (int axis = 0; axis < 3; axis++)
        at[axis] = beyond[axis] / E;
    const csg_feature_block *block = csg_feature_store_find(store, at);
    uint16_t here = (uint16_t)(beyond[0] % E + (beyond[1] % E + beyond[2] % E * E) * E);
    for (uint32_t i = block ? block->first : 0; block && i < block->first + block->count; i++)
        if (store->features[i].cell == here &&
            !list_feature(a, beyond, &store->features[i], passed & ~(3u << (face & ~1))))
            return false;
    return true;
}

static bool list_corner(adding *a, const csg_feature_block *block, const csg_feature *f)
{
    uint32_t cell[3];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = block->at[axis] * E + (f->cell >> (3 * axis) & 7u);
    unsigned passed = faces_passed(a->m, cell, f->at);
    bool done = list_feature(a, cell, f, passed);
    for (int face = 0; face < 6 && done && passed & (passed - 1); face++)
        if (passed >> face & 1)
            done = list_beyond(a, cell, face, passed);
    return done;
}

static bool list_places(adding *a)
{
    const csg_feature_store *store = a->store;
    for (size_t b = 0; b < store->block_count; b++) {
        const csg_feature_block *block = &store->blocks[b];
        for (uint32_t i = block->first; i < block->first + block->count; i++) {
            const csg_feature *f = &store->features[i];
            if (f->state != CSG_FEATURE_UNSOLVED && f->sheet_count > 2 && !list_corner(a, block, f))
                return false;
        }
    }
    return true;
}

/* By blocks, then by cells within them. */
static int compare_places(const void *a, const void *b)
{
    const place *p = a, *q = b;
    for (int pass = 0; pass < 2; pass++)
        for (int axis = 2; axis >= 0; axis--) {
            uint32_t x = pass ? p->cell[axis] : p->cell[axis] / E;
            uint32_t y = pass ? q->cell[axis] : q->cell[axis] / E;
            if (x != y)
                return x < y ? -1 : 1;
        }
    return (p->edge > q->edge) - (p->edge < q->edge);
}

/* ---- making them ------------------------------------------------------------------------------
 */

static bool has_edge(const csg_feature *f, uint32_t edge)
{
    for (int s = 0; s < f->side_count; s++)
        if (f->side[s].edge == edge)
            return true;
    return false;
}

/* Whether one of features [first, first + count) of a cell has the edge. */
static bool is_known(const csg_feature *features, size_t first, size_t count, uint16_t cell,
                     uint32_t edge)
{
    for (size_t i = first; i < first + count; i++)
        if (features[i].cell == cell && has_edge(&features[i], edge))
            return true;
    return false;
}

static bool make_feature(const csg_cell_tables *tables, const csg_feature_cell *found,
                         uint16_t cell, uint32_t edge, csg_feature_whole *whole)
{
    csg_feature *f = &whole->feature;
    for (int loop = 0; loop < tables->loop_count[found->pattern]; loop++) {
        csg_feature_begin(whole,
                          &(csg_feature){.pattern = (uint8_t)found->pattern,
                                         .loop = (uint8_t)loop,
                                         .cell = cell,
                                         .side_count = tables->loop_sides[found->pattern][loop],
                                         .sheet_count = 1});
        csg_feature_enter(f, CSG_FEATURE_BARE);
        for (int s = 0; s < f->side_count; s++) {
            f->side[s].edge = tables->loop_edge[found->pattern][loop][s];
            f->side[s].beyond = CSG_FEATURE_NONE;
            memcpy(f->side[s].corner, found->at[f->side[s].edge], sizeof f->side[s].corner);
        }
        if (has_edge(f, edge)) {
            csg_feature_leave_plain(f, tables);
            return true;
        }
    }
    return false;
}

static run *run_of(adding *a, const uint32_t at[3])
{
    run *last = a->run_count ? &a->runs[a->run_count - 1] : NULL;
    if (last && !memcmp(last->at, at, sizeof last->at))
        return last;
    if (!csg_memory_reserve(a->store->memory, (void **)&a->runs, &a->run_capacity, a->run_count + 1,
                            sizeof *a->runs))
        return NULL;
    const csg_feature_block *block = csg_feature_store_find(a->store, at);
    size_t index =
        block ? (size_t)(block - a->store->blocks) : a->store->block_count + a->run_count;
    last = &a->runs[a->run_count++];
    *last = (run){.block = index, .at = {at[0], at[1], at[2]}, .first = a->count};
    return last;
}

static uint16_t cell_in_block(const place *q)
{
    return (uint16_t)(q->cell[0] % E + (q->cell[1] % E + q->cell[2] % E * E) * E);
}

/* Whether the store has the feature of a place. */
static bool is_in_store(const adding *a, const place *q)
{
    const uint32_t at[3] = {q->cell[0] / E, q->cell[1] / E, q->cell[2] / E};
    const csg_feature_block *block = csg_feature_store_find(a->store, at);
    return block &&
           is_known(a->store->features, block->first, block->count, cell_in_block(q), q->edge);
}

/* The feature of a place that is not in the store, if it was not made yet. */
static bool add_place(adding *a, const place *q, const csg_feature_cell *found)
{
    const uint32_t at[3] = {q->cell[0] / E, q->cell[1] / E, q->cell[2] / E};
    uint16_t cell = cell_in_block(q);
    run *to = run_of(a, at);
    if (!to)
        return false;
    csg_feature_whole fresh;
    if (is_known(a->features, to->first, to->count, cell, q->edge) ||
        !make_feature(a->m->tables, found, cell, q->edge, &fresh))
        return true;
    to->count++;
    return csg_feature_append(&a->features, &a->count, &a->capacity, &a->store->lists,
                              &fresh.feature);
}

/* ---- into the store ---------------------------------------------------------------------------
 */

static unsigned place_of(const csg_feature *f)
{
    return f->cell * (unsigned)CSG_CELL_MOST_LOOPS + f->loop;
}

static int compare_features(const void *a, const void *b)
{
    unsigned p = place_of(a), q = place_of(b);
    return (p > q) - (p < q);
}

static int compare_runs(const void *a, const void *b)
{
    const run *p = a, *q = b;
    return (p->block > q->block) - (p->block < q->block);
}

/* Adds a run to its block and moves the block's features back in the store, in place: they end
 * before *end, which is moved to where they begin. Blocks are merged from the last to the first, so
 * nothing is written over that is still needed. */
static void merge_block(const adding *a, csg_feature_block *block, const run *r, uint32_t *end)
{
    csg_feature *features = a->store->features;
    const csg_feature *added = r ? a->features + r->first : NULL;
    uint32_t old = block->count, fresh = r ? (uint32_t)r->count : 0, count = old + fresh;
    const csg_feature *before = features + block->first;
    block->bare = fresh;
    block->count = count;
    block->first = *end - count;
    if (features + block->first == before && !fresh) { /* nothing moves */
        *end = block->first;
        return;
    }
    while (old || fresh) {
        bool is_old = old && (!fresh || place_of(&before[old - 1]) >= place_of(&added[fresh - 1]));
        features[--*end] = is_old ? before[--old] : added[--fresh];
    }
}

/* Blocks that had no features get their places behind the others. */
static void add_blocks(adding *a)
{
    csg_feature_store *store = a->store;
    size_t known = store->block_count;
    for (size_t i = 0; i < a->run_count; i++) {
        const run *r = &a->runs[i];
        if (r->block >= known)
            store->blocks[store->block_count++] =
                (csg_feature_block){.at = {r->at[0], r->at[1], r->at[2]}};
    }
}

static bool merge(adding *a)
{
    csg_feature_store *store = a->store;
    size_t known = store->block_count, count = store->count + a->count, r = a->run_count;
    if (!csg_memory_reserve(store->memory, (void **)&store->features, &store->capacity, count,
                            sizeof *store->features) ||
        !csg_memory_reserve(store->memory, (void **)&store->blocks, &store->block_capacity,
                            known + a->run_count, sizeof *store->blocks))
        return false;
    qsort(a->runs, a->run_count, sizeof *a->runs, compare_runs);
    for (size_t i = 0; i < a->run_count; i++)
        qsort(a->features + a->runs[i].first, a->runs[i].count, sizeof *a->features,
              compare_features);
    add_blocks(a);
    uint32_t end = (uint32_t)count;
    for (size_t b = store->block_count; b-- > 0;) {
        bool grows = r > 0 && (b >= known || a->runs[r - 1].block == b);
        merge_block(a, &store->blocks[b], grows ? &a->runs[--r] : NULL, &end);
    }
    store->count = count;
    store->bare = a->count;
    return csg_feature_store_index(store);
}

bool csg_feature_add_bare(csg_feature_store *store, const csg_marching *m, const csg_octree *octree,
                          csg_edges *edges, float *scratch, size_t scratch_floats,
                          uint64_t *evaluations)
{
    csg_memory *memory = store->memory;
    adding a = {.store = store, .m = m};
    csg_feature_cell found = {0};
    const place *last = NULL; /* whose cell was found */
    bool done = list_places(&a);
    if (a.place_count)
        qsort(a.places, a.place_count, sizeof *a.places, compare_places);
    for (size_t i = 0; i < a.place_count && done; i++) {
        const place *q = &a.places[i];
        if (is_in_store(&a, q))
            continue;
        if (!last || memcmp(last->cell, q->cell, sizeof q->cell) != 0)
            *evaluations +=
                csg_feature_cell_find(m, octree, q->cell, edges, scratch, scratch_floats, &found);
        last = q;
        done = add_place(&a, q, &found);
    }
    done = done && (!a.count || merge(&a));
    csg_memory_release(memory, a.places, a.place_capacity * sizeof *a.places);
    csg_memory_release(memory, a.features, a.capacity * sizeof *a.features);
    csg_memory_release(memory, a.runs, a.run_capacity * sizeof *a.runs);
    return done;
}
