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

typedef struct worker {
    csg_marching_room *room;
    float *scratch;
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
    csg_marching marching;
    csgm_mesh *mesh;
    worker *workers;
    uint32_t worker_count;
    size_t scratch_floats;
    double started_s, deadline_s, last_report_s;
    csgm_stage stage;
    atomic_bool timed_out;
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
static csgm_status number_blocks(build *b, uint64_t *vertices, uint64_t *triangles)
{
    csg_pool_run(b->context->pool, item_count(b), count_item, NULL, b);
    *vertices = *triangles = 0;
    for (size_t i = 0; i < b->octree.block_count; i++) {
        csg_block *block = b->octree.blocks[i];
        block->first_vertex = (uint32_t)*vertices;
        block->first_triangle = *triangles;
        *vertices += block->vertex_count;
        *triangles += block->triangle_count;
    }
    if (*vertices <= UINT32_MAX)
        return CSGM_OK;
    csg_diag_plain(&b->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower the resolution",
                   "the mesh would have %llu vertices, more than 32-bit indices can number",
                   (unsigned long long)*vertices);
    return CSGM_ERR_LIMIT;
}

/* ---- vertices and triangles
 * ------------------------------------------------------------------------ */

static void make_block(build *b, worker *self, const csg_block *block)
{
    csgm_mesh *mesh = b->mesh;
    size_t v = block->first_vertex;
    csg_marching_output out = {
        .positions = mesh->positions + 3 * v,
        .normals = mesh->normals ? mesh->normals + 3 * v : NULL,
        .colors = mesh->colors ? mesh->colors + 4 * v : NULL,
        .indices = mesh->indices + 3 * block->first_triangle,
    };
    uint64_t points = csg_marching_vertices(&b->marching, block, self->room, &out, self->scratch,
                                            b->scratch_floats);
    csg_marching_triangles(&b->marching, block, self->room, &out);
    uint64_t gradients = out.normals ? block->vertex_count : 0;
    self->point_evaluations += points;
    self->gradient_evaluations += gradients;
    self->primitive_evaluations += (points + gradients) * (block->node_count + 1) / 2;
}

static bool make_item(void *user, uint32_t worker_index, size_t item)
{
    build *b = user;
    if (should_stop(b))
        return false;
    size_t end = (item + 1) * BLOCKS_PER_ITEM;
    for (size_t i = item * BLOCKS_PER_ITEM; i < end && i < b->octree.block_count; i++)
        make_block(b, &b->workers[worker_index], b->octree.blocks[i]);
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
        b->workers[i].room = csg_memory_alloc(memory, sizeof(csg_marching_room));
        b->workers[i].scratch = csg_memory_alloc(memory, b->scratch_floats * sizeof(float));
        if (!b->workers[i].room || !b->workers[i].scratch)
            return csg_context_no_memory(b->context);
    }
    return CSGM_OK;
}

static void release_workers(build *b)
{
    csg_memory *memory = &b->context->memory;
    for (uint32_t i = 0; b->workers && i < b->worker_count; i++) {
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
    b->mesh->origin = origin_of(b);
    b->marching = (csg_marching){
        .kernel = csg_kernel_for(b->context->isa),
        .field = b->field,
        .lattice = &b->lattice,
        .tables = &b->tables,
        .blocks = b->octree.blocks,
        .index = &b->index,
        .shift = csg_vec3_sub(b->field->center, b->mesh->origin),
        /* a few ulp of the coordinates, or a distance nobody sees in a cell */
        .tolerance = (float)fmax(2 * (double)FLT_EPSILON * extent, 0x1p-14 * b->lattice.cell_size),
    };
}

static csgm_status make_mesh(build *b)
{
    uint64_t vertices, triangles;
    csg_cell_tables_make(&b->tables);
    csgm_status status = number_blocks(b, &vertices, &triangles);
    if (status != CSGM_OK)
        return status;
    bool colors = b->options->colors && b->field->color_count > 1;
    status =
        csg_mesh_create(b->context, vertices, triangles, b->options->normals, colors, &b->mesh);
    if (status != CSGM_OK || !vertices)
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
    double near = 1e-3 * b->lattice.cell_size;
    csg_box inner = csg_box_grow(b->bounds, -near);
    const csgm_mesh *mesh = b->mesh;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->positions + 3 * i;
        double x = mesh->origin.x + (double)p[0], y = mesh->origin.y + (double)p[1],
               z = mesh->origin.z + (double)p[2];
        if (x <= inner.min.x || x >= inner.max.x || y <= inner.min.y || y >= inner.max.y ||
            z <= inner.min.z || z >= inner.max.z)
            return true;
    }
    return false;
}

static void warn(build *b)
{
    csg_diag_sink *diags = &b->context->diags;
    if (!b->mesh->triangle_count && !csg_box_is_empty(b->field->bounds))
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

csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats)
{
    build b = {.context = context, .options = options, .field = field};
    b.started_s = csg_clock_now_s();
    if (context->limits.timeout_s > 0)
        b.deadline_s = b.started_s + context->limits.timeout_s;
    csgm_status status = run(&b, stats);
    release_workers(&b);
    csg_block_index_release(&b.index);
    csg_octree_release(&b.octree);
    csg_field_destroy(b.clipped);
    if (status == CSGM_OK)
        *out = b.mesh;
    else
        csg_mesh_destroy(b.mesh);
    return status;
}
