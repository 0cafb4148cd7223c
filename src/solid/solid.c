/* SPDX-License-Identifier: MIT
 * Jobs and the nodes they are made of; see solid.h.
 */
#include "solid/solid.h"

#include <string.h>

#include "base/clock.h"
#include "scene/tree/figures.h"
#include "shape/plane/polygons.h"
#include "shape/plane/region.h"

/* ---- going on or not ------------------------------------------------------------------------- */

static void stop(csg_solid_job *job, csgm_status status)
{
    if (!job->stop)
        job->status = status;
    job->stop = true;
}

void csg_solid_no_memory(csg_solid_job *job)
{
    stop(job, CSGM_ERR_MEMORY);
}

bool csg_solid_charge(csg_solid_job *job, uint64_t steps)
{
    enum { LOOK_AT_CLOCK = 4096 };
    if (job->stop)
        return false;
    job->steps += steps;
    if (job->steps > job->most_steps) {
        stop(job, CSGM_ERR_LIMIT);
        return false;
    }
    return job->steps - job->clock_steps < LOOK_AT_CLOCK || csg_solid_check_time(job);
}

bool csg_solid_check_time(csg_solid_job *job)
{
    job->clock_steps = job->steps;
    if ((job->deadline_s != 0 && csg_clock_now_s() > job->deadline_s) ||
        csg_context_is_cancelled(job->builder->context))
        stop(job, CSGM_ERR_LIMIT); /* the evaluator asks which of both */
    return !job->stop;
}

void csg_solid_note(csg_solid_job *job, const csg_solid_reason *reason)
{
    for (uint32_t i = 0; i < job->reason_count; i++)
        if (job->reasons[i].fault == reason->fault)
            return;
    if (!job->stop)
        job->reasons[job->reason_count++] = *reason;
}

/* ---- nodes ----------------------------------------------------------------------------------- */

bool csg_solid_is_empty(const csg_solid_job *job, csg_node_id node)
{
    return job->builder->scene->nodes[node].kind == CSG_NODE_EMPTY;
}

bool csg_solid_is_flat(const csg_solid_job *job, csg_node_id node)
{
    return !csg_solid_is_empty(job, node) && csg_build_is_flat(job->builder, node);
}

/* The builder's first failure is sticky; a bad solid is noted and built on without it. */
csg_node_id csg_solid_done(csg_solid_job *job, csg_node_id node)
{
    csg_scene_builder *builder = job->builder;
    csg_solid_reason reason = {.fault = CSG_SOLID_BAD_NODE};
    if (node != CSG_NODE_NONE || job->stop)
        return node;
    if (builder->status == CSGM_ERR_MEMORY || builder->status == CSGM_ERR_LIMIT) {
        stop(job, builder->status);
        return node;
    }
    memcpy(reason.problem, builder->problem, sizeof reason.problem);
    csg_solid_note(job, &reason);
    builder->status = CSGM_OK;
    builder->problem[0] = '\0';
    node = csg_build_empty(builder, job->where);
    if (node == CSG_NODE_NONE)
        csg_solid_no_memory(job);
    return node;
}

csg_node_id csg_solid_empty(csg_solid_job *job)
{
    if (job->stop)
        return CSG_NODE_NONE;
    return csg_solid_done(job, csg_build_empty(job->builder, job->where));
}

csg_node_id csg_solid_moved(csg_solid_job *job, csg_node_id node, const csg_affine *by)
{
    if (node == CSG_NODE_NONE || job->stop)
        return CSG_NODE_NONE;
    return csg_solid_done(job, csg_build_transform(job->builder, by, node, job->where));
}

csg_node_id csg_solid_grown(csg_solid_job *job, csg_node_id node, double r)
{
    if (node == CSG_NODE_NONE || job->stop || r == 0 || csg_solid_is_empty(job, node))
        return node;
    return csg_solid_done(job, csg_build_offset(job->builder, r, node, job->where));
}

csg_node_id csg_solid_union(csg_solid_job *job, const csg_node_id *nodes, size_t count)
{
    const csg_blend sharp = CSG_SHARP;
    return csg_solid_done(
        job, csg_build_operator(job->builder, CSG_NODE_UNION, sharp, nodes, count, job->where));
}

csg_node_id csg_solid_failed(csg_solid_job *job, csgm_status status, const char *what)
{
    const csg_solid_reason reason = {.fault = CSG_SOLID_FAILED, .status = status, .what = what};
    if (status == CSGM_ERR_MEMORY)
        csg_solid_no_memory(job);
    if (!job->stop && !job->failed) /* else it was noted already */
        csg_solid_note(job, &reason);
    return csg_solid_empty(job);
}

static csg_node_id nothing(csg_solid_job *job, csg_solid_fault fault)
{
    csg_solid_note(job, &(csg_solid_reason){.fault = fault});
    return csg_solid_empty(job);
}

csg_node_id csg_solid_region(csg_solid_job *job, csg_outline *clean)
{
    csg_shape *shape = NULL;
    size_t loops = clean->loop_count;
    csgm_status status =
        loops && csg_solid_check_time(job)
            ? csg_figures_region(&job->builder->figures, job->memory, clean, &shape)
            : CSGM_OK;
    csg_outline_release(clean);
    if (job->stop)
        return CSG_NODE_NONE;
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make a region of this outline");
    if (!shape)
        return nothing(job, CSG_SOLID_NO_AREA);
    return csg_solid_done(job, csg_build_shape(job->builder, shape, job->where));
}

csg_node_id csg_solid_area(csg_solid_job *job, csg_outline *outline, bool even_odd)
{
    csg_outline clean;
    csgm_status status =
        csg_polygons_clean(outline, even_odd ? CSG_FILL_EVEN_ODD : CSG_FILL_NONZERO, &clean);
    csg_outline_release(outline);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make a clean figure of this outline");
    return csg_solid_region(job, &clean);
}

csg_node_id csg_solid_of_triangles(csg_solid_job *job, csg_triangles *triangles,
                                   csg_repairs *repairs)
{
    csg_shape *shape = NULL;
    csg_repairs unseen = {0};
    csg_solid_fault emptiness = triangles->count ? CSG_SOLID_NO_VOLUME : CSG_SOLID_NO_TRIANGLES;
    csgm_status status =
        csg_solid_check_time(job)
            ? csg_polyhedron_create(job->memory, triangles, repairs ? repairs : &unseen, &shape)
            : CSGM_OK;
    csg_triangles_release(triangles);
    if (job->stop)
        return CSG_NODE_NONE;
    if (status == CSGM_ERR_SCENE)
        return nothing(job, emptiness);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make a solid of these triangles");
    return csg_solid_done(job, csg_build_shape(job->builder, shape, job->where));
}
