/* SPDX-License-Identifier: MIT
 * The pipeline; see build.h. Every parallel stage writes results at places known from counts, so
 * the mesh does not depend on the number of threads.
 */
#include "mesh/build.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/pool.h"
#include "field/dispatch.h"
#include "mesh/marching.h"

enum { BLOCKS_PER_ITEM = 32 };

/* A run on its way to a receiver. */
typedef struct run_buffer {
    float *positions, *normals;
    uint8_t *colors;
    uint32_t *indices;
    size_t position_capacity, normal_capacity, color_capacity, index_capacity;
} run_buffer;

typedef struct worker {
    csg_marching_room *room;
    float *scratch;
    run_buffer run;
    csg_box bounds; /* of the vertices made */
    uint64_t point_evaluations, gradient_evaluations, primitive_evaluations;
} worker;

typedef struct build {
    csgm_context *context;
    const csgm_mesh_options *options;
    const csgm_field *field;
    csgm_field *clipped; /* owned, NULL when the bounds cut nothing */
    csg_box bounds;
    csg_lattice lattice;
    csg_octree octree;
    csg_block_index index;
    csg_cell_tables tables;
    csg_marching_places places;
    csg_marching marching;
    csg_mesh_counts counts;
    csgm_mesh *mesh; /* NULL when a receiver takes it */
    const csg_mesh_receiver *receiver;
    worker *workers;
    uint32_t worker_count;
    size_t scratch_floats;
    double started_s, deadline_s, last_report_s;
    csgm_stage stage;
    atomic_bool timed_out, out_of_memory, refused;
} build;

/* ---- watching ----------------------------------------------------------------------------------
 */

static bool should_stop(void *user)
{
    build *b = user;
    const csgm_monitor *monitor = &b->options->monitor;
    if (monitor->cancelled && monitor->cancelled(monitor->user))
        return true;
    if (b->deadline_s > 0 && csg_clock_now_s() > b->deadline_s) {
        atomic_store(&b->timed_out, true);
        return true;
    }
    return false;
}

static void report_progress(void *user, double fraction)
{
    enum { REPORTS_PER_SECOND = 20 };
    build *b = user;
    const csgm_monitor *monitor = &b->options->monitor;
    if (!monitor->progress)
        return;
    double now = csg_clock_now_s();
    if (now - b->last_report_s < 1.0 / REPORTS_PER_SECOND)
        return;
    b->last_report_s = now;
    monitor->progress(monitor->user, b->stage, fraction);
}

static void poll(void *user, size_t done, size_t count)
{
    report_progress(user, (double)done / (double)count);
}

static csgm_status stopped(build *b)
{
    if (atomic_load(&b->out_of_memory))
        return csg_context_no_memory(b->context);
    if (atomic_load(&b->refused))
        return CSGM_ERR_IO;
    if (!atomic_load(&b->timed_out))
        return CSGM_CANCELLED;
    csg_diag_plain(&b->context->diags, CSG_DIAG_TIMEOUT, NULL,
                   "raise --timeout, or mesh at a lower resolution",
                   "meshing took longer than the limit of %g s", b->context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}

/* ---- bounds and lattice
 * --------------------------------------------------------------------------- */

static csgm_status choose_bounds(build *b)
{
    csg_diag_sink *diags = &b->context->diags;
    b->bounds = b->options->bounds;
    if (!csg_box_is_empty(b->bounds)) {
        if (csg_box_is_finite(b->bounds))
            return CSGM_OK;
        csg_diag_plain(diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL, "the bounds must be finite numbers");
        return CSGM_ERR_ARGUMENT;
    }
    b->bounds = b->field->bounds;
    if (csg_box_is_empty(b->bounds) || csg_box_is_finite(b->bounds))
        return CSGM_OK;
    csg_diag_plain(diags, CSG_DIAG_UNBOUNDED, NULL,
                   "give --bounds X0,Y0,Z0,X1,Y1,Z1, or intersect the solid with a cube",
                   "the solid reaches to infinity, so there is no box to mesh");
    return CSGM_ERR_SCENE;
}

static csgm_status make_lattice(build *b)
{
    const csgm_mesh_options *options = b->options;
    if (csg_lattice_make(b->bounds, b->field->center, options->cell_size, options->resolution,
                         &b->lattice))
        return CSGM_OK;
    csg_vec3 size = csg_box_size(b->bounds);
    csg_diag_plain(&b->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower -r, or raise -s",
                   "the lattice over %g x %g x %g would have more than %d cells along a side",
                   size.x, size.y, size.z, CSG_LATTICE_MOST_CELLS);
    return CSGM_ERR_LIMIT;
}

/* A solid that reaches out of the bounds is cut there: met with a box, so that it is capped. */
static csgm_status clip(build *b)
{
    if (csg_box_contains_box(b->bounds, b->field->bounds))
        return CSGM_OK;
    csgm_status status = csg_field_clip(b->context, b->field, b->bounds, &b->clipped);
    if (status == CSGM_OK)
        b->field = b->clipped;
    return status;
}

/* ---- counts -------------------------------------------------------------------------------------
 */

static bool count_item(void *user, uint32_t worker_index, size_t item)
{
    build *b = user;
    (void)worker_index;
    size_t end = (item + 1) * BLOCKS_PER_ITEM;
    for (size_t i = item * BLOCKS_PER_ITEM; i < end && i < b->octree.block_count; i++)
        b->octree.blocks[i]->triangle_count = csg_marching_count(b->octree.blocks[i], &b->tables);
    return true;
}

static size_t item_count(const build *b)
{
    return (b->octree.block_count + BLOCKS_PER_ITEM - 1) / BLOCKS_PER_ITEM;
}

/* Prefix sums over the blocks in Morton order give every vertex and triangle its number. */
static csgm_status number_blocks(build *b)
{
    csg_pool_run(b->context->pool, item_count(b), count_item, NULL, b);
    csg_mesh_counts *counts = &b->counts;
    for (size_t i = 0; i < b->octree.block_count; i++) {
        csg_block *block = b->octree.blocks[i];
        block->first_vertex = (uint32_t)counts->vertex_count;
        block->first_triangle = counts->triangle_count;
        counts->vertex_count += block->vertex_count;
        counts->triangle_count += block->triangle_count;
    }
    if (counts->vertex_count <= UINT32_MAX)
        return CSGM_OK;
    csg_diag_plain(&b->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower the resolution",
                   "the mesh would have %llu vertices, more than 32-bit indices can number",
                   (unsigned long long)counts->vertex_count);
    return CSGM_ERR_LIMIT;
}

/* ---- vertices and triangles
 * ------------------------------------------------------------------------ */

static csg_box box_of(const float *positions, uint64_t count, csg_box box)
{
    for (uint64_t i = 0; i < count; i++, positions += 3) {
        csg_vec3 p = {(double)positions[0], (double)positions[1], (double)positions[2]};
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

static void make_block(build *b, worker *self, const csg_block *block,
                       const csg_marching_output *out)
{
    uint64_t points = csg_marching_vertices(&b->marching, block, self->room, out, self->scratch,
                                            b->scratch_floats);
    csg_marching_triangles(&b->marching, block, self->room, out);
    if (b->clipped)
        self->bounds = box_of(out->positions, block->vertex_count, self->bounds);
    uint64_t gradients = out->normals ? block->vertex_count : 0;
    self->point_evaluations += points;
    self->gradient_evaluations += gradients;
    self->primitive_evaluations += (points + gradients) * (block->node_count + 1) / 2;
}

/* Makes blocks [first, end); arrays of `out` begin with the first block's. */
static void make_blocks(build *b, worker *self, size_t first, size_t end,
                        const csg_marching_output *out)
{
    const csg_block *start = b->octree.blocks[first];
    for (size_t i = first; i < end; i++) {
        const csg_block *block = b->octree.blocks[i];
        size_t v = block->first_vertex - start->first_vertex;
        size_t t = (size_t)(block->first_triangle - start->first_triangle);
        csg_marching_output place = {
            .positions = out->positions + 3 * v,
            .normals = out->normals ? out->normals + 3 * v : NULL,
            .colors = out->colors ? out->colors + 4 * v : NULL,
            .indices = out->indices + 3 * t,
        };
        make_block(b, self, block, &place);
    }
}

static bool reserve_run(build *b, run_buffer *run, size_t vertices, size_t triangles)
{
    csg_memory *memory = &b->context->memory;
    return csg_memory_reserve(memory, (void **)&run->positions, &run->position_capacity,
                              3 * vertices, sizeof(float)) &&
           (!b->counts.normals ||
            csg_memory_reserve(memory, (void **)&run->normals, &run->normal_capacity, 3 * vertices,
                               sizeof(float))) &&
           (!b->counts.colors || csg_memory_reserve(memory, (void **)&run->colors,
                                                    &run->color_capacity, 4 * vertices, 1)) &&
           csg_memory_reserve(memory, (void **)&run->indices, &run->index_capacity, 3 * triangles,
                              sizeof(uint32_t));
}

static void release_run(csg_memory *memory, run_buffer *run)
{
    csg_memory_release(memory, run->positions, run->position_capacity * sizeof(float));
    csg_memory_release(memory, run->normals, run->normal_capacity * sizeof(float));
    csg_memory_release(memory, run->colors, run->color_capacity);
    csg_memory_release(memory, run->indices, run->index_capacity * sizeof(uint32_t));
}

/* One item for a receiver: made in the worker's buffer, then handed on. */
static bool hand_on(build *b, uint32_t worker_index, size_t first, size_t end)
{
    worker *self = &b->workers[worker_index];
    const csg_block *start = b->octree.blocks[first], *last = b->octree.blocks[end - 1];
    csg_mesh_run run = {
        .worker = worker_index,
        .first_vertex = start->first_vertex,
        .vertex_count = (uint64_t)last->first_vertex + last->vertex_count - start->first_vertex,
        .first_triangle = start->first_triangle,
        .triangle_count = last->first_triangle + last->triangle_count - start->first_triangle,
    };
    run_buffer *buffer = &self->run;
    if (!reserve_run(b, buffer, (size_t)run.vertex_count, (size_t)run.triangle_count)) {
        atomic_store(&b->out_of_memory, true);
        return false;
    }
    csg_marching_output out = {buffer->positions, buffer->normals, buffer->colors, buffer->indices};
    make_blocks(b, self, first, end, &out);
    run.positions = buffer->positions;
    run.normals = buffer->normals;
    run.colors = buffer->colors;
    run.indices = buffer->indices;
    if (b->receiver->put(b->receiver->user, &run))
        return true;
    atomic_store(&b->refused, true);
    return false;
}

static void keep_in_mesh(build *b, uint32_t worker_index, size_t first, size_t end)
{
    const csg_block *start = b->octree.blocks[first];
    csgm_mesh *mesh = b->mesh;
    size_t v = start->first_vertex;
    csg_marching_output out = {
        .positions = mesh->positions + 3 * v,
        .normals = mesh->normals ? mesh->normals + 3 * v : NULL,
        .colors = mesh->colors ? mesh->colors + 4 * v : NULL,
        .indices = mesh->indices + 3 * start->first_triangle,
    };
    make_blocks(b, &b->workers[worker_index], first, end, &out);
}

static bool make_item(void *user, uint32_t worker_index, size_t item)
{
    build *b = user;
    if (should_stop(b))
        return false;
    size_t first = item * BLOCKS_PER_ITEM, end = first + BLOCKS_PER_ITEM;
    end = end < b->octree.block_count ? end : b->octree.block_count;
    if (b->receiver)
        return hand_on(b, worker_index, first, end);
    keep_in_mesh(b, worker_index, first, end);
    return true;
}

static csgm_status create_workers(build *b)
{
    csg_memory *memory = &b->context->memory;
    b->worker_count = csg_pool_threads(b->context->pool);
    b->scratch_floats = csg_kernel_scratch_floats(b->field->depth);
    b->workers = csg_memory_alloc(memory, b->worker_count * sizeof(worker));
    if (!b->workers)
        return csg_context_no_memory(b->context);
    memset(b->workers, 0, b->worker_count * sizeof(worker));
    for (uint32_t i = 0; i < b->worker_count; i++) {
        b->workers[i].bounds = csg_box_empty();
        b->workers[i].room = csg_memory_alloc(memory, sizeof(csg_marching_room));
        b->workers[i].scratch = csg_memory_alloc(memory, b->scratch_floats * sizeof(float));
        if (!b->workers[i].room || !b->workers[i].scratch)
            return csg_context_no_memory(b->context);
        memset(b->workers[i].room, 0, sizeof(csg_marching_room));
    }
    return CSGM_OK;
}

static void release_workers(build *b)
{
    csg_memory *memory = &b->context->memory;
    for (uint32_t i = 0; b->workers && i < b->worker_count; i++) {
        release_run(memory, &b->workers[i].run);
        csg_memory_release(memory, b->workers[i].room, sizeof(csg_marching_room));
        csg_memory_release(memory, b->workers[i].scratch, b->scratch_floats * sizeof(float));
    }
    csg_memory_release(memory, b->workers, b->worker_count * sizeof(worker));
}

/* Far from the scene's origin floats are coarse: there the mesh keeps its own. */
static csg_vec3 origin_of(const build *b)
{
    enum { FAR = 1024 };
    csg_vec3 center = b->field->center, size = csg_box_size(b->bounds);
    double extent = fmax(size.x, fmax(size.y, size.z));
    return csg_vec3_norm(center) > FAR * extent ? center : csg_vec3_make(0, 0, 0);
}

static void prepare_marching(build *b)
{
    double extent = csg_lattice_extent(&b->lattice);
    b->marching = (csg_marching){
        .kernel = csg_kernel_for(b->context->isa),
        .field = b->field,
        .lattice = &b->lattice,
        .tables = &b->tables,
        .places = &b->places,
        .blocks = b->octree.blocks,
        .index = &b->index,
        .shift = csg_vec3_sub(b->field->center, b->counts.origin),
        /* a few ulp of the coordinates, or a distance nobody sees in a cell */
        .tolerance = (float)fmax(2 * (double)FLT_EPSILON * extent, 0x1p-14 * b->lattice.cell_size),
    };
}

/* Where the mesh goes: arrays of its own, or a receiver. */
static csgm_status begin_output(build *b)
{
    csg_mesh_counts *counts = &b->counts;
    counts->normals = b->options->normals;
    counts->colors = b->options->colors && b->field->color_count > 1;
    counts->origin = origin_of(b);
    if (b->receiver)
        return b->receiver->begin(b->receiver->user, counts);
    csgm_status status = csg_mesh_create(b->context, counts->vertex_count, counts->triangle_count,
                                         counts->normals, counts->colors, &b->mesh);
    if (status == CSGM_OK)
        b->mesh->origin = counts->origin;
    return status;
}

static csgm_status make_mesh(build *b)
{
    csg_cell_tables_make(&b->tables);
    csg_marching_places_make(&b->places, &b->tables);
    csgm_status status = number_blocks(b);
    if (status == CSGM_OK)
        status = begin_output(b);
    if (status != CSGM_OK || !b->counts.vertex_count)
        return status;
    status = create_workers(b);
    if (status != CSGM_OK)
        return status;
    if (!csg_block_index_make(&b->index, &b->context->memory, b->octree.blocks,
                              b->octree.block_count))
        return csg_context_no_memory(b->context);
    prepare_marching(b);
    b->stage = CSGM_STAGE_MESH;
    return csg_pool_run(b->context->pool, item_count(b), make_item, poll, b) ? CSGM_OK : stopped(b);
}

static csgm_status walk_octree(build *b)
{
    csg_octree_options options = {.prune = b->options->prune,
                                  .progress = report_progress,
                                  .cancelled = should_stop,
                                  .user = b};
    b->stage = CSGM_STAGE_OCTREE;
    csgm_status status = csg_octree_walk(b->context, b->field, &b->lattice, &options, &b->octree);
    return status == CSGM_CANCELLED ? stopped(b) : status;
}

/* ---- what is said about the result
 * -------------------------------------------------------------------- */

/* Whether a vertex lies on one of the planes that cut the solid. */
static bool touches_bounds(const build *b)
{
    csg_box box = csg_box_empty();
    for (uint32_t i = 0; b->workers && i < b->worker_count; i++)
        box = csg_box_hull(box, b->workers[i].bounds);
    if (csg_box_is_empty(box))
        return false;
    box.min = csg_vec3_add(box.min, b->counts.origin);
    box.max = csg_vec3_add(box.max, b->counts.origin);
    return !csg_box_contains_box(csg_box_grow(b->bounds, -1e-3 * b->lattice.cell_size), box);
}

static void warn(build *b)
{
    csg_diag_sink *diags = &b->context->diags;
    if (!b->counts.triangle_count && (b->clipped || !csg_box_is_empty(b->field->bounds)))
        csg_diag_plain(diags, CSG_DIAG_NO_SURFACE, NULL,
                       "the solid may lie outside the bounds, or be thinner than a cell: try a "
                       "higher -r",
                       "no surface was found with cells of %g", b->lattice.cell_size);
    else if (b->clipped && touches_bounds(b))
        csg_diag_plain(diags, CSG_DIAG_CUT_BY_BOUNDS, NULL, NULL,
                       "the solid reaches out of the bounds: it is cut and capped there");
}

static void fill_stats(const build *b, double octree_done_s, csgm_mesh_stats *stats)
{
    const csg_octree_stats *octree = &b->octree.stats;
    *stats = (csgm_mesh_stats){
        .octree_s = octree_done_s - b->started_s,
        .mesh_s = csg_clock_now_s() - octree_done_s,
        .cell_size = b->lattice.cell_size,
        .cells = {b->lattice.cells[0], b->lattice.cells[1], b->lattice.cells[2]},
        .cells_visited = octree->visited,
        .pruned_outside = octree->pruned_outside,
        .pruned_inside = octree->pruned_inside,
        .leaf_blocks = octree->sampled_blocks,
        .point_evaluations = octree->point_evaluations,
        .interval_evaluations = octree->interval_evaluations,
        .primitive_evaluations = octree->primitive_evaluations,
        .memory_peak_bytes = atomic_load(&b->context->memory.peak_bytes),
    };
    if (octree->sampled_blocks)
        stats->mean_tape_length =
            (double)octree->tape_nodes_sampled / (double)octree->sampled_blocks;
    for (uint32_t i = 0; b->workers && i < b->worker_count; i++) {
        stats->point_evaluations += b->workers[i].point_evaluations;
        stats->gradient_evaluations += b->workers[i].gradient_evaluations;
        stats->primitive_evaluations += b->workers[i].primitive_evaluations;
    }
}

static csgm_status run(build *b, csgm_mesh_stats *stats)
{
    csgm_status status = choose_bounds(b);
    if (status != CSGM_OK)
        return status;
    bool has_lattice = !csg_box_is_empty(b->bounds);
    if (has_lattice)
        status = make_lattice(b);
    if (status == CSGM_OK && has_lattice)
        status = clip(b);
    if (status == CSGM_OK && has_lattice)
        status = walk_octree(b);
    double octree_done_s = csg_clock_now_s();
    if (status == CSGM_OK)
        status = make_mesh(b);
    if (status == CSGM_OK)
        warn(b);
    if (status == CSGM_OK && stats)
        fill_stats(b, octree_done_s, stats);
    return status;
}

static build begin_build(csgm_context *context, const csgm_field *field,
                         const csgm_mesh_options *options)
{
    build b = {.context = context, .options = options, .field = field};
    b.started_s = csg_clock_now_s();
    if (context->limits.timeout_s > 0)
        b.deadline_s = b.started_s + context->limits.timeout_s;
    return b;
}

static void end_build(build *b)
{
    release_workers(b);
    csg_block_index_release(&b->index);
    csg_octree_release(&b->octree);
    csg_field_destroy(b->clipped);
}

csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats)
{
    build b = begin_build(context, field, options);
    csgm_status status = run(&b, stats);
    end_build(&b);
    if (status == CSGM_OK)
        *out = b.mesh;
    else
        csg_mesh_destroy(b.mesh);
    return status;
}

csgm_status csg_mesh_stream(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, const csg_mesh_receiver *receiver,
                            csg_mesh_counts *counts, csgm_mesh_stats *stats)
{
    build b = begin_build(context, field, options);
    b.receiver = receiver;
    csgm_status status = run(&b, stats);
    end_build(&b);
    if (counts)
        *counts = b.counts;
    return status;
}
