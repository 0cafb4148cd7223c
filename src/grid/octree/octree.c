/* SPDX-License-Identifier: MIT
 * The octree walk; see octree.h. A cell of level l is a cube of 2^l blocks; level 0 is sampled.
 */
#include "grid/octree/octree.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "field/kernels/dispatch.h"
#include "field/prune/prune.h"

typedef struct cell {
    uint32_t at[3]; /* in cubes of its level */
    uint32_t node_count;
    const csg_tape_node *nodes;
} cell;

enum {
    CELLS_PER_ITEM = 16, /* at most: the few cells of the upper levels have the longest tapes */
    ITEMS_PER_WORKER = 16,
    /* Blocks with longer tapes are split into parts with tapes of their own. Measured on a million
     * spheres: see tests/bench/log.md. */
    LONG_TAPE = 6,
    LONG_LIST = 4
};

/* What one item of a level produced, and where it is. */
typedef struct segment {
    uint32_t worker;
    size_t first, count;
} segment;

typedef struct worker {
    csg_pruner pruner, part_pruner;
    csg_arena tapes[2]; /* of even and odd levels: a level's parents are dropped after it */
    cell *cells;
    csg_block **blocks; /* in tapes[0] */
    size_t cell_count, cell_capacity, block_count, block_capacity;
    csg_block candidate; /* the block being sampled */
    csg_block_samples *samples;
    csg_beads beads;
    float *scratch;
    size_t scratch_floats;
    csg_octree_stats stats;
    csg_scan *doubts;
    size_t doubt_count, doubt_capacity;
} worker;

struct csg_octree {
    csgm_context *context;
    const csgm_field *field;
    const csg_lattice *lattice;
    csg_octree_options options;
    const csg_kernel *kernel;
    worker *workers;
    uint32_t worker_count;
    csg_scan *doubts; /* of all workers, once asked for */
    size_t doubt_count;
    size_t scanned; /* frontier cells whose samples were looked at */
    bool scans;     /* in the sampling at hand */
    float tau;      /* the band: by how much f can change along a lattice edge */
    cell *cells;    /* the level being split; at the end the frontier */
    size_t cell_count;
    size_t first_cell, end_cell; /* of them, those being split */
    const size_t *picked;        /* instead: cell i is picked[i] of them; NULL = none are */
    size_t first_sampled;        /* csg_octree_is_before_sampled */
    size_t cells_per_item;
    csg_block **blocks; /* sampled last, in Morton order */
    size_t block_count;
    segment *segments; /* one an item */
    int level;         /* of the children being made */
    int top_level;
    atomic_bool out_of_memory, cancelled;
};

typedef csg_octree walk;

/* ---- one cell ------------------------------------------------------------------------------- */

/* Whether a cube of this level has any cell of the lattice. */
static bool is_in_lattice(const walk *w, const uint32_t at[3])
{
    for (int axis = 0; axis < 3; axis++)
        if ((uint64_t)at[axis] << w->level >= w->lattice->blocks[axis])
            return false;
    return true;
}

/* By how much f can change along a lattice edge. */
static float band_of(const csg_lattice *lattice, double margin, float lipschitz)
{
    double edge = lattice->cell_size * (margin > 0 ? 2 : 1);
    return (float)((double)lipschitz *
                   (edge * (1 + 0x1p-10) + 2 * (double)csg_octree_rounding(lattice)));
}

/* Centres of the eight children; returns the radius of their balls. */
static float octant_balls(const walk *w, const cell *parent, float c[3][CSG_OCTANTS])
{
    uint32_t half = (uint32_t)(CSG_BLOCK_EDGE / 2) << w->level;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        uint32_t at[3];
        csg_lattice_octant(parent->at, octant, at);
        for (int axis = 0; axis < 3; axis++)
            c[axis][octant] = csg_lattice_coordinate(w->lattice, axis, at[axis] * 2 * half + half);
    }
    return csg_lattice_ball_radius(w->lattice, w->options.margin, half);
}

static bool keep_cell(walk *w, worker *self, const uint32_t at[3], const csg_tape *tape)
{
    if (!csg_memory_reserve(&w->context->memory, (void **)&self->cells, &self->cell_capacity,
                            self->cell_count + 1, sizeof(cell)))
        return false;
    cell *c = &self->cells[self->cell_count++];
    memcpy(c->at, at, sizeof c->at);
    c->nodes = tape->nodes;
    c->node_count = tape->count;
    return true;
}

bool csg_octree_split(csg_pruner *pruner, const csg_lattice *lattice, double margin,
                      const uint32_t at[3], const csg_tape *tape, csg_arena *arena,
                      csg_block_part parts[CSG_OCTANTS])
{
    float c[3][CSG_OCTANTS], tau = band_of(lattice, margin, tape->lipschitz);
    for (int octant = 0; octant < CSG_OCTANTS; octant++)
        for (int axis = 0; axis < 3; axis++) {
            uint32_t half = CSG_PART_EDGE / 2, shift = (octant >> axis & 1) * CSG_PART_EDGE;
            c[axis][octant] =
                csg_lattice_coordinate(lattice, axis, at[axis] * CSG_BLOCK_EDGE + shift + half);
        }
    if (!csg_prune_octants(pruner, tape, c[0], c[1], c[2],
                           csg_lattice_ball_radius(lattice, margin, CSG_PART_EDGE / 2)))
        return false;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        csg_tape part = *tape;
        csg_cell_state state = csg_prune_state(pruner, octant);
        if (state == CSG_CELL_SURFACE && !csg_prune_shorten(pruner, octant, tau, arena, &part))
            return false;
        parts[octant] = (csg_block_part){part.nodes, part.count, state};
    }
    return true;
}

/* Tapes for the parts of a block, in the arena of blocks. */
static bool split_block(walk *w, worker *self, const uint32_t at[3], const csg_tape *tape)
{
    csg_block_part *parts = csg_arena_alloc(&self->tapes[0], CSG_OCTANTS * sizeof *parts);
    if (!parts || !csg_octree_split(&self->part_pruner, w->lattice, w->options.margin, at, tape,
                                    &self->tapes[0], parts))
        return false;
    self->stats.interval_evaluations += CSG_OCTANTS;
    self->candidate.parts = parts;
    return true;
}

static void count_samples(worker *self, const csg_tape *tape)
{
    const csg_block_part *parts = self->candidate.parts;
    enum { PART_POINTS = (CSG_PART_EDGE + 1) * (CSG_PART_EDGE + 1) * (CSG_PART_EDGE + 1) };
    csg_octree_stats *stats = &self->stats;
    stats->sampled_blocks++;
    if (!parts) {
        stats->point_evaluations += CSG_BLOCK_POINTS;
        stats->primitive_evaluations += (uint64_t)CSG_BLOCK_POINTS * csg_tape_leaf_count(tape);
        stats->tape_nodes_sampled += tape->count;
        return;
    }
    uint64_t nodes = 0;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        if (parts[octant].state != CSG_CELL_SURFACE)
            continue;
        csg_tape part = {.nodes = parts[octant].nodes, .count = parts[octant].node_count};
        stats->point_evaluations += PART_POINTS;
        stats->primitive_evaluations += (uint64_t)PART_POINTS * csg_tape_leaf_count(&part);
        nodes += part.count;
    }
    stats->tape_nodes_sampled += nodes / CSG_OCTANTS;
}

static bool keep_doubt(walk *w, worker *self, const csg_scan *scan)
{
    if (!(scan->doubt > 0))
        return true;
    if (!csg_memory_reserve(&w->context->memory, (void **)&self->doubts, &self->doubt_capacity,
                            self->doubt_count + 1, sizeof *scan))
        return false;
    self->doubts[self->doubt_count++] = *scan;
    return true;
}

/* Whether parts of a block are worth tapes of their own: it has many nodes, or a shape of which
 * much is near. */
static bool is_long(const csg_tape *tape)
{
    bool any = tape->count > LONG_TAPE;
    for (uint32_t i = 0; i < tape->count && !any; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        any = node->op == CSG_OP_SHAPE && node->near && node->near->count >= LONG_LIST;
    }
    return any;
}

static bool sample_block(walk *w, worker *self, const uint32_t at[3], const csg_tape *tape)
{
    csg_arena_mark mark = csg_arena_get_mark(&self->tapes[0]);
    self->candidate.parts = NULL;
    if (w->options.prune && is_long(tape) && !split_block(w, self, at, tape))
        return false;
    count_samples(self, tape);
    csg_scan scan = {.span = (float)(w->lattice->cell_size * (double)tape->lipschitz)};
    csg_beads *beads = w->options.beads ? &self->beads : NULL;
    bool scans_first = w->scans && csg_scan_comes_first(tape);
    bool scans =
        scans_first || (w->scans && csg_scan_is_due(w->lattice, w->options.margin, at, tape));
    self->samples->scan = scans ? &scan : NULL;
    bool crossed = csg_block_sample(&self->candidate, w->kernel, tape, w->lattice, at, beads,
                                    self->samples, self->scratch, self->scratch_floats);
    if (scan.doubt > 0 && scans_first && !csg_scan_is_due(w->lattice, w->options.margin, at, tape))
        scan.doubt = 0;
    if (!keep_doubt(w, self, &scan))
        return false;
    if (!crossed) {
        csg_arena_release_to(&self->tapes[0], mark);
        return true;
    }
    csg_block *block = csg_arena_alloc(&self->tapes[0], sizeof *block);
    if (!block || !csg_memory_reserve(&w->context->memory, (void **)&self->blocks,
                                      &self->block_capacity, self->block_count + 1, sizeof block))
        return false;
    *block = self->candidate;
    self->blocks[self->block_count++] = block;
    return !csg_block_keeps_ends(tape) ||
           csg_block_keep_ends(block, self->samples, &self->tapes[0]);
}

static bool visit_octant(walk *w, worker *self, const csg_tape *parent, int octant,
                         const uint32_t at[3], const csg_tape **shared)
{
    csg_arena *arena = &self->tapes[w->level & 1];
    csg_tape tape = *parent;
    self->stats.visited++;
    if (w->options.prune) {
        csg_cell_state state = csg_prune_state(&self->pruner, octant);
        self->stats.pruned_outside += state == CSG_CELL_OUTSIDE;
        self->stats.pruned_inside += state == CSG_CELL_INSIDE;
        if (state != CSG_CELL_SURFACE)
            return true;
        if (!csg_prune_shorten(&self->pruner, octant, w->tau, arena, &tape))
            return false;
        if (tape.nodes == parent->nodes && *shared)
            tape = **shared; /* an elder sibling has copied it already */
        else if (tape.nodes == parent->nodes) {
            csg_tape *copy = csg_arena_alloc(arena, sizeof *copy);
            if (!copy || !csg_prune_copy(&tape, arena))
                return false;
            *copy = tape;
            *shared = copy;
        }
    }
    return w->level ? keep_cell(w, self, at, &tape) : sample_block(w, self, at, &tape);
}

static bool split(walk *w, worker *self, const cell *parent)
{
    csg_tape tape = w->field->tape;
    tape.nodes = parent->nodes;
    tape.count = parent->node_count;
    const csg_tape *shared = NULL;
    if (w->options.prune) {
        float c[3][CSG_OCTANTS];
        float radius = octant_balls(w, parent, c);
        if (!csg_prune_octants(&self->pruner, &tape, c[0], c[1], c[2], radius))
            return false;
        self->stats.interval_evaluations += CSG_OCTANTS;
        self->stats.primitive_evaluations += (uint64_t)CSG_OCTANTS * csg_tape_leaf_count(&tape);
    }
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        uint32_t at[3];
        csg_lattice_octant(parent->at, octant, at);
        if (is_in_lattice(w, at) && !visit_octant(w, self, &tape, octant, at, &shared))
            return false;
    }
    return true;
}

/* ---- one level ------------------------------------------------------------------------------- */

static bool split_item(void *user, uint32_t worker_index, size_t item)
{
    walk *w = user;
    worker *self = &w->workers[worker_index];
    if (w->options.cancelled && w->options.cancelled(w->options.user)) {
        atomic_store(&w->cancelled, true);
        return false;
    }
    segment *s = &w->segments[item];
    s->worker = worker_index;
    s->first = w->level ? self->cell_count : self->block_count;
    size_t first = w->first_cell + item * w->cells_per_item, end = first + w->cells_per_item;
    for (size_t i = first; i < end && i < w->end_cell; i++) {
        if (!split(w, self, &w->cells[w->picked ? w->picked[i] : i])) {
            atomic_store(&w->out_of_memory, true);
            return false;
        }
    }
    s->count = (w->level ? self->cell_count : self->block_count) - s->first;
    return true;
}

static void report_progress(void *user, size_t done, size_t count)
{
    walk *w = user;
    /* Each level has about four times the cells of the one above. */
    double share = ldexp(1, -2 * w->level);
    if (w->options.progress)
        w->options.progress(w->options.user, share * ((double)done / (double)count));
}

/* The items' results, of `element` bytes each, in the order of their parents. NULL without any. */
static bool join_items(walk *w, size_t item_count, size_t element, void **joined, size_t *total)
{
    *total = 0;
    for (size_t i = 0; i < item_count; i++)
        *total += w->segments[i].count;
    *joined = *total ? csg_memory_alloc(&w->context->memory, *total * element) : NULL;
    if (*total && !*joined)
        return false;
    uint8_t *at = *joined;
    for (size_t i = 0; i < item_count; i++) {
        const segment *s = &w->segments[i];
        const worker *from = &w->workers[s->worker];
        if (!s->count)
            continue;
        if (w->level)
            memcpy(at, from->cells + s->first, s->count * element);
        else
            memcpy(at, from->blocks + s->first, s->count * element);
        at += s->count * element;
    }
    return true;
}

/* The cubes that the children are, for a trace; 0: they are blocks, and sampled. */
static const char *zone_of_level(int level)
{
    static const char *const names[] = {
        "sampling",        "octree level 1",  "octree level 2",  "octree level 3",
        "octree level 4",  "octree level 5",  "octree level 6",  "octree level 7",
        "octree level 8",  "octree level 9",  "octree level 10", "octree level 11",
        "octree level 12", "octree level 13", "octree level 14", "octree level 15",
        "octree level 16", "octree level 17", "octree level 18"};
    const int most = (int)(sizeof names / sizeof *names) - 1;
    return names[level < most ? level : most];
}

/* Splits cells [first_cell, end_cell); the children, cells or blocks, come back joined. */
static bool run_level(walk *w, size_t element, void **joined, size_t *total)
{
    CSG_ZONE(w->context, zone_of_level(w->level));
    csg_memory *memory = &w->context->memory;
    size_t cells = w->end_cell - w->first_cell;
    size_t most = cells / (ITEMS_PER_WORKER * (size_t)w->worker_count) + 1;
    w->cells_per_item = most < CELLS_PER_ITEM ? most : CELLS_PER_ITEM;
    size_t items = (cells + w->cells_per_item - 1) / w->cells_per_item;
    w->segments = csg_memory_alloc(memory, (items + 1) * sizeof(segment));
    if (!w->segments) {
        atomic_store(&w->out_of_memory, true);
        return false;
    }
    bool done = csg_pool_run(w->context->pool, items, split_item, report_progress, w);
    if (done && !join_items(w, items, element, joined, total)) {
        atomic_store(&w->out_of_memory, true);
        done = false;
    }
    csg_zone_count(w->context, "cells", cells);
    csg_zone_count(w->context, w->level ? "children" : "blocks", done ? *total : 0);
    csg_memory_release(memory, w->segments, (items + 1) * sizeof(segment));
    for (uint32_t i = 0; i < w->worker_count; i++)
        w->workers[i].cell_count = w->workers[i].block_count = 0;
    return done;
}

/* Replaces the cells by their children of the next level down. */
static bool descend(walk *w)
{
    void *children;
    size_t count;
    w->first_cell = 0;
    w->end_cell = w->cell_count;
    if (!run_level(w, sizeof(cell), &children, &count))
        return false;
    csg_memory_release(&w->context->memory, w->cells, w->cell_count * sizeof(cell));
    w->cells = children;
    w->cell_count = count;
    for (uint32_t i = 0; i < w->worker_count; i++)
        csg_arena_reset(&w->workers[i].tapes[(w->level + 1) & 1]);
    return true;
}

/* ---- the walk ---------------------------------------------------------------------------------
 */

static bool create_workers(walk *w, float rounding)
{
    csg_memory *memory = &w->context->memory;
    w->workers = csg_memory_alloc(memory, w->worker_count * sizeof(worker));
    if (!w->workers)
        return false;
    bool done = true;
    for (uint32_t i = 0; i < w->worker_count; i++) {
        worker *self = &w->workers[i];
        memset(self, 0, sizeof *self);
        csg_pruner_init(&self->pruner, memory, w->kernel, rounding);
        csg_pruner_init(&self->part_pruner, memory, w->kernel, rounding);
        csg_arena_init(&self->tapes[0], memory);
        csg_arena_init(&self->tapes[1], memory);
        self->scratch_floats = csg_kernel_scratch_floats(w->field->depth);
        self->samples = csg_memory_alloc(memory, sizeof *self->samples);
        self->scratch = csg_memory_alloc(memory, self->scratch_floats * sizeof(float));
        self->beads = (csg_beads){.kernel = w->kernel,
                                  .tape = &w->field->tape,
                                  .lattice = w->lattice,
                                  .scratch = self->scratch,
                                  .scratch_floats = self->scratch_floats};
        done = done && self->samples && self->scratch;
    }
    return done;
}

/* The cells that they have made: all are joined, and what is made of the frontier is blocks. */
static void release_cells(walk *w)
{
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        worker *self = &w->workers[i];
        csg_memory_release(&w->context->memory, self->cells, self->cell_capacity * sizeof(cell));
        self->cells = NULL;
        self->cell_capacity = 0;
    }
}

static void release_workers(walk *w)
{
    csg_memory *memory = &w->context->memory;
    release_cells(w);
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        worker *self = &w->workers[i];
        csg_pruner_release(&self->pruner);
        csg_pruner_release(&self->part_pruner);
        csg_arena_reset(&self->tapes[0]);
        csg_arena_reset(&self->tapes[1]);
        csg_memory_release(memory, self->blocks, self->block_capacity * sizeof(csg_block *));
        csg_memory_release(memory, self->doubts, self->doubt_capacity * sizeof *self->doubts);
        csg_memory_release(memory, self->samples, sizeof *self->samples);
        csg_memory_release(memory, self->scratch, self->scratch_floats * sizeof(float));
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof(worker));
}

/* The root: one cube of 2^top_level >= 2 blocks along an edge, around the whole lattice. */
static bool make_root(walk *w)
{
    uint32_t most = 1;
    for (int axis = 0; axis < 3; axis++)
        most = w->lattice->blocks[axis] > most ? w->lattice->blocks[axis] : most;
    w->top_level = 1;
    while (1u << w->top_level < most)
        w->top_level++;
    w->cells = csg_memory_alloc(&w->context->memory, sizeof(cell));
    if (!w->cells)
        return false;
    *w->cells = (cell){.nodes = w->field->tape.nodes, .node_count = w->field->tape.count};
    w->cell_count = 1;
    return true;
}

static csgm_status why_stopped(walk *w)
{
    return atomic_load(&w->out_of_memory) ? csg_context_no_memory(w->context) : CSGM_CANCELLED;
}

/* 32 ulp of the extent: see rounding_of in field/compile/compile_leaf.c, which covers the leaves'
 * own lengths. */
float csg_octree_rounding(const csg_lattice *lattice)
{
    return (float)(32 * (double)FLT_EPSILON * csg_lattice_extent(lattice));
}

csgm_status csg_octree_create(csgm_context *context, const csgm_field *field,
                              const csg_lattice *lattice, const csg_octree_options *options,
                              csg_octree **out)
{
    CSG_ZONE(context, "octree");
    walk *w = csg_memory_alloc(&context->memory, sizeof *w);
    if (!w)
        return csg_context_no_memory(context);
    *w = (walk){.context = context,
                .field = field,
                .lattice = lattice,
                .options = *options,
                .kernel = csg_kernel_for(context->isa),
                .worker_count = csg_pool_threads(context->pool)};
    w->tau = band_of(lattice, options->margin, field->tape.lipschitz);
    bool done = create_workers(w, csg_octree_rounding(lattice)) && make_root(w);
    if (!done)
        atomic_store(&w->out_of_memory, true);
    for (w->level = w->top_level - 1; done && w->level > 0; w->level--)
        done = descend(w);
    if (done) {
        release_cells(w);
        *out = w;
        return CSGM_OK;
    }
    csgm_status status = why_stopped(w);
    csg_octree_destroy(w);
    return status;
}

static void forget_blocks(walk *w)
{
    csg_memory_release(&w->context->memory, w->blocks, w->block_count * sizeof(csg_block *));
    w->blocks = NULL;
    w->block_count = 0;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++)
        csg_arena_reset(&w->workers[i].tapes[0]);
}

void csg_octree_destroy(csg_octree *w)
{
    if (!w)
        return;
    csg_memory *memory = &w->context->memory;
    forget_blocks(w);
    release_workers(w);
    csg_memory_release(memory, w->doubts, w->doubt_count * sizeof *w->doubts);
    csg_memory_release(memory, w->cells, w->cell_count * sizeof(cell));
    csg_memory_release(memory, w, sizeof *w);
}

size_t csg_octree_frontier_count(const csg_octree *octree)
{
    return octree->cell_count;
}

csg_tape csg_octree_frontier_tape(const csg_octree *w, size_t index, uint32_t at[3])
{
    csg_tape tape = w->field->tape;
    const cell *c = &w->cells[index];
    memcpy(at, c->at, sizeof c->at);
    tape.nodes = c->nodes;
    tape.count = c->node_count;
    return tape;
}

const uint32_t *csg_octree_frontier_at(const csg_octree *w, size_t index)
{
    return w->cells[index].at;
}

size_t csg_octree_find(const csg_octree *w, const uint32_t at[3])
{
    size_t low = 0, high = w->cell_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (csg_lattice_compare_morton(w->cells[middle].at, at) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    bool is_there = low < w->cell_count && !memcmp(w->cells[low].at, at, sizeof w->cells->at);
    return is_there ? low : w->cell_count;
}

static csgm_status sample(csg_octree *w)
{
    void *blocks;
    forget_blocks(w);
    w->level = 0;
    if (!run_level(w, sizeof(csg_block *), &blocks, &w->block_count)) {
        w->block_count = 0;
        return why_stopped(w);
    }
    w->blocks = blocks;
    return CSGM_OK;
}

csgm_status csg_octree_sample(csg_octree *w, size_t first, size_t end)
{
    w->first_cell = w->first_sampled = first;
    w->end_cell = end;
    w->scans = w->options.scan && first >= w->scanned; /* a slab is sampled twice */
    w->scanned = end > w->scanned ? end : w->scanned;
    return sample(w);
}

csgm_status csg_octree_sample_picked(csg_octree *w, const size_t *picked, size_t count,
                                     size_t first_sampled)
{
    w->first_cell = 0;
    w->end_cell = count;
    w->first_sampled = first_sampled;
    w->scans = false;
    w->picked = picked;
    csgm_status status = sample(w);
    w->picked = NULL;
    return status;
}

void csg_octree_end_scan(csg_octree *w)
{
    w->options.scan = false;
}

csg_block *const *csg_octree_blocks(const csg_octree *octree, size_t *count)
{
    *count = octree->block_count;
    return octree->blocks;
}

bool csg_octree_is_before_sampled(const csg_octree *w, const uint32_t at[3])
{
    uint32_t cube[3] = {at[0] / 2, at[1] / 2, at[2] / 2};
    return csg_lattice_compare_morton(cube, w->cells[w->first_sampled].at) < 0;
}

static int compare_doubts(const void *a, const void *b)
{
    const csg_scan *one = a, *other = b;
    for (int axis = 2; axis >= 0; axis--)
        if (one->point[axis] != other->point[axis])
            return one->point[axis] < other->point[axis] ? -1 : 1;
    return one->axis < other->axis ? -1 : one->axis > other->axis;
}

const csg_scan *csg_octree_doubts(csg_octree *w, size_t *count, uint64_t *edges)
{
    *edges = 0;
    *count = 0;
    for (uint32_t i = 0; i < w->worker_count; i++)
        *count += w->workers[i].doubt_count;
    csg_memory_release(&w->context->memory, w->doubts, w->doubt_count * sizeof *w->doubts);
    w->doubt_count = 0;
    w->doubts = *count ? csg_memory_alloc(&w->context->memory, *count * sizeof *w->doubts) : NULL;
    for (uint32_t i = 0; w->doubts && i < w->worker_count; i++) {
        const worker *from = &w->workers[i];
        for (size_t k = 0; k < from->doubt_count; k++) {
            *edges += from->doubts[k].count;
            w->doubts[w->doubt_count++] = from->doubts[k];
        }
    }
    if (w->doubts) /* workers share them out as it happens */
        qsort(w->doubts, w->doubt_count, sizeof *w->doubts, compare_doubts);
    return w->doubts;
}

bool csg_octree_adopt_doubts(csg_octree *w, const csg_scan *doubts, size_t count)
{
    for (uint32_t i = 0; i < w->worker_count; i++)
        w->workers[i].doubt_count = 0;
    worker *first = &w->workers[0];
    if (count && !csg_memory_reserve(&w->context->memory, (void **)&first->doubts,
                                     &first->doubt_capacity, count, sizeof *doubts))
        return false;
    if (count)
        memcpy(first->doubts, doubts, count * sizeof *doubts);
    first->doubt_count = count;
    return true;
}

csg_octree_stats csg_octree_get_stats(const csg_octree *w)
{
    csg_octree_stats total = {0};
    for (uint32_t i = 0; i < w->worker_count; i++) {
        const csg_octree_stats *part = &w->workers[i].stats;
        total.visited += part->visited;
        total.pruned_outside += part->pruned_outside;
        total.pruned_inside += part->pruned_inside;
        total.sampled_blocks += part->sampled_blocks;
        total.interval_evaluations += part->interval_evaluations;
        total.point_evaluations += part->point_evaluations;
        total.primitive_evaluations += part->primitive_evaluations;
        total.tape_nodes_sampled += part->tape_nodes_sampled;
    }
    return total;
}
