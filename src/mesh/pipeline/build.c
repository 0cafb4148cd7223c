/* SPDX-License-Identifier: MIT
 * The stages of a mesh in their order; see build.h. Each stage takes what it uses, by the pointers
 * that it is given here. Every parallel stage writes results at places known from counts, so the
 * mesh does not depend on the number of threads.
 */
#include "mesh/pipeline/build.h"

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/ranks.h"
#include "base/trace.h"
#include "mesh/pipeline/certify.h"
#include "mesh/pipeline/output.h"
#include "mesh/pipeline/ranks.h"
#include "mesh/pipeline/survey.h"

typedef struct build {
    csg_mesh_input input;
    csg_mesh_watch watch;
    csg_mesh_workers workers;
    csg_mesh_creases creases;
    csg_mesh_slabs slabs;
    csg_mesh_output output;
    csg_mesh_doubts doubts;
    csg_mesh_goal *goal; /* NULL = the mesh stays as marching cubes make it */
    double sampled_s;
} build;

/* ---- what is said about the result -------------------------------------------------------------
 */

/* Whether a vertex lies on one of the planes that cut the solid. */
static bool touches_bounds(const build *b)
{
    csg_box box = csg_box_empty();
    for (uint32_t i = 0; b->workers.each && i < b->workers.count; i++)
        box = csg_box_hull(box, b->workers.each[i].bounds);
    if (csg_box_is_empty(box))
        return false;
    box.min = csg_vec3_add(box.min, b->output.counts.origin);
    box.max = csg_vec3_add(box.max, b->output.counts.origin);
    return !csg_box_contains_box(csg_box_grow(b->input.bounds, -1e-3 * b->input.lattice.cell_size),
                                 box);
}

static void warn_of_result(const build *b)
{
    const csg_mesh_fineness cells = {
        "cells",
        b->input.lattice.cell_size,
        {"the solid may lie outside the bounds, or be thinner than a cell: try a higher -r",
         "it may lie outside the bounds, or be thinner than a cell: try a higher -r"}};
    bool is_empty = !b->output.counts.triangle_count;
    csg_mesh_warn_of_result(&b->input, &cells, is_empty,
                            !is_empty && b->input.clipped && touches_bounds(b));
}

static void fill_stats(const build *b, csgm_mesh_stats *stats)
{
    csg_octree_stats octree = {0};
    if (b->slabs.octree)
        octree = csg_octree_get_stats(b->slabs.octree);
    *stats = (csgm_mesh_stats){
        .octree_s = b->sampled_s - b->watch.started_s,
        .mesh_s = csg_clock_now_s() - b->sampled_s,
        .cell_size = b->input.lattice.cell_size,
        .cells = {b->input.lattice.cells[0], b->input.lattice.cells[1], b->input.lattice.cells[2]},
        .cells_visited = octree.visited,
        .pruned_outside = octree.pruned_outside,
        .pruned_inside = octree.pruned_inside,
        .leaf_blocks = octree.sampled_blocks,
        .point_evaluations = octree.point_evaluations,
        .interval_evaluations = octree.interval_evaluations,
        .primitive_evaluations = octree.primitive_evaluations,
        .unresolved_cells = b->doubts.unresolved_cells,
        .certify = b->doubts.certify,
        .memory_peak_bytes = atomic_load(&b->input.context->memory.peak_bytes),
        .feature_vertices = b->creases.store.count - b->creases.store.bare,
        .smooth_features = b->creases.store.smooth,
        .fading_features = b->creases.store.fading,
    };
    if (octree.sampled_blocks)
        stats->mean_tape_length = (double)octree.tape_nodes_sampled / (double)octree.sampled_blocks;
    for (uint32_t i = 0; b->workers.each && i < b->workers.count; i++) {
        stats->point_evaluations += b->workers.each[i].point_evaluations;
        stats->gradient_evaluations += b->workers.each[i].gradient_evaluations;
        stats->primitive_evaluations += b->workers.each[i].primitive_evaluations;
    }
}

/* ---- the stages --------------------------------------------------------------------------------
 */

static void connect_stages(build *b, csgm_context *context, const csgm_mesh_options *options)
{
    csg_mesh_input_watch(&b->input, b->goal ? b->goal->started_s : 0, &b->watch);
    b->creases = (csg_mesh_creases){.watch = &b->watch,
                                    .workers = &b->workers,
                                    .sharp = options->features == CSGM_FEATURES_SHARP,
                                    .split = options->normals == CSGM_NORMALS_CREASE};
    b->slabs = (csg_mesh_slabs){.watch = &b->watch,
                                .workers = &b->workers,
                                .creases = &b->creases,
                                .is_whole = b->goal != NULL};
    b->output.watch = &b->watch;
    b->output.workers = &b->workers;
    b->output.creases = &b->creases;
    b->output.input = &b->input;
}

/* Nothing but the empty solid has no bounds: then there is no octree and the mesh is empty. */
static csgm_status sample_and_count(build *b)
{
    csgm_context *context = b->input.context;
    csgm_status status = csg_ranks_agree(context, csg_mesh_input_complete(&b->input));
    if (status == CSGM_OK && !csg_box_is_empty(b->input.bounds)) {
        status = csg_mesh_walk_octree(&b->slabs, &b->input);
        if (status == CSGM_OK)
            status = csg_mesh_workers_create(&b->workers, &b->input);
        status = csg_mesh_ranks_share(&b->slabs, status);
        if (status == CSGM_OK)
            status = csg_mesh_count_slabs(&b->slabs); /* finds features, too */
        status = csg_mesh_ranks_number(&b->slabs, status);
        status = csg_mesh_settle_features(&b->creases, b->slabs.octree, status);
    }
    b->sampled_s = csg_clock_now_s();
    return status;
}

static void survey_stages(const build *b)
{
    csg_survey *survey = b->input.context->survey;
    if (!survey || !b->slabs.octree)
        return;
    csg_survey_octree(survey, &b->input, b->slabs.octree);
    csg_survey_features(survey, &b->input, &b->creases.store);
}

static csgm_status reshape_mesh(build *b)
{
    csg_mesh_output *out = &b->output;
    csgm_status status = csg_mesh_reshape(b->goal, &out->mesh, &b->workers.marching, &b->watch);
    out->counts.vertex_count = out->mesh->vertex_count;
    out->counts.triangle_count = out->mesh->triangle_count;
    return status;
}

/* From field to mesh, or to the receiver. */
static csgm_status build_mesh(build *b, csgm_context *context, const csgm_mesh_options *options,
                              csgm_mesh_stats *stats)
{
    CSG_ZONE(context, "build");
    csg_mesh_output *out = &b->output;
    connect_stages(b, context, options);
    const size_t surveyed = context->survey ? context->survey->count : 0;
    csgm_status status = sample_and_count(b);
    if (status == CSGM_OK)
        survey_stages(b);
    if (status == CSGM_OK) {
        status = csg_mesh_begin_output(out, &b->slabs);
        if (status == CSGM_OK)
            status = csg_mesh_ranks_resume(out, &b->slabs);
        if (status == CSGM_OK && out->counts.vertex_count)
            status = csg_mesh_make_slabs(out, &b->slabs);
        status = csg_mesh_ranks_join(out, &b->slabs, status);
    }
    if (status == CSGM_OK && b->goal && out->counts.triangle_count)
        status = reshape_mesh(b);
    if (status == CSGM_OK && !(b->goal && b->goal->cell_size > 0)) { /* there is no next try */
        if (csg_ranks_is_first(context))
            status = csg_mesh_look_for_missed(&b->input, b->slabs.octree, &b->watch, &b->doubts);
        status = csg_ranks_agree(context, status);
        if (status == CSGM_OK && csg_ranks_is_first(context))
            warn_of_result(b);
    } else if (context->survey) {
        context->survey->count = surveyed;
    }
    if (status == CSGM_OK && stats)
        fill_stats(b, stats);
    csg_mesh_workers_release(&b->workers);
    csg_mesh_creases_release(&b->creases);
    csg_mesh_slabs_release(&b->slabs);
    csg_mesh_input_release(&b->input);
    return status;
}

csgm_status csg_mesh_build_field(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, const csg_mesh_share *share,
                                 csg_mesh_goal *goal, csgm_mesh **out, csgm_mesh_stats *stats)
{
    build b = {.input = {.context = context, .options = options, .field = field, .share = share},
               .goal = goal};
    csgm_status status = build_mesh(&b, context, options, stats);
    if (status == CSGM_OK)
        *out = b.output.mesh;
    else
        csg_mesh_destroy(b.output.mesh);
    return status;
}

csgm_status csg_mesh_stream(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, const csg_mesh_receiver *receiver,
                            csg_mesh_counts *counts, csgm_mesh_stats *stats)
{
    build b = {.input = {.context = context, .options = options, .field = field},
               .output = {.receiver = receiver}};
    csgm_status status = build_mesh(&b, context, options, stats);
    if (counts)
        *counts = b.output.counts;
    return status;
}
