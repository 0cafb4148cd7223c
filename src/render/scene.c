/* SPDX-License-Identifier: MIT
 * A field's picture: an octree of short tapes (cells.h), then tile by tile one ray a pixel
 * (tracer.h), light (shade.h), and n x n rays for the pixels that differ from a neighbour. A tile
 * looks one pixel over its border, so that it decides as its neighbours do, whoever draws them.
 */
#include <float.h>
#include <string.h>

#include "base/clock.h"
#include "field/dispatch.h"
#include "render/job.h"
#include "render/lazy_scene.h"
#include "render/tracer.h"

enum {
    TILE = 34 - 2,     /* pixels: with a border of one on each side still a batch of rays */
    EDGE_CONTRAST = 12 /* steps of a byte, above which a pixel gets more rays */
};

typedef struct tile_room {
    csg_trace_room trace;
    float light[CSG_RAYS_MOST][3];
    uint8_t pixel[CSG_RAYS_MOST][4];
    uint16_t edges[TILE * TILE]; /* x + TILE * y in the tile */
    uint32_t edge_count;
} tile_room;

typedef struct scene_job {
    csg_picture *picture;
    const csgm_field *field;
    csgm_field *clipped; /* owned, NULL when the bounds cut nothing */
    csg_box bounds;
    csg_ray_cells cells;
    csg_pixel_rectangle *rectangles;
    csg_tracer tracer;
    tile_room **rooms; /* one a worker */
    uint32_t room_count, columns, rows;
} scene_job;

/* The pixels of a tile, and with the border around it. */
typedef struct tile {
    uint32_t x0, y0, x1, y1;
    uint32_t outer_x0, outer_y0, outer_x1, outer_y1;
} tile;

static tile tile_at(const scene_job *job, size_t index)
{
    const csgm_image *image = job->picture->image;
    tile t = {.x0 = (uint32_t)(index % job->columns) * TILE,
              .y0 = (uint32_t)(index / job->columns) * TILE};
    t.x1 = t.x0 + TILE < image->width ? t.x0 + TILE : image->width;
    t.y1 = t.y0 + TILE < image->height ? t.y0 + TILE : image->height;
    t.outer_x0 = t.x0 ? t.x0 - 1 : 0;
    t.outer_y0 = t.y0 ? t.y0 - 1 : 0;
    t.outer_x1 = t.x1 < image->width ? t.x1 + 1 : t.x1;
    t.outer_y1 = t.y1 < image->height ? t.y1 + 1 : t.y1;
    return t;
}

/* ---- light of a batch ------------------------------------------------------------------------ */

static void shade_rays(const scene_job *job, tile_room *room)
{
    const csg_rays *rays = &room->trace.rays;
    const csg_picture *picture = job->picture;
    for (uint32_t i = 0; i < rays->count; i++) {
        memset(room->light[i], 0, sizeof room->light[i]);
        bool hit = rays->t[i] < INFINITY;
        if (hit) {
            csg_surface surface = {
                .normal = {rays->nx[i], rays->ny[i], rays->nz[i]},
                .to_eye = {-rays->dx[i], -rays->dy[i], -rays->dz[i]},
                .color = {rays->r[i], rays->g[i], rays->b[i]},
                .metallic = rays->metallic[i],
                .roughness = rays->roughness[i],
                .open = rays->open[i],
                .lit = rays->lit[i],
            };
            csg_shade(&picture->lights, picture->curve, &surface, room->light[i]);
        }
        csg_shade_pixel(picture->curve, room->light[i], hit, 1, picture->options->background,
                        room->pixel[i]);
    }
}

/* ---- one ray a pixel, and where that is not enough ------------------------------------------- */

static void trace_tile(const scene_job *job, tile_room *room, const tile *t)
{
    csg_rays *rays = &room->trace.rays;
    csg_tracer_begin(rays, t->outer_y0);
    for (uint32_t y = t->outer_y0; y < t->outer_y1; y++)
        for (uint32_t x = t->outer_x0; x < t->outer_x1; x++)
            csg_tracer_aim(&job->tracer, rays, x + 0.5, y + 0.5);
    csg_tracer_trace(&job->tracer, &room->trace);
    shade_rays(job, room);
}

static bool differ(const uint8_t *a, const uint8_t *b)
{
    int most = 0;
    for (int i = 0; i < 4; i++) {
        int by = a[i] > b[i] ? a[i] - b[i] : b[i] - a[i];
        most = by > most ? by : most;
    }
    return most > EDGE_CONTRAST;
}

static void find_edges(const scene_job *job, tile_room *room, const tile *t)
{
    uint32_t width = t->outer_x1 - t->outer_x0;
    room->edge_count = 0;
    for (uint32_t y = t->y0; y < t->y1; y++)
        for (uint32_t x = t->x0; x < t->x1; x++) {
            uint32_t i = (y - t->outer_y0) * width + x - t->outer_x0;
            const uint8_t *pixel = room->pixel[i];
            bool is_edge = (x > t->outer_x0 && differ(pixel, room->pixel[i - 1])) ||
                           (x + 1 < t->outer_x1 && differ(pixel, room->pixel[i + 1])) ||
                           (y > t->outer_y0 && differ(pixel, room->pixel[i - width])) ||
                           (y + 1 < t->outer_y1 && differ(pixel, room->pixel[i + width]));
            memcpy(csg_picture_pixel(job->picture, x, y), pixel, 4);
            if (is_edge)
                room->edges[room->edge_count++] = (uint16_t)(x - t->x0 + TILE * (y - t->y0));
        }
}

static void resolve(const scene_job *job, tile_room *room, const tile *t, uint32_t first,
                    uint32_t end, uint32_t samples)
{
    const csg_rays *rays = &room->trace.rays;
    for (uint32_t e = first, ray = 0; e < end; e++) {
        float light[3] = {0, 0, 0};
        uint32_t covered = 0;
        for (uint32_t s = 0; s < samples; s++, ray++) {
            covered += rays->t[ray] < INFINITY;
            for (int c = 0; c < 3; c++)
                light[c] += room->light[ray][c];
        }
        uint32_t x = t->x0 + room->edges[e] % TILE, y = t->y0 + room->edges[e] / TILE;
        csg_shade_pixel(job->picture->curve, light, covered, samples,
                        job->picture->options->background, csg_picture_pixel(job->picture, x, y));
    }
}

static void refine_edges(const scene_job *job, tile_room *room, const tile *t)
{
    uint32_t n = job->picture->options->samples, samples = n * n, at_once = CSG_RAYS_MOST / samples;
    csg_rays *rays = &room->trace.rays;
    for (uint32_t first = 0; first < room->edge_count; first += at_once) {
        uint32_t end = first + at_once < room->edge_count ? first + at_once : room->edge_count;
        csg_tracer_begin(rays, t->y0);
        for (uint32_t e = first; e < end; e++)
            for (uint32_t s = 0; s < samples; s++)
                csg_tracer_aim(&job->tracer, rays,
                               t->x0 + room->edges[e] % TILE + (s % n + 0.5) / n,
                               t->y0 + room->edges[e] / TILE + (s / n + 0.5) / n);
        csg_tracer_trace(&job->tracer, &room->trace);
        shade_rays(job, room);
        resolve(job, room, t, first, end, samples);
    }
}

static bool draw_tile(void *user, uint32_t worker, size_t index)
{
    scene_job *job = user;
    if (csg_picture_should_stop(job->picture))
        return false;
    tile_room *room = job->rooms[worker];
    tile t = tile_at(job, index);
    trace_tile(job, room, &t);
    find_edges(job, room, &t);
    if (job->picture->options->samples > 1)
        refine_edges(job, room, &t);
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool create_rooms(scene_job *job)
{
    csgm_context *context = job->picture->context;
    job->room_count = csg_pool_threads(context->pool);
    size_t bytes = job->room_count * sizeof *job->rooms;
    job->rooms = csg_memory_alloc(&context->memory, bytes);
    if (!job->rooms)
        return false;
    memset(job->rooms, 0, bytes);
    bool done = true;
    for (uint32_t i = 0; i < job->room_count && done; i++) {
        tile_room *room = job->rooms[i] = csg_memory_alloc(&context->memory, sizeof *room);
        if (!room)
            return false;
        memset(room, 0, sizeof *room);
        room->trace.scratch_floats = csg_kernel_scratch_floats(job->field->depth);
        room->trace.scratch =
            csg_memory_alloc(&context->memory, room->trace.scratch_floats * sizeof(float));
        done = room->trace.scratch != NULL;
    }
    return done;
}

static void release_rooms(scene_job *job)
{
    csg_memory *memory = &job->picture->context->memory;
    for (uint32_t i = 0; job->rooms && i < job->room_count; i++) {
        tile_room *room = job->rooms[i];
        if (room)
            csg_memory_release(memory, room->trace.scratch,
                               room->trace.scratch_floats * sizeof(float));
        csg_memory_release(memory, room, sizeof *room);
    }
    csg_memory_release(memory, job->rooms, job->room_count * sizeof *job->rooms);
}

static csg_box moved_box(csg_box box, csg_vec3 by)
{
    return (csg_box){csg_vec3_sub(box.min, by), csg_vec3_sub(box.max, by)};
}

/* How far from the surface a ray may stop: a part of a pixel. Returns the largest in the solid's
 * box. */
static double set_tolerance(scene_job *job)
{
    csg_tracer *tracer = &job->tracer;
    const csg_view *view = &tracer->view;
    csg_box box = moved_box(job->bounds, job->field->center);
    double diagonal = csg_vec3_norm(csg_box_size(box)), share = 0.04 * view->pixel;
    double far = csg_vec3_norm(csg_vec3_sub(csg_box_center(box), view->eye)) + diagonal;
    double near = view->orthographic ? share : share * view->nearest;
    tracer->near_tolerance = (float)fmax(near, 64 * (double)FLT_EPSILON * (diagonal + 1e-30));
    tracer->tolerance_slope = view->orthographic ? 0 : (float)share;
    return (double)tracer->near_tolerance + (double)tracer->tolerance_slope * far;
}

/* The octree's depth follows from the size of a pixel where the solid is. */
static csgm_status make_cells(scene_job *job)
{
    csg_picture *picture = job->picture;
    const csg_view *view = &job->tracer.view;
    csg_box box = moved_box(job->bounds, job->field->center);
    csg_vec3 size = csg_box_size(box);
    double side = fmax(size.x, fmax(size.y, size.z));
    double away = csg_vec3_norm(csg_vec3_sub(csg_box_center(box), view->eye));
    double pixels = side / (view->pixel * (view->orthographic ? 1 : fmax(away, 1e-3 * side)));
    int level = 4;
    for (double cell = pixels / 16; cell > 16 && level < 10; cell /= 2)
        level++;
    csg_ray_cells_options options = {
        .wide = picture->options->occlusion || picture->options->shadows,
        .band = (float)(4 * set_tolerance(job)) * job->field->tape.lipschitz,
        .most_level = level,
        .cancelled = csg_picture_should_stop,
        .user = picture};
    csgm_status status =
        csg_ray_cells_create(picture->context, job->field, box, &options, &job->cells);
    return status == CSGM_CANCELLED ? csg_picture_why_stopped(picture) : status;
}

static void set_light(csg_tracer *tracer, const csg_lights *lights, const csg_view *view)
{
    csg_vec3 key =
        csg_vec3_make((double)lights->key[0], (double)lights->key[1], (double)lights->key[2]);
    csg_vec3 u = csg_vec3_normalize(csg_vec3_cross(key, view->right));
    csg_vec3 v = csg_vec3_cross(key, u);
    memcpy(tracer->light, lights->key, sizeof tracer->light);
    const double across[2][3] = {{u.x, u.y, u.z}, {v.x, v.y, v.z}};
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < 3; axis++)
            tracer->light_across[i][axis] = (float)across[i][axis];
}

/* The solid's bounds are only known to contain it; the cells of its surface are nearer. */
static csg_box surface_box(const scene_job *job)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < job->cells.count; i++) {
        const csg_ray_cell *cell = &job->cells.cells[i];
        csg_vec3 c = csg_vec3_make((double)cell->center[0], (double)cell->center[1],
                                   (double)cell->center[2]);
        if (cell->is_leaf && cell->has_surface)
            box = csg_box_hull(box, csg_box_grow((csg_box){c, c}, (double)cell->half));
    }
    return csg_box_intersect(moved_box(box, csg_vec3_scale(job->field->center, -1)), job->bounds);
}

static void set_view(scene_job *job)
{
    csg_tracer *tracer = &job->tracer;
    tracer->view = job->picture->view;
    tracer->view.eye = csg_vec3_sub(job->picture->view.eye, job->field->center);
    set_light(tracer, &job->picture->lights, &job->picture->view);
    set_tolerance(job);
}

static csgm_status make_tracer(scene_job *job)
{
    csg_picture *picture = job->picture;
    const csgm_field *field = job->field;
    csgm_context *context = picture->context;
    job->tracer = (csg_tracer){
        .kernel = csg_kernel_for(context->isa),
        .field = field,
        .cells = &job->cells,
        .inverse_lipschitz = 1 / field->tape.lipschitz,
        .occlusion = picture->options->occlusion,
        .shadows = picture->options->shadows,
        .colors = field->has_colors && field->color_count > 1,
    };
    set_view(job);
    csgm_status status = make_cells(job);
    csg_box tight = status == CSGM_OK ? surface_box(job) : csg_box_empty();
    if (status == CSGM_OK && !csg_box_is_empty(tight)) {
        status = csg_picture_place(picture, tight);
        set_view(job); /* tolerances only become smaller: the eye comes nearer */
    }
    if (status != CSGM_OK)
        return status;
    job->rectangles =
        csg_memory_alloc(&context->memory, job->cells.count * sizeof *job->rectangles);
    if (!job->rectangles)
        return csg_context_no_memory(context);
    job->tracer.rectangles = job->rectangles;
    csg_tracer_find_rectangles(&job->tracer, job->rectangles);
    return CSGM_OK;
}

static void fill_stats(const scene_job *job, csgm_render_stats *stats)
{
    for (size_t i = 0; i < job->cells.count; i++)
        stats->cells += job->cells.cells[i].is_leaf && job->cells.cells[i].has_surface;
    stats->interval_evaluations = job->cells.interval_evaluations;
    stats->primitive_evaluations = job->cells.primitive_evaluations;
    for (uint32_t i = 0; job->rooms && i < job->room_count; i++) {
        const csg_trace_counts *counts = &job->rooms[i]->trace.counts;
        stats->rays += counts->rays;
        stats->shadow_rays += counts->shadow_rays;
        stats->hits += counts->hits;
        stats->point_evaluations += counts->point_evaluations;
        stats->gradient_evaluations += counts->gradient_evaluations;
        stats->primitive_evaluations += counts->primitive_evaluations;
    }
}

static csgm_status trace_all(scene_job *job, csgm_render_stats *stats)
{
    csg_picture *picture = job->picture;
    csgm_status status = make_tracer(job);
    if (status == CSGM_OK && !create_rooms(job))
        status = csg_context_no_memory(picture->context);
    if (status == CSGM_OK)
        csg_tracer_find_slope(&job->tracer, &job->rooms[0]->trace);
    stats->prepare_s = csg_clock_now_s() - picture->started_s;
    job->columns = (picture->image->width + TILE - 1) / TILE;
    job->rows = (picture->image->height + TILE - 1) / TILE;
    if (status == CSGM_OK && !csg_pool_run(picture->context->pool, (size_t)job->columns * job->rows,
                                           draw_tile, csg_picture_poll, job))
        status = csg_picture_why_stopped(picture);
    if (status == CSGM_OK)
        fill_stats(job, stats);
    release_rooms(job);
    csg_memory_release(&picture->context->memory, job->rectangles,
                       job->cells.count * sizeof *job->rectangles);
    if (job->cells.context)
        csg_ray_cells_release(&job->cells);
    return status;
}

/* ---- bounds ---------------------------------------------------------------------------------- */

static csgm_status choose_bounds(scene_job *job, csgm_context *context,
                                 const csgm_render_options *options)
{
    job->bounds = csg_box_is_empty(options->bounds) ? job->field->bounds : options->bounds;
    if (csg_box_is_empty(job->bounds))
        return CSGM_OK;
    if (!csg_box_is_empty(options->bounds) && !csg_box_is_finite(options->bounds)) {
        csg_diag_plain(&context->diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL,
                       "the bounds must be finite numbers");
        return CSGM_ERR_ARGUMENT;
    }
    if (!csg_box_is_finite(job->bounds)) {
        csg_diag_plain(&context->diags, CSG_DIAG_UNBOUNDED, NULL,
                       "give --bounds X0,Y0,Z0,X1,Y1,Z1, or intersect the solid with a cube",
                       "the solid reaches to infinity, so there is no box to draw");
        return CSGM_ERR_SCENE;
    }
    if (csg_box_contains_box(job->bounds, job->field->bounds) || options->slice_axis >= 0)
        return CSGM_OK;
    csgm_status status = csg_field_clip(context, job->field, job->bounds, &job->clipped);
    if (status == CSGM_OK) {
        job->field = job->clipped;
        job->bounds = csg_box_intersect(job->bounds, job->clipped->bounds);
    }
    return status;
}

static void draw_background(csg_picture *picture)
{
    size_t count = csg_image_bytes(picture->image) / 4;
    for (size_t i = 0; i < count; i++)
        memcpy(picture->image->pixels + 4 * i, picture->options->background, 4);
}

static csgm_status draw(scene_job *job, csgm_render_stats *stats)
{
    csg_picture *picture = job->picture;
    const csgm_render_options *options = picture->options;
    if (csg_box_is_empty(job->bounds)) {
        draw_background(picture);
        return CSGM_OK;
    }
    if (options->slice_axis >= 0)
        return csg_render_slice(picture, job->field, job->bounds, stats);
    if (options->evaluator == CSGM_EVALUATOR_LAZY)
        return csg_render_lazy(picture, job->field, job->bounds, stats);
    return trace_all(job, stats);
}

csgm_status csg_render_scene(csgm_context *context, const csgm_field *field,
                             const csgm_render_options *options, csgm_image **out,
                             csgm_render_stats *stats)
{
    csg_picture picture = {.context = context};
    scene_job job = {.picture = &picture, .field = field};
    *stats = (csgm_render_stats){0};
    csgm_status status = choose_bounds(&job, context, options);
    if (status == CSGM_OK)
        status = csg_picture_begin(&picture, context, options, job.bounds);
    if (status == CSGM_OK)
        status = draw(&job, stats);
    if (status == CSGM_OK && !stats->hits && options->slice_axis < 0)
        csg_diag_plain(&context->diags, CSG_DIAG_NO_SURFACE, NULL,
                       "the camera may look past the solid", "nothing of the solid is in sight");
    csg_field_destroy(job.clipped);
    stats->trace_s = csg_clock_now_s() - picture.started_s - stats->prepare_s;
    stats->memory_peak_bytes = atomic_load(&context->memory.peak_bytes);
    return csg_picture_end(&picture, status, out);
}
