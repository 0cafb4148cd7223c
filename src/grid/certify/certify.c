/* SPDX-License-Identifier: MIT
 * The walk of certify.h: an octree whose tapes hold around their cubes too, its frontier in
 * parallel, findings joined in Morton order and neighbours among them made one place.
 */
#include "grid/certify/certify.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "field/cones/near_slopes.h"
#include "field/kernels/dispatch.h"
#include "field/unit_slopes.h"
#include "grid/certify/certify_block.h"

/* What one frontier cube gave, and where it is. */
typedef struct segment {
    uint32_t worker;
    size_t first, count;
} segment;

typedef struct walk {
    csgm_context *context;
    csgm_field field; /* whose signs are those of the field that was given */
    csg_arena arena;  /* what is its own of that */
    const csg_lattice *lattice;
    const csg_certify_options *options;
    csg_octree *octree;
    csg_certify_worker *workers;
    uint32_t worker_count;
    segment *segments;
    size_t cube_count;
    atomic_bool out_of_memory, cancelled;
} walk;

/* ---- one frontier cube ----------------------------------------------------------------------- */

static bool is_in_lattice(const csg_lattice *lattice, const uint32_t at[3])
{
    return at[0] < lattice->blocks[0] && at[1] < lattice->blocks[1] && at[2] < lattice->blocks[2];
}

/* The eight blocks, each with the tape that holds CSG_CERTIFY_MARGIN cells around it. */
static bool look_at_blocks(walk *w, csg_certify_worker *self, const uint32_t cube[3],
                           const csg_tape *tape)
{
    double h = w->lattice->cell_size;
    float c[3][CSG_OCTANTS], reach = (float)((CSG_BLOCK_EDGE / 2 + CSG_CERTIFY_MARGIN) * h *
                                             (sqrt(3.0) * (1 + 4 * (double)FLT_EPSILON)));
    uint32_t at[CSG_OCTANTS][3];
    csg_cell_state states[CSG_OCTANTS];
    for (uint32_t o = 0; o < CSG_OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++) {
            at[o][axis] = 2 * cube[axis] + (o >> axis & 1);
            c[axis][o] = csg_lattice_coordinate(w->lattice, axis,
                                                at[o][axis] * CSG_BLOCK_EDGE + CSG_BLOCK_EDGE / 2);
        }
    csg_tape tapes[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(&self->tapes);
    float band = (float)(2 * self->reach.lipschitz * h);
    bool done = csg_prune_octants(&self->wide, tape, c[0], c[1], c[2], reach);
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        states[o] = csg_prune_state(&self->wide, o);
        if (states[o] == CSG_CELL_SURFACE)
            done = csg_prune_shorten(&self->wide, o, band, &self->tapes, &tapes[o]);
    }
    for (int o = 0; o < CSG_OCTANTS && done; o++)
        if (states[o] == CSG_CELL_SURFACE && is_in_lattice(w->lattice, at[o]))
            done = csg_certify_block(self, at[o], &tapes[o]);
    csg_arena_release_to(&self->tapes, mark);
    return done;
}

static bool look_at_cube(void *user, uint32_t worker_index, size_t item)
{
    walk *w = user;
    csg_certify_worker *self = &w->workers[worker_index];
    if (w->options->cancelled && w->options->cancelled(w->options->user)) {
        atomic_store(&w->cancelled, true);
        return false;
    }
    uint32_t at[3];
    csg_tape tape = csg_octree_frontier_tape(w->octree, item, at);
    segment *s = &w->segments[item];
    *s = (segment){.worker = worker_index, .first = self->finding_count};
    if (!look_at_blocks(w, self, at, &tape)) {
        atomic_store(self->is_stopped ? &w->cancelled : &w->out_of_memory, true);
        return false;
    }
    s->count = self->finding_count - s->first;
    return true;
}

static void report_progress(void *user, size_t done, size_t count)
{
    walk *w = user;
    if (w->options->progress)
        w->options->progress(w->options->user, (double)done / (double)count);
}

/* ---- places ---------------------------------------------------------------------------------- */

static csg_box box_of_cell(const walk *w, const uint32_t cell[3])
{
    double h = w->lattice->cell_size;
    csg_vec3 min = {w->field.center.x + w->lattice->origin.x + cell[0] * h,
                    w->field.center.y + w->lattice->origin.y + cell[1] * h,
                    w->field.center.z + w->lattice->origin.z + cell[2] * h};
    return (csg_box){min, csg_vec3_add(min, csg_vec3_make(h, h, h))};
}

/* The thickest point stands for a missed part: it is what has to be seen; of what is not resolved
 * the first. */
static void add_to_place(const walk *w, csg_certify_place *place, const csg_certify_finding *f)
{
    place->cells++;
    place->box = csg_box_hull(place->box, box_of_cell(w, f->cell));
    if (place->cells > 1 && !(f->thickness > place->thickness))
        return;
    place->thickness = f->thickness;
    place->is_gap = f->is_gap;
    place->at = csg_vec3_add(w->field.center, csg_vec3_make(f->at[0], f->at[1], f->at[2]));
}

/* Places whose boxes have come to touch are one. */
static void merge_places(const walk *w, csg_certify_report *report, uint32_t grown)
{
    csg_certify_place *to = &report->places[grown];
    csg_box near = csg_box_grow(to->box, 2 * w->lattice->cell_size);
    for (uint32_t i = 0; i < report->place_count; i++) {
        const csg_certify_place from = report->places[i];
        if (i == grown || from.kind != to->kind ||
            csg_box_is_empty(csg_box_intersect(near, from.box)))
            continue;
        if (from.thickness > to->thickness) {
            to->thickness = from.thickness;
            to->is_gap = from.is_gap;
            to->at = from.at;
        }
        to->box = csg_box_hull(to->box, from.box);
        to->cells += from.cells;
        if (i < grown) { /* it keeps the earlier one's number */
            report->places[i] = *to;
            report->places[grown] = from;
            to = &report->places[i];
            uint32_t swap = grown;
            grown = i;
            i = swap;
        }
        report->place_count--;
        memmove(&report->places[i], &report->places[i + 1],
                (report->place_count - i) * sizeof from);
        i = UINT32_MAX; /* from the first again: the box has grown */
        near = csg_box_grow(to->box, 2 * w->lattice->cell_size);
    }
}

/* Into the place of this kind whose box is within two cells, else into a new one. */
static void add_finding(const walk *w, csg_certify_report *report, const csg_certify_finding *f)
{
    csg_box near = csg_box_grow(box_of_cell(w, f->cell), 2 * w->lattice->cell_size);
    for (uint32_t i = 0; i < report->place_count; i++) {
        csg_certify_place *place = &report->places[i];
        csg_box both = csg_box_intersect(near, place->box);
        if (place->kind == (csg_cell_kind)f->kind && !csg_box_is_empty(both)) {
            add_to_place(w, place, f);
            merge_places(w, report, i);
            return;
        }
    }
    if (report->place_count == CSG_CERTIFY_PLACES) {
        report->place_more++;
        return;
    }
    csg_certify_place *place = &report->places[report->place_count++];
    *place = (csg_certify_place){.kind = (csg_cell_kind)f->kind, .box = csg_box_empty()};
    add_to_place(w, place, f);
}

/* What is missed is listed before what is not resolved. */
static void fill_report(const walk *w, csg_certify_report *report)
{
    bool reached_size = false;
    for (uint32_t i = 0; i < w->worker_count; i++) {
        const csg_certify_worker *self = &w->workers[i];
        for (int kind = CSG_CELL_CERTIFIED; kind < CSG_CELL_KINDS; kind++)
            report->cells[kind] += self->cells[kind];
        report->cubes += self->cubes;
        reached_size |= self->reached_size;
    }
    report->promise = reached_size ? sqrt(3.0) * w->options->size : 0;
    for (int kind = CSG_CELL_MISSED; kind >= CSG_CELL_UNRESOLVED; kind--)
        for (size_t i = 0; i < w->cube_count; i++)
            for (size_t k = 0; k < w->segments[i].count; k++) {
                const segment *s = &w->segments[i];
                const csg_certify_finding *f = &w->workers[s->worker].findings[s->first + k];
                if (f->kind == kind)
                    add_finding(w, report, f);
            }
}

/* ---- the whole ------------------------------------------------------------------------------- */

/* So many visits of cubes as take about half a minute of one core are shared out among the blocks,
 * about five to a cube of the frontier. */
static uint32_t block_budget(size_t cubes)
{
    const size_t all = 30000000, least = 2000, most = 900000;
    size_t share = all / (5 * (cubes + 1));
    return (uint32_t)(share < least ? least : share > most ? most : share);
}

static bool has_formulas(const csg_tape *tape)
{
    bool any = false;
    for (uint32_t i = 0; i < tape->count && !any; i++)
        any = tape->nodes[i].op == CSG_OP_FIELD;
    return any;
}

static bool create_worker(const walk *w, csg_certify_worker *self)
{
    csg_memory *memory = &w->context->memory;
    const csg_kernel *kernel = csg_kernel_for(w->context->isa);
    float rounding = csg_octree_rounding(w->lattice);
    *self = (csg_certify_worker){.context = w->context,
                                 .lattice = w->lattice,
                                 .size = w->options->size,
                                 .cancelled = w->options->cancelled,
                                 .user = w->options->user,
                                 .has_formulas = has_formulas(&w->field.tape),
                                 .most_block_visits = block_budget(w->cube_count)};
    csg_pruner_init(&self->plain, memory, kernel, rounding);
    csg_pruner_init(&self->wide, memory, kernel, rounding);
    csg_pruner_init(&self->cones, memory, kernel, rounding);
    csg_arena_init(&self->tapes, memory);
    self->samples = csg_memory_alloc(memory, sizeof *self->samples);
    self->reach = (csg_reach){.kernel = kernel,
                              .lattice = w->lattice,
                              .lipschitz = (double)w->field.tape.lipschitz,
                              .scratch_floats = csg_kernel_scratch_floats(w->field.depth)};
    self->reach.noise = 4 * self->reach.lipschitz * (double)rounding;
    self->reach.band = 2 * self->reach.lipschitz * w->lattice->cell_size;
    self->reach.scratch = csg_memory_alloc(memory, self->reach.scratch_floats * sizeof(float));
    bool is_divided = csg_tape_has_near_slopes(&w->field.tape);
    size_t bytes = w->field.parameter_count * sizeof *self->near;
    self->near = is_divided ? csg_memory_alloc(memory, bytes) : NULL;
    if (self->near)
        memcpy(self->near, w->field.tape.parameters, bytes);
    return self->samples && self->reach.scratch && (self->near || !is_divided);
}

static bool create(walk *w)
{
    csg_memory *memory = &w->context->memory;
    w->cube_count = csg_octree_frontier_count(w->octree);
    w->segments = csg_memory_alloc(memory, (w->cube_count + 1) * sizeof *w->segments);
    w->workers = csg_memory_alloc(memory, w->worker_count * sizeof *w->workers);
    bool done = w->segments && w->workers;
    if (w->workers)
        memset(w->workers, 0, w->worker_count * sizeof *w->workers);
    for (uint32_t i = 0; i < w->worker_count && done; i++)
        done = create_worker(w, &w->workers[i]);
    return done;
}

static void release(walk *w)
{
    csg_memory *memory = &w->context->memory;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        csg_certify_worker *self = &w->workers[i];
        if (!self->context)
            continue;
        csg_pruner_release(&self->plain);
        csg_pruner_release(&self->wide);
        csg_pruner_release(&self->cones);
        csg_arena_reset(&self->tapes);
        csg_memory_release(memory, self->samples, sizeof *self->samples);
        csg_memory_release(memory, self->reach.scratch, self->reach.scratch_floats * sizeof(float));
        csg_memory_release(memory, self->near, w->field.parameter_count * sizeof *self->near);
        csg_memory_release(memory, self->stack, self->stack_capacity * sizeof *self->stack);
        csg_memory_release(memory, self->findings, self->finding_capacity * sizeof *self->findings);
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof *w->workers);
    csg_memory_release(memory, w->segments, (w->cube_count + 1) * sizeof *w->segments);
    csg_octree_destroy(w->octree);
    csg_arena_reset(&w->arena);
}

csgm_status csg_certify_run(csgm_context *context, const csgm_field *field,
                            const csg_lattice *lattice, const csg_certify_options *options,
                            csg_certify_report *report)
{
    CSG_ZONE(context, "certify");
    walk w = {.context = context,
              .lattice = lattice,
              .options = options,
              .worker_count = csg_pool_threads(context->pool)};
    csg_octree_options octree_options = {.prune = true,
                                         .margin = CSG_CERTIFY_MARGIN * lattice->cell_size,
                                         .cancelled = options->cancelled,
                                         .user = options->user};
    *report = (csg_certify_report){0};
    csg_arena_init(&w.arena, &context->memory);
    csgm_status status =
        csg_field_with_unit_slopes(field, &w.arena, &w.field)
            ? csg_octree_create(context, &w.field, lattice, &octree_options, &w.octree)
            : csg_context_no_memory(context);
    if (status != CSGM_OK) {
        release(&w);
        return status;
    }
    if (!create(&w))
        atomic_store(&w.out_of_memory, true);
    else if (csg_pool_run(context->pool, w.cube_count, look_at_cube, report_progress, &w))
        fill_report(&w, report);
    if (atomic_load(&w.out_of_memory))
        status = csg_context_no_memory(context);
    else if (atomic_load(&w.cancelled))
        status = CSGM_CANCELLED;
    release(&w);
    return status;
}
