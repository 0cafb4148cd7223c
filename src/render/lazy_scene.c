/* SPDX-License-Identifier: MIT
 * Pictures by the lazy evaluator; see lazy_scene.h. Each ray makes steps of |f| / lambda from the
 * nearest plane of what the camera frames to the farthest, n x n rays per pixel.
 */
#include "render/lazy_scene.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/trace.h"
#include "scene/lazy/lazy.h"

enum { PATIENCE = 1000 }; /* steps that are as long as the field's constant allows */
#define GROWTH (1.0 / 16) /* of steps that are made longer, each time, in tolerances */
#define ROUNDING 1e-6     /* of gradients: those of distances have length 1 */

typedef struct lazy_room {
    void *scratch;
    csg_lazy_counts counts;
    uint64_t rays, hits;
} lazy_room;

typedef struct lazy_job {
    csg_picture *picture;
    csg_lazy *lazy;
    lazy_room *rooms; /* one per worker */
    uint32_t room_count;
    size_t scratch_bytes;
    double lipschitz, farthest; /* farthest: along forward, from the nearest plane */
    double tolerance, tolerance_slope;
} lazy_job;

/* Whether the surface is nearer than the tolerance, as far as the gradient says: where the field is
 * less steep than its constant, f / lambda is small long before that. */
static bool is_reached(const csg_sample *sample, double tolerance)
{
    double slope = csg_vec3_norm(sample->gradient) * (1 + ROUNDING);
    return sample->value >= 0 || -sample->value < tolerance * slope;
}

/* Half way again and again between t - step, outside, and t, inside. */
static double cross(const lazy_job *job, lazy_room *room, csg_vec3 origin, csg_vec3 direction,
                    double t, double step, double tolerance, csg_sample *sample)
{
    while (step > tolerance) {
        step /= 2;
        csg_vec3 at = csg_vec3_add(origin, csg_vec3_scale(direction, t - step));
        csg_sample middle = csg_lazy_eval(job->lazy, at, room->scratch, &room->counts);
        if (middle.value >= 0) {
            t -= step;
            *sample = middle;
        }
    }
    return t;
}

/* The distance along the ray, INFINITY where nothing was hit; *sample is what is there. Where steps
 * by the constant would be shorter than the tolerance, or have become too many, they are made
 * longer, more so each time, so that rays end. */
static double trace(const lazy_job *job, lazy_room *room, csg_vec3 origin, csg_vec3 direction,
                    csg_sample *sample)
{
    double end = job->farthest / csg_vec3_dot(direction, job->picture->view.forward), t = 0;
    double lengthened = 0, step = 0;
    for (int count = 0; t < end; count++, t += step) {
        csg_vec3 at = csg_vec3_add(origin, csg_vec3_scale(direction, t));
        *sample = csg_lazy_eval(job->lazy, at, room->scratch, &room->counts);
        double radius = -sample->value / job->lipschitz;
        double tolerance = job->tolerance + job->tolerance_slope * t;
        if (sample->value > 0 && step > tolerance && lengthened > 0)
            return cross(job, room, origin, direction, t, step, tolerance, sample);
        if (radius < tolerance && is_reached(sample, tolerance))
            return t;
        step = radius;
        if (!(radius >= tolerance) || count >= PATIENCE)
            step = fmax(radius, tolerance * (1 + GROWTH * lengthened++));
    }
    return INFINITY;
}

static void shade(const csg_picture *picture, const csg_sample *sample, csg_vec3 direction,
                  float light[3])
{
    csg_vec3 normal = csg_vec3_normalize(csg_vec3_scale(sample->gradient, -1));
    if (csg_vec3_norm(normal) == 0)
        normal = csg_vec3_scale(direction, -1);
    csg_surface surface = {
        .normal = {(float)normal.x, (float)normal.y, (float)normal.z},
        .to_eye = {(float)-direction.x, (float)-direction.y, (float)-direction.z},
        .color = {0.76f, 0.76f, 0.74f},
        .roughness = csg_default_material.g,
        .open = 1,
        .lit = 1,
    };
    csg_shade(&picture->lights, picture->curve, &surface, light);
}

static void draw_pixel(const lazy_job *job, lazy_room *room, uint32_t x, uint32_t y)
{
    const csg_picture *picture = job->picture;
    uint32_t n = picture->options->samples, covered = 0;
    float sum[3] = {0, 0, 0};
    for (uint32_t s = 0; s < n * n; s++) {
        csg_vec3 origin, direction;
        csg_sample sample;
        float light[3];
        csg_view_ray(&picture->view, x + (s % n + 0.5) / n, y + (s / n + 0.5) / n, &origin,
                     &direction);
        room->rays++;
        if (!(trace(job, room, origin, direction, &sample) < INFINITY))
            continue;
        covered++;
        shade(picture, &sample, direction, light);
        for (int c = 0; c < 3; c++)
            sum[c] += light[c];
    }
    room->hits += covered;
    csg_shade_pixel(picture->curve, sum, (float)covered, n * n, picture->options->background,
                    csg_picture_pixel(picture, x, y));
}

static bool draw_row(void *user, uint32_t worker, size_t row)
{
    lazy_job *job = user;
    for (uint32_t x = 0; x < job->picture->image->width; x++) {
        if (x % 64 == 0 && csg_picture_should_stop(job->picture))
            return false;
        draw_pixel(job, &job->rooms[worker], x, (uint32_t)row);
    }
    return true;
}

static bool create_rooms(lazy_job *job)
{
    csg_memory *memory = &job->picture->context->memory;
    job->room_count = csg_pool_threads(job->picture->context->pool);
    job->scratch_bytes = csg_lazy_scratch_bytes(job->lazy) + 16;
    job->rooms = csg_memory_alloc(memory, job->room_count * sizeof *job->rooms);
    if (!job->rooms)
        return false;
    memset(job->rooms, 0, job->room_count * sizeof *job->rooms);
    bool done = true;
    for (uint32_t i = 0; i < job->room_count; i++) {
        job->rooms[i].scratch = csg_memory_alloc(memory, job->scratch_bytes);
        done = done && job->rooms[i].scratch;
    }
    return done;
}

static void release_rooms(lazy_job *job)
{
    csg_memory *memory = &job->picture->context->memory;
    for (uint32_t i = 0; job->rooms && i < job->room_count; i++)
        csg_memory_release(memory, job->rooms[i].scratch, job->scratch_bytes);
    csg_memory_release(memory, job->rooms, job->room_count * sizeof *job->rooms);
}

/* How deep the rays go, and what counts as a hit. */
static void measure(lazy_job *job, csg_box bounds)
{
    const csg_view *view = &job->picture->view;
    double farthest = -INFINITY, share = 0.04 * view->pixel;
    for (int corner = 0; corner < 8; corner++) {
        csg_vec3 p = csg_vec3_make(corner & 1 ? bounds.max.x : bounds.min.x,
                                   corner & 2 ? bounds.max.y : bounds.min.y,
                                   corner & 4 ? bounds.max.z : bounds.min.z);
        farthest = fmax(farthest, csg_vec3_dot(csg_vec3_sub(p, view->eye), view->forward));
    }
    double diagonal = csg_vec3_norm(csg_box_size(bounds));
    job->farthest = farthest - view->nearest + 1e-3 * diagonal;
    job->tolerance = view->orthographic ? share : share * view->nearest;
    job->tolerance = fmax(job->tolerance, 1e-9 * diagonal);
    job->tolerance_slope = view->orthographic ? 0 : share;
}

static csgm_status create_lazy(lazy_job *job, const csgm_field *field)
{
    const csgm_render_options *options = job->picture->options;
    double deepest = job->tolerance + 2 * job->tolerance_slope * job->farthest;
    csg_lazy_options lazy =
        csg_lazy_options_default(2 * deepest * fmax((double)field->tape.lipschitz, 1));
    lazy.lazy = options->lazy;
    if (!options->bounds_used)
        lazy.bounds = CSG_LAZY_NO_BOUNDS;
    return csg_lazy_create(field->scene, &lazy, &job->lazy);
}

static csgm_status render_by_points(lazy_job *job, csgm_render_stats *stats)
{
    CSG_ZONE(job->picture->context, "trace rays");
    csg_picture *picture = job->picture;
    job->lipschitz = csg_lazy_lipschitz(job->lazy);
    csgm_status status = CSGM_OK;
    if (!create_rooms(job))
        status = csg_context_no_memory(picture->context);
    stats->prepare_s = csg_clock_now_s() - picture->started_s;
    if (status == CSGM_OK && !csg_pool_run(picture->context->pool, picture->image->height, draw_row,
                                           csg_picture_poll, job))
        status = csg_picture_why_stopped(picture);
    for (uint32_t i = 0; status == CSGM_OK && i < job->room_count; i++) {
        stats->rays += job->rooms[i].rays;
        stats->hits += job->rooms[i].hits;
        stats->top_level_evaluations += job->rooms[i].counts.top_level;
        stats->total_evaluations += job->rooms[i].counts.total;
    }
    release_rooms(job);
    return status;
}

csgm_status csg_render_lazy(csg_picture *picture, const csgm_field *field, csg_box bounds,
                            csgm_render_stats *stats)
{
    lazy_job job = {.picture = picture};
    measure(&job, bounds);
    csgm_status status = create_lazy(&job, field);
    if (status == CSGM_OK)
        status = render_by_points(&job, stats);
    csg_lazy_destroy(job.lazy);
    return status;
}
