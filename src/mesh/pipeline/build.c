/* SPDX-License-Identifier: MIT
 * The pipeline; see build.h. Every parallel stage writes results at places known from counts, so
 * the mesh does not depend on the number of threads.
 */
#include "mesh/pipeline/build.h"

#include <math.h>

#include "base/clock.h"
#include "mesh/pipeline/certify.h"
#include "mesh/reshape/tolerance.h"
#include "mesh/work.h"

/* ---- bounds and lattice ------------------------------------------------------------------------
 */

static csgm_status choose_bounds(csg_mesh_work *w)
{
    csg_diag_sink *diags = &w->context->diags;
    w->bounds = w->options->bounds;
    if (!csg_box_is_empty(w->bounds)) {
        if (csg_box_is_finite(w->bounds))
            return CSGM_OK;
        csg_diag_plain(diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL, "the bounds must be finite numbers");
        return CSGM_ERR_ARGUMENT;
    }
    w->bounds = w->field->bounds;
    if (csg_box_is_empty(w->bounds) || csg_box_is_finite(w->bounds))
        return CSGM_OK;
    csg_diag_plain(diags, CSG_DIAG_UNBOUNDED, NULL,
                   "give --bounds X0,Y0,Z0,X1,Y1,Z1, or intersect the solid with a cube",
                   "the solid reaches to infinity, so there is no box to mesh");
    return CSGM_ERR_SCENE;
}

static csgm_status check_cells(csg_mesh_work *w)
{
    const csgm_mesh_options *options = w->options;
    bool good = options->cell_size == 0 ? options->resolution > 0
                                        : options->cell_size > 0 && isfinite(options->cell_size);
    if (good)
        return CSGM_OK;
    csg_diag_plain(&w->context->diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL,
                   "the resolution or the cell size must be a positive number");
    return CSGM_ERR_ARGUMENT;
}

static csgm_status make_lattice(csg_mesh_work *w)
{
    const csgm_mesh_options *options = w->options;
    if (csg_lattice_make(w->bounds, w->field->center, options->cell_size, options->resolution,
                         &w->lattice))
        return CSGM_OK;
    csg_vec3 size = csg_box_size(w->bounds);
    if (!(size.x > 0 || size.y > 0 || size.z > 0)) {
        csg_diag_plain(&w->context->diags, CSG_DIAG_BAD_BOUNDS, NULL, "give a cell size with -s",
                       "the bounds are a single point, which sets no resolution");
        return CSGM_ERR_ARGUMENT;
    }
    csg_diag_plain(&w->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower -r, or raise -s",
                   "the lattice over %g x %g x %g would have more than %d cells along a side",
                   size.x, size.y, size.z, CSG_LATTICE_MOST_CELLS);
    return CSGM_ERR_LIMIT;
}

/* A solid that reaches out of the bounds is cut there: met with a box, so that it is capped. */
static csgm_status clip(csg_mesh_work *w)
{
    if (csg_box_contains_box(w->bounds, w->field->bounds))
        return CSGM_OK;
    csgm_status status = csg_field_clip(w->context, w->field, w->bounds, &w->clipped);
    if (status == CSGM_OK)
        w->field = w->clipped;
    return status;
}

static csgm_status walk_octree(csg_mesh_work *w)
{
    csg_octree_options options = {.prune = w->options->prune,
                                  .beads = w->options->features == CSGM_FEATURES_SHARP,
                                  .scan = !w->options->certify,
                                  .progress = csg_mesh_report_progress,
                                  .cancelled = csg_mesh_should_stop,
                                  .user = w};
    csgm_status status = csg_octree_create(w->context, w->field, &w->lattice, &options, &w->octree);
    return status == CSGM_CANCELLED ? csg_mesh_why_stopped(w) : status;
}

/* Nothing but the empty solid has no bounds: then there is no octree and the mesh is empty. */
static csgm_status prepare(csg_mesh_work *w)
{
    csgm_status status = choose_bounds(w);
    if (status != CSGM_OK || csg_box_is_empty(w->bounds))
        return status;
    status = check_cells(w);
    if (status == CSGM_OK)
        status = clip(w);
    if (status == CSGM_OK)
        status = make_lattice(w);
    if (status == CSGM_OK)
        status = walk_octree(w);
    return status;
}

/* ---- what is said about the result -------------------------------------------------------------
 */

/* Whether a vertex lies on one of the planes that cut the solid. */
static bool touches_bounds(const csg_mesh_work *w)
{
    csg_box box = csg_box_empty();
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++)
        box = csg_box_hull(box, w->workers[i].bounds);
    if (csg_box_is_empty(box))
        return false;
    box.min = csg_vec3_add(box.min, w->counts.origin);
    box.max = csg_vec3_add(box.max, w->counts.origin);
    return !csg_box_contains_box(csg_box_grow(w->bounds, -1e-3 * w->lattice.cell_size), box);
}

static void warn(csg_mesh_work *w)
{
    csg_diag_sink *diags = &w->context->diags;
    if (!w->counts.triangle_count && w->share)
        csg_diag_plain(diags, CSG_DIAG_NO_SURFACE, NULL,
                       "it may lie outside the bounds, or be thinner than a cell: try a higher -r",
                       w->share->name ? "no surface of the part \"%.60s\" was found"
                                      : "no surface was found of what is in no part%s",
                       w->share->name ? w->share->name : "");
    else if (!w->counts.triangle_count && (w->clipped || !csg_box_is_empty(w->field->bounds)))
        csg_diag_plain(diags, CSG_DIAG_NO_SURFACE, NULL,
                       "the solid may lie outside the bounds, or be thinner than a cell: try a "
                       "higher -r",
                       "no surface was found with cells of %g", w->lattice.cell_size);
    else if (w->clipped && touches_bounds(w))
        csg_diag_plain(diags, CSG_DIAG_CUT_BY_BOUNDS, NULL, NULL,
                       "the solid reaches out of the bounds: it is cut and capped there");
}

static void fill_stats(const csg_mesh_work *w, csgm_mesh_stats *stats)
{
    csg_octree_stats octree = {0};
    if (w->octree)
        octree = csg_octree_get_stats(w->octree);
    *stats = (csgm_mesh_stats){
        .octree_s = w->sampled_s - w->started_s,
        .mesh_s = csg_clock_now_s() - w->sampled_s,
        .cell_size = w->lattice.cell_size,
        .cells = {w->lattice.cells[0], w->lattice.cells[1], w->lattice.cells[2]},
        .cells_visited = octree.visited,
        .pruned_outside = octree.pruned_outside,
        .pruned_inside = octree.pruned_inside,
        .leaf_blocks = octree.sampled_blocks,
        .point_evaluations = octree.point_evaluations,
        .interval_evaluations = octree.interval_evaluations,
        .primitive_evaluations = octree.primitive_evaluations,
        .unresolved_cells = w->unresolved_cells,
        .certify = w->certify,
        .memory_peak_bytes = atomic_load(&w->context->memory.peak_bytes),
        .feature_vertices = w->features.count - w->features.bare,
        .smooth_features = w->features.smooth,
        .fading_features = w->features.fading,
    };
    if (octree.sampled_blocks)
        stats->mean_tape_length = (double)octree.tape_nodes_sampled / (double)octree.sampled_blocks;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        stats->point_evaluations += w->workers[i].point_evaluations;
        stats->gradient_evaluations += w->workers[i].gradient_evaluations;
        stats->primitive_evaluations += w->workers[i].primitive_evaluations;
    }
}

/* ---- the whole ---------------------------------------------------------------------------------
 */

static csgm_status make_mesh(csg_mesh_work *w)
{
    csg_cell_tables_make(&w->tables);
    csg_marching_places_make(&w->places, &w->tables);
    csgm_status status = w->octree ? csg_mesh_create_workers(w) : CSGM_OK;
    if (status == CSGM_OK && w->octree)
        status = csg_mesh_count_slabs(w);
    if (status == CSGM_OK)
        status = csg_mesh_link_features(w);
    w->sampled_s = csg_clock_now_s();
    if (status == CSGM_OK)
        status = csg_mesh_begin_output(w);
    if (status == CSGM_OK && w->counts.vertex_count)
        status = csg_mesh_each_slab(w, csg_mesh_make_blocks);
    return status;
}

static csgm_status run(csg_mesh_work *w, csgm_mesh_stats *stats)
{
    w->started_s = csg_clock_now_s();
    w->stage = CSGM_STAGE_OCTREE;
    w->stage_share = 1;
    if (w->context->limits.timeout_s > 0)
        w->deadline_s = (w->share  ? w->share->started_s
                         : w->goal ? w->goal->started_s
                                   : w->started_s) +
                        w->context->limits.timeout_s;
    csgm_status status = prepare(w);
    if (status == CSGM_OK)
        status = make_mesh(w);
    if (status == CSGM_OK && w->goal && w->counts.triangle_count)
        status = csg_mesh_reshape(w);
    if (status == CSGM_OK && !(w->goal && w->goal->cell_size > 0)) {
        status = csg_mesh_look_for_missed(w);
        if (status == CSGM_OK)
            warn(w);
    }
    if (status == CSGM_OK && stats)
        fill_stats(w, stats);
    csg_mesh_release_output(w);
    csg_feature_store_release(&w->features);
    csg_mesh_release_slabs(w);
    csg_octree_destroy(w->octree);
    csg_field_destroy(w->clipped);
    return status;
}

csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats)
{
    return field->part_count ? csg_mesh_build_parts(context, field, options, out, stats)
                             : csg_mesh_build_one(context, field, options, NULL, out, stats);
}

csgm_status csg_mesh_build_one(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, const csg_mesh_share *share,
                               csgm_mesh **out, csgm_mesh_stats *stats)
{
    return csg_mesh_is_reshaped(options)
               ? csg_mesh_build_reshaped(context, field, options, share, out, stats)
               : csg_mesh_build_with(context, field, options, share, NULL, out, stats);
}

csgm_status csg_mesh_build_with(csgm_context *context, const csgm_field *field,
                                const csgm_mesh_options *options, const csg_mesh_share *share,
                                csg_mesh_goal *goal, csgm_mesh **out, csgm_mesh_stats *stats)
{
    csg_mesh_work work = {
        .context = context, .options = options, .field = field, .share = share, .goal = goal};
    csgm_status status = run(&work, stats);
    if (status == CSGM_OK)
        *out = work.mesh;
    else
        csg_mesh_destroy(work.mesh);
    return status;
}

csgm_status csg_mesh_stream(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, const csg_mesh_receiver *receiver,
                            csg_mesh_counts *counts, csgm_mesh_stats *stats)
{
    csg_mesh_work work = {
        .context = context, .options = options, .field = field, .receiver = receiver};
    csgm_status status = run(&work, stats);
    if (counts)
        *counts = work.counts;
    return status;
}
