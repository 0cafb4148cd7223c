/* SPDX-License-Identifier: MIT
 * Layers, slab by slab; see slice.h.
 */
#include "slice/slice.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/trace.h"
#include "io/units.h"
#include "slice/contours.h"
#include "slice/heights.h"

/* Slabs for each thread at a time: their pages wait for each other in memory. */
enum { SLABS_AT_ONCE = 4 };
static const double SHARE_OF_LONGEST = 1e-4; /* the tolerance where none is given */

typedef struct slab_page {
    csg_page page;
    size_t first, end; /* of its layers */
    uint64_t contours, points, unsettled;
    double area; /* of its layers, each times its height: a volume */
} slab_page;

typedef struct slice_worker {
    csg_slice_cubes cubes;
    csg_slice_contours contours;
    csg_outline outline;
} slice_worker;

typedef struct slice_job {
    csg_slice_plan plan;
    csgm_context *context;
    csg_mesh_watch *watch;
    const csg_layers_receiver *receiver;
    csg_layers_head head;
    double *z; /* of the layers' middles, in the field's frame */
    csg_slice_heights heights;
    slice_worker *workers;
    uint32_t worker_count;
    slab_page *pages;
    size_t page_count;
    uint32_t first_slab; /* of the pages at hand */
    size_t layers_done;
    atomic_bool is_open;
} slice_job;

/* ---- slabs -------------------------------------------------------------------------------------
 */

static double area_of(const csg_outline *outline)
{
    double twice = 0;
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        csg_vec2 from = outline->points[first];
        for (size_t i = first + 1; i + 1 < end; i++) {
            csg_vec2 a = outline->points[i], b = outline->points[i + 1];
            twice += (a.x - from.x) * (b.y - from.y) - (a.y - from.y) * (b.x - from.x);
        }
    }
    return 0.5 * twice;
}

/* Where a layer between these is cut. */
static double middle_of(const double ends[2])
{
    return 0.5 * (ends[0] + ends[1]);
}

static bool put_layer(slice_job *job, slice_worker *w, slab_page *slab, size_t number)
{
    csg_outline *o = &w->outline;
    const double *ends = job->heights.ends + number;
    o->point_count = o->loop_count = 0;
    if (!csg_slice_contours_make(&w->contours, number, o))
        return false;
    csg_sliced_layer layer = {
        .number = number, .low = ends[0], .high = ends[1], .at = middle_of(ends), .contours = *o};
    job->receiver->layer(job->receiver->user, &slab->page, &job->head, &layer);
    slab->contours += o->loop_count;
    slab->points += o->point_count;
    slab->area += area_of(o) * (ends[1] - ends[0]);
    return !slab->page.failed;
}

static bool make_slab(void *user, uint32_t worker, size_t index)
{
    slice_job *job = user;
    slice_worker *w = &job->workers[worker];
    slab_page *slab = &job->pages[index];
    uint32_t number = job->first_slab + (uint32_t)index;
    double edge = ldexp(job->plan.step, job->plan.levels - job->plan.slab_level);
    double from = job->plan.corner[2] + number * edge;
    slab->page.length = 0;
    slab->contours = slab->points = slab->unsettled = 0;
    slab->area = 0;
    slab->first = csg_slice_layers_below(&job->plan, from);
    slab->end = csg_slice_layers_below(&job->plan, job->plan.corner[2] + (number + 1.0) * edge);
    if (slab->first == slab->end)
        return true;
    bool done = csg_slice_cubes_make(&w->cubes, slab->first, slab->end);
    slab->unsettled = w->cubes.unsettled;
    for (size_t i = slab->first; i < slab->end && done; i++)
        done = !csg_mesh_should_stop(job->watch) && put_layer(job, w, slab, i);
    if (w->contours.is_open)
        atomic_store(&job->is_open, true);
    else if (!done && !csg_mesh_should_stop(job->watch))
        return csg_mesh_stop_without_memory(job->watch);
    return done;
}

static void tell_progress(void *user, size_t done, size_t count)
{
    const slice_job *job = user;
    double slabs = ldexp(1, job->plan.slab_level);
    (void)count;
    csg_mesh_report_progress(job->watch, ((double)job->first_slab + (double)done) / slabs);
}

static csgm_status report_open(csgm_context *context)
{
    csg_diag_plain(&context->diags, CSG_DIAG_OPEN_MESH, NULL, "please report this with the scene",
                   "a layer's contour is not closed, which is a bug in csgmesh");
    return CSGM_ERR_INTERNAL;
}

static csgm_status make_slabs(slice_job *job, csgm_slice_stats *stats)
{
    const csg_layers_receiver *r = job->receiver;
    uint32_t slabs = 1u << job->plan.slab_level;
    csg_mesh_take(job->watch, CSGM_STAGE_WRITE, 1);
    for (; job->first_slab < slabs; job->first_slab += (uint32_t)job->page_count) {
        size_t count = slabs - job->first_slab;
        count = count < job->page_count ? count : job->page_count;
        if (!csg_pool_run(job->context->pool, count, make_slab, tell_progress, job))
            return atomic_load(&job->is_open) ? report_open(job->context)
                                              : csg_mesh_why_stopped(job->watch);
        for (size_t i = 0; i < count; i++) {
            const slab_page *slab = &job->pages[i];
            if (slab->page.length && !r->page(r->user, &slab->page))
                return CSGM_ERR_IO;
            stats->layers += slab->end - slab->first;
            stats->contours += slab->contours;
            stats->points += slab->points;
            stats->unsettled += slab->unsettled;
            stats->volume += slab->area;
        }
    }
    return CSGM_OK;
}

/* ---- the whole ---------------------------------------------------------------------------------
 */

static csgm_status check_solid(csgm_context *context, csg_box bounds)
{
    if (csg_box_is_empty(bounds)) {
        csg_diag_plain(&context->diags, CSG_DIAG_NOTHING_TO_MEASURE, NULL, NULL,
                       "the solid is empty: there is nothing to slice");
        return CSGM_ERR_SCENE;
    }
    if (csg_box_is_finite(bounds))
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_UNBOUNDED, NULL, "intersect the solid with a cube",
                   "the solid reaches to infinity, so it has no layers");
    return CSGM_ERR_SCENE;
}

static csgm_status place_layers(slice_job *job, const csgm_field *field,
                                const csgm_slice_options *options)
{
    csg_slice_heights *h = &job->heights;
    csgm_status status = csg_slice_heights_find(h, job->context, field, job->watch, options);
    if (status != CSGM_OK)
        return status;
    job->head.count = h->count;
    job->head.bottom = h->ends[0];
    job->head.top = h->ends[h->count];
    job->head.lowest = h->lowest;
    job->z = csg_memory_alloc(&job->context->memory, h->count * sizeof *job->z);
    if (!job->z)
        return csg_context_no_memory(job->context);
    for (size_t i = 0; i < h->count; i++)
        job->z[i] = middle_of(h->ends + i) - field->center.z;
    return CSGM_OK;
}

static bool create_rooms(slice_job *job)
{
    csg_memory *memory = &job->context->memory;
    job->worker_count = csg_pool_threads(job->context->pool);
    job->page_count = (size_t)SLABS_AT_ONCE * job->worker_count;
    job->workers = csg_memory_alloc(memory, job->worker_count * sizeof *job->workers);
    job->pages = csg_memory_alloc(memory, job->page_count * sizeof *job->pages);
    for (size_t i = 0; job->pages && i < job->page_count; i++)
        job->pages[i] = (slab_page){.page = csg_layers_page(memory, &job->head)};
    bool done = job->workers && job->pages;
    for (uint32_t i = 0; job->workers && i < job->worker_count; i++) {
        slice_worker *w = &job->workers[i];
        bool has_cubes = csg_slice_cubes_init(&w->cubes, &job->plan);
        bool has_contours = csg_slice_contours_init(&w->contours, &w->cubes);
        csg_outline_init(&w->outline, memory);
        done = done && has_cubes && has_contours;
    }
    return done;
}

static void release_rooms(slice_job *job)
{
    csg_memory *memory = &job->context->memory;
    for (uint32_t i = 0; job->workers && i < job->worker_count; i++) {
        slice_worker *w = &job->workers[i];
        csg_outline_release(&w->outline);
        csg_slice_contours_release(&w->contours);
        csg_slice_cubes_release(&w->cubes);
    }
    for (size_t i = 0; job->pages && i < job->page_count; i++)
        csg_layers_release_page(&job->pages[i].page);
    csg_memory_release(memory, job->workers, job->worker_count * sizeof *job->workers);
    csg_memory_release(memory, job->pages, job->page_count * sizeof *job->pages);
    csg_memory_release(memory, job->z, job->head.count * sizeof *job->z);
    csg_slice_heights_release(&job->heights, memory);
}

static csgm_status make_layers(slice_job *job, const csgm_field *field, csgm_slice_stats *stats)
{
    const csg_layers_receiver *r = job->receiver;
    csg_slice_plan_make(&job->plan, job->context, field, job->watch, stats->tolerance, job->z,
                        job->head.count);
    stats->smallest = job->plan.step;
    stats->lowest = job->heights.lowest;
    stats->highest = job->heights.highest;
    stats->sampled = job->heights.sampled;
    stats->sampled_edge = job->heights.edge;
    if (!create_rooms(job))
        return csg_context_no_memory(job->context);
    return r->begin(r->user, &job->head) ? make_slabs(job, stats) : CSGM_ERR_IO;
}

csgm_status csg_slice_field(csgm_context *context, const csgm_field *field,
                            const csgm_slice_options *options, const csg_layers_receiver *receiver,
                            csgm_slice_stats *stats)
{
    CSG_ZONE(context, "slice");
    csg_mesh_watch watch = {0};
    slice_job job = {.context = context, .watch = &watch, .receiver = receiver};
    csgm_status status = check_solid(context, field->bounds);
    if (status != CSGM_OK)
        return status;
    double longest = csg_box_longest_side(field->bounds);
    csg_mesh_watch_begin(&watch, context, &options->monitor, 0);
    stats->tolerance = options->tolerance > 0 ? options->tolerance : SHARE_OF_LONGEST * longest;
    job.head.box = field->bounds;
    job.head.tolerance = stats->tolerance;
    job.head.scale = options->unit ? csg_unit_metres(options->unit) * 1000 : 1;
    status = place_layers(&job, field, options);
    if (status == CSGM_OK)
        status = make_layers(&job, field, stats);
    release_rooms(&job);
    return status;
}
