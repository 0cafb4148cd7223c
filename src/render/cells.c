/* SPDX-License-Identifier: MIT
 * The octree of rays; see cells.h.
 */
#include "render/cells.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "field/kernels/dispatch.h"

enum {
    FIRST_WIDE_LEVEL = 4,
    LAST_WIDE_LEVEL = 6,
    LONG_WIDE_TAPE = 48, /* mean length above which the reach is halved */
    LONG_NEAR_TAPE =
        5, /* leaves with longer tapes are split; 2 to 40 cost the same within a tenth */
    PARENTS_PER_ITEM = 4
};

typedef struct worker {
    csg_pruner pruner;
    uint64_t interval_evaluations, primitive_evaluations;
} worker;

typedef struct build {
    csg_ray_cells *out;
    const csg_ray_cells_options *options;
    const csg_kernel *kernel;
    worker *workers;
    size_t first, end;      /* the parents */
    csg_ray_cell *children; /* eight a parent; half 0 = none */
    int level;              /* of the children */
    float reach;            /* at this level */
    atomic_bool out_of_memory, cancelled;
} build;

static csg_tape tape_of(const build *b, const csg_tape_node *nodes, uint32_t count)
{
    csg_tape tape = b->out->field->tape;
    tape.nodes = nodes;
    tape.count = count;
    return tape;
}

/* Intervals over the cubes of this half size around the children's centres. */
static bool look(build *b, worker *self, const csg_tape *tape, const csg_ray_cell *children,
                 float half)
{
    float c[3][CSG_OCTANTS];
    for (int o = 0; o < CSG_OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++)
            c[axis][o] = children[o].center[axis];
    uint64_t leaves = 0;
    for (uint32_t i = 0; i < tape->count; i++)
        leaves += csg_op_is_leaf(tape->nodes[i].op);
    self->interval_evaluations += CSG_OCTANTS;
    self->primitive_evaluations += leaves * CSG_OCTANTS;
    float radius = half * (1 + 4 * CSG_RAY_CELL_OVERLAP) * 1.7320510f; /* above the root of 3 */
    return csg_prune_octants(&self->pruner, tape, c[0], c[1], c[2], radius);
}

/* The children's wide tapes; those whose surroundings have no surface get half 0. */
static bool find_wide(build *b, worker *self, const csg_ray_cell *parent, csg_ray_cell *children,
                      csg_arena *arena)
{
    csg_tape tape = tape_of(b, parent->wide_nodes, parent->wide_count), shorter;
    float band = b->options->band, tau = b->reach * tape.lipschitz;
    if (!look(b, self, &tape, children, children[0].half + b->reach))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        if (csg_prune_state(&self->pruner, o) != CSG_CELL_SURFACE) {
            children[o].half = 0;
            continue;
        }
        if (!csg_prune_shorten(&self->pruner, o, tau > band ? tau : band, arena, &shorter))
            return false;
        children[o].wide_nodes = shorter.nodes;
        children[o].wide_count = shorter.count;
    }
    return true;
}

/* The children's near tapes, from a tape of the parent. A child without a surface is kept only for
 * its wide tape. */
static bool find_near(build *b, worker *self, const csg_tape *tape, csg_ray_cell *children,
                      csg_arena *arena)
{
    csg_tape shorter;
    float half = children[0].half;
    for (int o = 1; o < CSG_OCTANTS && half == 0; o++)
        half = children[o].half;
    if (half == 0)
        return true;
    if (!look(b, self, tape, children, half))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        csg_ray_cell *child = &children[o];
        child->has_surface =
            child->half > 0 && csg_prune_state(&self->pruner, o) == CSG_CELL_SURFACE;
        if (!child->has_surface && !child->wide_nodes)
            child->half = 0;
        if (!child->has_surface)
            continue;
        if (!csg_prune_shorten(&self->pruner, o, b->options->band, arena, &shorter))
            return false;
        child->near_nodes = shorter.nodes;
        child->near_count = shorter.count;
    }
    return true;
}

static bool is_split(const build *b, const csg_ray_cell *parent)
{
    if (b->level <= b->out->wide_level)
        return parent->wide_nodes != NULL;
    return parent->has_surface && parent->near_count > LONG_NEAR_TAPE;
}

static bool split(build *b, uint32_t worker_index, size_t index)
{
    worker *self = &b->workers[worker_index];
    const csg_ray_cell *parent = &b->out->cells[index];
    csg_ray_cell *children = b->children + (index - b->first) * CSG_OCTANTS;
    memset(children, 0, CSG_OCTANTS * sizeof *children);
    if (!is_split(b, parent))
        return true;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        children[o].half = parent->half / 2;
        children[o].wide = parent->wide;
        for (int axis = 0; axis < 3; axis++)
            children[o].center[axis] =
                parent->center[axis] + (o >> axis & 1 ? 0.5f : -0.5f) * parent->half;
    }
    csg_arena *arena = &b->out->arenas[worker_index];
    csg_tape near = tape_of(b, parent->near_nodes, parent->near_count);
    csg_tape wide = tape_of(b, parent->wide_nodes, parent->wide_count);
    if (b->level > b->out->wide_level)
        return find_near(b, self, &near, children, arena);
    return find_wide(b, self, parent, children, arena) &&
           (b->level < b->out->wide_level || find_near(b, self, &wide, children, arena));
}

static bool split_item(void *user, uint32_t worker_index, size_t item)
{
    build *b = user;
    if (b->options->cancelled && b->options->cancelled(b->options->user)) {
        atomic_store(&b->cancelled, true);
        return false;
    }
    size_t first = b->first + item * PARENTS_PER_ITEM;
    for (size_t i = first; i < first + PARENTS_PER_ITEM && i < b->end; i++)
        if (!split(b, worker_index, i)) {
            atomic_store(&b->out_of_memory, true);
            return false;
        }
    return true;
}

/* The children that there are, behind all other cells. */
static bool append_children(build *b)
{
    csg_ray_cells *out = b->out;
    size_t most = (b->end - b->first) * CSG_OCTANTS, total = out->count;
    for (size_t i = 0; i < most; i++)
        total += b->children[i].half > 0;
    if (total >= UINT32_MAX || !csg_memory_reserve(&out->context->memory, (void **)&out->cells,
                                                   &out->capacity, total, sizeof *out->cells))
        return false;
    for (size_t i = 0; i < most; i++) {
        if (!(b->children[i].half > 0))
            continue;
        csg_ray_cell *parent = &out->cells[b->first + i / CSG_OCTANTS];
        uint32_t index = (uint32_t)out->count++;
        parent->child[i % CSG_OCTANTS] = index;
        parent->is_leaf = false;
        out->cells[index] = b->children[i];
        out->cells[index].is_leaf = true;
        if (b->level == out->wide_level)
            out->cells[index].wide = index;
    }
    return true;
}

static bool make_level(build *b)
{
    CSG_ZONE(b->out->context, "cells of rays");
    csg_memory *memory = &b->out->context->memory;
    size_t parents = b->end - b->first, bytes = parents * CSG_OCTANTS * sizeof *b->children;
    b->children = csg_memory_alloc(memory, bytes);
    bool done = b->children != NULL;
    if (!done)
        atomic_store(&b->out_of_memory, true);
    if (done)
        done =
            csg_pool_run(b->out->context->pool, (parents + PARENTS_PER_ITEM - 1) / PARENTS_PER_ITEM,
                         split_item, NULL, b);
    if (done && !append_children(b)) {
        atomic_store(&b->out_of_memory, true);
        done = false;
    }
    csg_memory_release(memory, b->children, bytes);
    b->first = b->end;
    b->end = b->out->count;
    return done;
}

/* Whether wide tapes with half the reach, one level further down, are worth it. */
static bool wide_tapes_are_long(const build *b)
{
    uint64_t total = 0;
    for (size_t i = b->first; i < b->end; i++)
        total += b->out->cells[i].wide_count;
    return total > (b->end - b->first) * (uint64_t)LONG_WIDE_TAPE;
}

static bool make_levels(build *b)
{
    csg_ray_cells *out = b->out;
    out->wide_level = FIRST_WIDE_LEVEL;
    for (b->level = 1; b->level <= out->wide_level && b->first < b->end; b->level++) {
        if (!make_level(b))
            return false;
        if (b->level < out->wide_level || !b->options->wide || !wide_tapes_are_long(b) ||
            out->wide_level == LAST_WIDE_LEVEL)
            continue;
        for (size_t i = b->first; i < b->end; i++)
            out->cells[i].wide = 0;
        out->wide_level++;
        b->reach /= 2;
    }
    out->reach = b->reach;
    for (; b->level <= b->options->most_level && b->first < b->end; b->level++)
        if (!make_level(b))
            return false;
    return true;
}

/* A cell has a surface when one of its children has. */
static void gather_surfaces(csg_ray_cells *out)
{
    for (size_t i = out->count; i-- > 0;) {
        csg_ray_cell *cell = &out->cells[i];
        if (cell->is_leaf)
            continue;
        cell->has_surface = false;
        for (int o = 0; o < CSG_OCTANTS; o++)
            cell->has_surface |= cell->child[o] && out->cells[cell->child[o]].has_surface;
    }
}

static bool make_root(build *b, csg_box box)
{
    csg_ray_cells *out = b->out;
    if (!csg_memory_reserve(&out->context->memory, (void **)&out->cells, &out->capacity, 1,
                            sizeof *out->cells))
        return false;
    csg_vec3 center = csg_box_center(box);
    double half = csg_box_longest_side(box) / 2 * (1 + 1e-6) + 1e-30;
    double extent = fmax(fabs(center.x), fmax(fabs(center.y), fabs(center.z))) + 2 * half;
    out->rounding = (float)(32 * (double)FLT_EPSILON * extent); /* as grid/octree/octree.c */
    out->cells[0] = (csg_ray_cell){
        .center = {(float)center.x, (float)center.y, (float)center.z},
        .half = (float)half + 2 * out->rounding,
        .is_leaf = true,
        .wide_nodes = out->field->tape.nodes,
        .wide_count = out->field->tape.count,
    };
    out->count = 1;
    b->reach = b->options->wide ? (float)half / (1 << (FIRST_WIDE_LEVEL - 1)) : 0;
    b->end = 1;
    return true;
}

static bool create_workers(build *b)
{
    csg_ray_cells *out = b->out;
    csg_memory *memory = &out->context->memory;
    b->workers = csg_memory_alloc(memory, out->worker_count * sizeof *b->workers);
    out->arenas = csg_memory_alloc(memory, out->worker_count * sizeof *out->arenas);
    for (uint32_t i = 0; i < out->worker_count; i++) {
        if (out->arenas)
            csg_arena_init(&out->arenas[i], memory);
        if (b->workers) {
            b->workers[i] = (worker){.interval_evaluations = 0};
            csg_pruner_init(&b->workers[i].pruner, memory, b->kernel, out->rounding);
        }
    }
    return b->workers && out->arenas;
}

static void release_workers(build *b)
{
    csg_ray_cells *out = b->out;
    for (uint32_t i = 0; b->workers && i < out->worker_count; i++) {
        csg_pruner_release(&b->workers[i].pruner);
        out->interval_evaluations += b->workers[i].interval_evaluations;
        out->primitive_evaluations += b->workers[i].primitive_evaluations;
    }
    csg_memory_release(&out->context->memory, b->workers, out->worker_count * sizeof *b->workers);
}

csgm_status csg_ray_cells_create(csgm_context *context, const csgm_field *field, csg_box box,
                                 const csg_ray_cells_options *options, csg_ray_cells *out)
{
    *out = (csg_ray_cells){
        .context = context, .field = field, .worker_count = csg_pool_threads(context->pool)};
    build b = {.out = out, .options = options, .kernel = csg_kernel_for(context->isa)};
    bool ready = make_root(&b, box) && create_workers(&b);
    bool done = ready && make_levels(&b);
    release_workers(&b);
    if (done) {
        gather_surfaces(out);
        return CSGM_OK;
    }
    bool cancelled = ready && !atomic_load(&b.out_of_memory) && atomic_load(&b.cancelled);
    csg_ray_cells_release(out);
    return cancelled ? CSGM_CANCELLED : csg_context_no_memory(context);
}

void csg_ray_cells_release(csg_ray_cells *cells)
{
    csg_memory *memory = &cells->context->memory;
    for (uint32_t i = 0; cells->arenas && i < cells->worker_count; i++)
        csg_arena_reset(&cells->arenas[i]);
    csg_memory_release(memory, cells->arenas, cells->worker_count * sizeof *cells->arenas);
    csg_memory_release(memory, cells->cells, cells->capacity * sizeof *cells->cells);
    cells->cells = NULL;
    cells->arenas = NULL;
    cells->count = cells->capacity = 0;
}
