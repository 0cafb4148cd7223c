/* SPDX-License-Identifier: MIT
 * A field's picture: an octree of short tapes (layer.h), then tile by tile one ray per pixel
 * (tracer.h), light (shade.h), and n x n rays for the pixels that differ from a neighbour. A tile
 * looks one pixel over its border, so that it decides as its neighbours do, whoever draws them.
 * What the scene marks (# and %) is traced by rays of its own and laid over the solid where it is
 * not behind it.
 */
#include <string.h>

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/trace.h"
#include "field/kernels/dispatch.h"
#include "render/ground.h"
#include "render/layer.h"
#include "render/lazy_scene.h"
#include "render/outline.h"

enum {
    TILE = 34 - 2,     /* pixels: with a border of one on each side still a batch of rays */
    EDGE_CONTRAST = 12 /* steps of a byte, above which a pixel gets more rays */
};

static const float SAME_LIGHT = 0.03f; /* shares of the key light that count as the same */

typedef struct tile_room {
    csg_trace_room trace;
    csg_trace_room *over;   /* for marks; NULL where there are none */
    csg_trace_room *behind; /* what is seen through the solid; NULL where nothing is */
    csg_ground_nodes nodes; /* of the tile */
    uint32_t count;         /* of rays in the batch */
    float light[CSG_RAYS_MOST][3];
    float cover[CSG_RAYS_MOST]; /* how much of the background is hidden */
    uint8_t pixel[CSG_RAYS_MOST][4];
    uint16_t edges[TILE * TILE]; /* x + TILE * y in the tile */
    float edge_lit[TILE * TILE]; /* the light that arrives there, or below 0 */
    uint32_t edge_count;
} tile_room;

_Static_assert((TILE + 2) * (TILE + 2) + CSG_GROUND_NODES * CSG_GROUND_NODES <= CSG_RAYS_MOST &&
                   TILE + 2 * CSG_GROUND_STEP == (CSG_GROUND_NODES - 1) * CSG_GROUND_STEP,
               "nodes cover a tile with its border, and their rays fit into its batch");

typedef struct scene_job {
    csg_picture *picture;
    csg_layer layers[CSG_LAYERS];
    csg_ground ground;
    tile_room **rooms; /* one per worker */
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

static void shade_ray(const scene_job *job, const csg_rays *rays, uint32_t i, float light[3])
{
    csg_surface surface = {
        .normal = {rays->nx[i], rays->ny[i], rays->nz[i]},
        .to_eye = {-rays->dx[i], -rays->dy[i], -rays->dz[i]},
        .color = {rays->r[i], rays->g[i], rays->b[i]},
        .metallic = rays->metallic[i],
        .roughness = rays->roughness[i],
        .open = rays->open[i],
        .lit = rays->lit[i],
    };
    csg_shade(&job->picture->lights, job->picture->curve, &surface, light);
}

static void shade_rays(const scene_job *job, tile_room *room)
{
    const csg_rays *rays = &room->trace.rays;
    for (uint32_t i = 0; i < room->count; i++) {
        memset(room->light[i], 0, sizeof room->light[i]);
        room->cover[i] = rays->t[i] < INFINITY ? rays->alpha[i] : rays->ground[i];
        if (!(rays->t[i] < INFINITY))
            continue;
        shade_ray(job, rays, i, room->light[i]);
        for (int c = 0; c < 3 && rays->alpha[i] < 1; c++)
            room->light[i][c] *= rays->alpha[i];
    }
}

/* ---- what is behind what is seen through ------------------------------------------------------ */

/* Rays that have met something clear go on from there, the others end. False: all have ended. */
static bool go_on(const scene_job *job, tile_room *room, csg_rays *rays)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        bool goes_on = rays->t[i] < INFINITY && rays->from[i] < INFINITY && rays->alpha[i] < 1 &&
                       1 - room->cover[i] > CSG_HARDLY_SEEN;
        rays->from[i] =
            goes_on ? rays->t[i] + csg_tracer_slack(&job->layers[0].tracer, rays, i) : INFINITY;
        rays->is_within[i] = goes_on;
        count += goes_on;
    }
    return count > 0;
}

/* What they see is laid behind what there is. */
static void lay_behind(const scene_job *job, tile_room *room, const csg_rays *rays)
{
    for (uint32_t i = 0; i < rays->count; i++) {
        if (!(rays->from[i] < INFINITY))
            continue;
        float light[3] = {0, 0, 0}, share = 1 - room->cover[i];
        bool is_hit = rays->t[i] < INFINITY;
        share *= is_hit ? rays->alpha[i] : rays->ground[i];
        if (is_hit)
            shade_ray(job, rays, i, light);
        for (int c = 0; c < 3; c++)
            room->light[i][c] += share * light[c];
        room->cover[i] += share;
    }
}

static void look_behind(const scene_job *job, tile_room *room)
{
    csg_rays *rays = &room->behind->rays;
    *rays = room->trace.rays;
    for (uint32_t i = 0; i < rays->count; i++)
        rays->known_lit[i] = -1;
    for (int surface = 1; surface < CSG_MOST_SURFACES && go_on(job, room, rays); surface++) {
        csg_tracer_trace(&job->layers[0].tracer, room->behind);
        csg_ground_trace(&job->ground, &job->layers[0].tracer, room->behind, &room->nodes, false);
        lay_behind(job, room, rays);
    }
}

/* ---- marks over it --------------------------------------------------------------------------- */

/* sRGB and opacity, about those of OpenSCAD's preview. */
static const float mark_looks[CSGM_MARK_COUNT][4] = {
    [CSGM_MARK_HIGHLIGHT] = {1.0f, 0.32f, 0.32f, 0.5f},
    [CSGM_MARK_BACKGROUND] = {0.65f, 0.65f, 0.65f, 0.5f}};

static void lay_over(const scene_job *job, tile_room *room, csgm_mark kind)
{
    const csg_rays *rays = &room->over->rays;
    const csg_picture *picture = job->picture;
    const float *look = mark_looks[kind], opacity = look[3];
    for (uint32_t i = 0; i < rays->count; i++) {
        float light[3];
        if (!(rays->t[i] < INFINITY) ||
            rays->t[i] >
                room->trace.rays.t[i] + csg_tracer_slack(&job->layers[1 + kind].tracer, rays, i))
            continue;
        csg_surface surface = {
            .normal = {rays->nx[i], rays->ny[i], rays->nz[i]},
            .to_eye = {-rays->dx[i], -rays->dy[i], -rays->dz[i]},
            .color = {look[0], look[1], look[2]},
            .roughness = 1,
            .open = 1,
            .lit = 1,
        };
        csg_shade(&picture->lights, picture->curve, &surface, light);
        for (int c = 0; c < 3; c++)
            room->light[i][c] += opacity * (light[c] - room->light[i][c]);
        room->cover[i] += opacity * (1 - room->cover[i]);
    }
}

/* ---- lines ------------------------------------------------------------------------------------ */

static csg_outline_point outline_point(const tile_room *room, const csg_view *view, uint32_t i)
{
    const csg_rays *rays = &room->trace.rays;
    float t = rays->t[i];
    csg_outline_point point = {.is_hit = t < INFINITY};
    if (!point.is_hit)
        return point;
    point.pixel = (float)view->pixel * (view->orthographic ? 1 : t);
    const float o[3] = {rays->ox[i], rays->oy[i], rays->oz[i]};
    const float d[3] = {rays->dx[i], rays->dy[i], rays->dz[i]};
    const float n[3] = {rays->nx[i], rays->ny[i], rays->nz[i]};
    for (int axis = 0; axis < 3; axis++) {
        point.at[axis] = o[axis] + t * d[axis];
        point.normal[axis] = n[axis];
    }
    return point;
}

/* Whether a line runs between two rays of the batch. */
static bool is_parted(const scene_job *job, const tile_room *room, uint32_t i, uint32_t k)
{
    const csg_view *view = &job->picture->view;
    csg_outline_point a = outline_point(room, view, i), b = outline_point(room, view, k);
    return csg_outline_between(&a, &b, CSG_OUTLINE_CREASE);
}

/* Of a pixel whose grid x grid rays begin with `first`, the outer ones on its border. */
static float line_in_pixel(const scene_job *job, const tile_room *room, uint32_t first,
                           uint32_t grid)
{
    uint32_t across = 0, down = 0;
    for (uint32_t y = 0; y < grid; y++)
        for (uint32_t x = 0; x + 1 < grid; x++) {
            uint32_t row = first + y * grid + x, column = first + x * grid + y;
            across += is_parted(job, room, row, row + 1);
            down += is_parted(job, room, column, column + grid);
        }
    return csg_outline_cover((float)across / (float)grid, (float)down / (float)grid);
}

/* ---- a batch --------------------------------------------------------------------------------- */

/* Rays for all pixels of a tile, or n x n for each of some of its edges. */
typedef struct batch {
    const tile *tile;
    uint32_t first_edge, end_edge; /* both 0: the tile */
} batch;

/* Rays of a pixel that gets more than one, along each side: in the middles of so many parts of it.
 * Where lines are looked for one more, from border to border, since neighbouring pixels must see
 * all that parts their rays; a little less, so that they stay in their row of pixels. */
static uint32_t grid_of(const scene_job *job)
{
    return job->picture->options->samples + job->picture->options->edges;
}

static double place_in_pixel(const scene_job *job, uint32_t i)
{
    const double inside = 1 - 1e-6;
    uint32_t n = job->picture->options->samples;
    return job->picture->options->edges ? i * (inside / n) : (i + 0.5) / n;
}

static void aim(const scene_job *job, const tile_room *room, const batch *b,
                const csg_tracer *tracer, csg_rays *rays)
{
    const tile *t = b->tile;
    uint32_t n = grid_of(job);
    csg_tracer_begin(rays, b->end_edge ? t->y0 : t->outer_y0);
    for (uint32_t e = b->first_edge; e < b->end_edge; e++)
        for (uint32_t s = 0; s < n * n; s++) {
            csg_tracer_aim(tracer, rays, t->x0 + room->edges[e] % TILE + place_in_pixel(job, s % n),
                           t->y0 + room->edges[e] / TILE + place_in_pixel(job, s / n));
            rays->known_lit[rays->count - 1] = room->edge_lit[e];
        }
    if (b->end_edge)
        return;
    for (uint32_t y = t->outer_y0; y < t->outer_y1; y++)
        for (uint32_t x = t->outer_x0; x < t->outer_x1; x++)
            csg_tracer_aim(tracer, rays, x + 0.5, y + 0.5);
}

static void trace_batch(const scene_job *job, tile_room *room, const batch *b)
{
    csg_rays *rays = &room->trace.rays;
    const csg_layer *layers = job->layers;
    const tile *t = b->tile;
    uint32_t n = grid_of(job);
    room->count = b->end_edge ? (b->end_edge - b->first_edge) * n * n
                              : (t->outer_x1 - t->outer_x0) * (t->outer_y1 - t->outer_y0);
    if (layers[0].field) {
        aim(job, room, b, &layers[0].tracer, rays);
        csg_tracer_trace(&layers[0].tracer, &room->trace);
        csg_ground_trace(&job->ground, &layers[0].tracer, &room->trace, &room->nodes, !b->end_edge);
    }
    for (uint32_t i = 0; i < room->count && !layers[0].field; i++) {
        rays->t[i] = INFINITY;
        rays->ground[i] = 0;
    }
    shade_rays(job, room);
    if (room->behind)
        look_behind(job, room);
    for (int i = CSG_LAYERS - 1; i > 0; i--) { /* the background first */
        if (!layers[i].field)
            continue;
        aim(job, room, b, &layers[i].tracer, &room->over->rays);
        csg_tracer_trace(&layers[i].tracer, room->over);
        lay_over(job, room, (csgm_mark)(i - 1));
    }
}

/* ---- one ray per pixel, and where that is not enough ------------------------------------------- */

static void trace_tile(const scene_job *job, tile_room *room, const tile *t)
{
    csg_ground_begin(&room->nodes, t->x0, t->y0);
    trace_batch(job, room, &(batch){.tile = t});
    for (uint32_t i = 0; i < room->count; i++)
        csg_shade_pixel(job->picture->curve, room->light[i], room->cover[i], 1,
                        job->picture->options->background, room->pixel[i]);
}

static bool differ(const scene_job *job, const tile_room *room, uint32_t i, uint32_t k)
{
    const uint8_t *a = room->pixel[i], *b = room->pixel[k];
    int most = 0;
    for (int c = 0; c < 4; c++) {
        int by = a[c] > b[c] ? a[c] - b[c] : b[c] - a[c];
        most = by > most ? by : most;
    }
    return most > EDGE_CONTRAST || (job->picture->options->edges && is_parted(job, room, i, k));
}

/* The share of the light that all around pixel x, y has which faces the light, or -1: it varies, or
 * nothing faces it. What one more ray would see is hardly anything else: shadows are soft. */
static float lit_around(const scene_job *job, const tile_room *room, const tile *t, uint32_t x,
                        uint32_t y)
{
    const csg_rays *rays = &room->trace.rays;
    const float *key = job->layers[0].tracer.light;
    float least = INFINITY, most = -INFINITY;
    for (uint32_t v = y ? y - 1 : 0; v <= y + 1 && v < t->outer_y1; v++)
        for (uint32_t u = x ? x - 1 : 0; u <= x + 1 && u < t->outer_x1; u++) {
            uint32_t i = (v - t->outer_y0) * (t->outer_x1 - t->outer_x0) + u - t->outer_x0;
            if (!(rays->t[i] < INFINITY) ||
                !(rays->nx[i] * key[0] + rays->ny[i] * key[1] + rays->nz[i] * key[2] > 0))
                continue;
            least = fminf(least, rays->lit[i]);
            most = fmaxf(most, rays->lit[i]);
        }
    return most - least <= SAME_LIGHT ? 0.5f * (least + most) : -1;
}

static void find_edges(const scene_job *job, tile_room *room, const tile *t)
{
    uint32_t width = t->outer_x1 - t->outer_x0;
    room->edge_count = 0;
    for (uint32_t y = t->y0; y < t->y1; y++)
        for (uint32_t x = t->x0; x < t->x1; x++) {
            uint32_t i = (y - t->outer_y0) * width + x - t->outer_x0;
            bool is_edge = (x > t->outer_x0 && differ(job, room, i, i - 1)) ||
                           (x + 1 < t->outer_x1 && differ(job, room, i, i + 1)) ||
                           (y > t->outer_y0 && differ(job, room, i, i - width)) ||
                           (y + 1 < t->outer_y1 && differ(job, room, i, i + width));
            memcpy(csg_picture_pixel(job->picture, x, y), room->pixel[i], 4);
            if (is_edge) {
                room->edge_lit[room->edge_count] =
                    job->layers[0].field ? lit_around(job, room, t, x, y) : -1;
                room->edges[room->edge_count++] = (uint16_t)(x - t->x0 + TILE * (y - t->y0));
            }
        }
}

static void resolve(const scene_job *job, tile_room *room, const tile *t, uint32_t first,
                    uint32_t end)
{
    uint32_t grid = grid_of(job), samples = grid * grid;
    for (uint32_t e = first, ray = 0; e < end; e++) {
        float light[3] = {0, 0, 0};
        float covered = 0, line = 0;
        if (job->picture->options->edges)
            line = line_in_pixel(job, room, ray, grid);
        for (uint32_t s = 0; s < samples; s++, ray++) {
            covered += room->cover[ray];
            for (int c = 0; c < 3; c++)
                light[c] += room->light[ray][c];
        }
        csg_outline_draw(line, (float)samples, light, &covered);
        uint32_t x = t->x0 + room->edges[e] % TILE, y = t->y0 + room->edges[e] / TILE;
        csg_shade_pixel(job->picture->curve, light, covered, samples,
                        job->picture->options->background, csg_picture_pixel(job->picture, x, y));
    }
}

static void refine_edges(const scene_job *job, tile_room *room, const tile *t)
{
    uint32_t grid = grid_of(job), at_once = CSG_RAYS_MOST / (grid * grid);
    for (uint32_t first = 0; first < room->edge_count; first += at_once) {
        uint32_t end = first + at_once < room->edge_count ? first + at_once : room->edge_count;
        trace_batch(job, room, &(batch){t, first, end});
        resolve(job, room, t, first, end);
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
    if (job->picture->options->samples > 1 || job->picture->options->edges)
        refine_edges(job, room, &t);
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------- */

/* The kernels' scratch must do for each layer. */
static bool create_trace_room(const scene_job *job, csg_trace_room *room)
{
    uint32_t depth = 0;
    for (int i = 0; i < CSG_LAYERS; i++)
        if (job->layers[i].field && job->layers[i].field->depth > depth)
            depth = job->layers[i].field->depth;
    room->scratch_floats = csg_kernel_scratch_floats(depth);
    room->scratch = csg_memory_alloc(&job->picture->context->memory,
                                     room->scratch_floats * sizeof *room->scratch);
    return room->scratch != NULL;
}

static void release_trace_room(csg_memory *memory, csg_trace_room *room)
{
    csg_memory_release(memory, room->scratch, room->scratch_floats * sizeof *room->scratch);
}

static bool create_other_room(const scene_job *job, csg_trace_room **out)
{
    csg_trace_room *room = *out = csg_memory_alloc(&job->picture->context->memory, sizeof *room);
    if (!room)
        return false;
    memset(room, 0, sizeof *room);
    return create_trace_room(job, room);
}

static bool create_room(const scene_job *job, tile_room **out)
{
    bool has_marks = job->layers[1].field || job->layers[2].field;
    tile_room *room = *out = csg_memory_alloc(&job->picture->context->memory, sizeof *room);
    if (!room)
        return false;
    memset(room, 0, sizeof *room);
    return create_trace_room(job, &room->trace) &&
           (!has_marks || create_other_room(job, &room->over)) &&
           (!job->layers[0].tracer.is_clear || create_other_room(job, &room->behind));
}

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
    for (uint32_t i = 0; i < job->room_count && done; i++)
        done = create_room(job, &job->rooms[i]);
    return done;
}

static void release_room(csg_memory *memory, tile_room *room)
{
    if (!room)
        return;
    release_trace_room(memory, &room->trace);
    csg_trace_room *others[] = {room->over, room->behind};
    for (int i = 0; i < 2; i++) {
        if (others[i])
            release_trace_room(memory, others[i]);
        csg_memory_release(memory, others[i], sizeof *others[i]);
    }
    csg_memory_release(memory, room, sizeof *room);
}

static void release_rooms(scene_job *job)
{
    csg_memory *memory = &job->picture->context->memory;
    for (uint32_t i = 0; job->rooms && i < job->room_count; i++)
        release_room(memory, job->rooms[i]);
    csg_memory_release(memory, job->rooms, job->room_count * sizeof *job->rooms);
}

static void add_counts(csgm_render_stats *stats, const csg_trace_counts *counts)
{
    stats->rays += counts->rays;
    stats->shadow_rays += counts->shadow_rays;
    stats->hits += counts->hits;
    stats->point_evaluations += counts->point_evaluations;
    stats->gradient_evaluations += counts->gradient_evaluations;
    stats->primitive_evaluations += counts->primitive_evaluations;
}

static void fill_stats(const scene_job *job, csgm_render_stats *stats)
{
    for (int k = 0; k < CSG_LAYERS; k++) {
        const csg_ray_cells *cells = &job->layers[k].cells;
        for (size_t i = 0; i < cells->count; i++)
            stats->cells += cells->cells[i].is_leaf && cells->cells[i].has_surface;
        stats->interval_evaluations += cells->interval_evaluations;
        stats->primitive_evaluations += cells->primitive_evaluations;
    }
    for (uint32_t i = 0; job->rooms && i < job->room_count; i++) {
        add_counts(stats, &job->rooms[i]->trace.counts);
        if (job->rooms[i]->over)
            add_counts(stats, &job->rooms[i]->over->counts);
        if (job->rooms[i]->behind)
            add_counts(stats, &job->rooms[i]->behind->counts);
    }
}

static csgm_status trace_all(scene_job *job, csgm_render_stats *stats)
{
    CSG_ZONE(job->picture->context, "trace rays");
    csg_picture *picture = job->picture;
    csgm_status status = csg_layers_prepare(job->layers, picture);
    if (status == CSGM_OK && !create_rooms(job))
        status = csg_context_no_memory(picture->context);
    for (int i = 0; i < CSG_LAYERS && status == CSGM_OK; i++)
        if (job->layers[i].field)
            csg_tracer_find_slope(&job->layers[i].tracer, &job->rooms[0]->trace);
    if (status == CSGM_OK && job->layers[0].field)
        status = csg_ground_find(&job->ground, picture, &job->layers[0].tracer,
                                 job->layers[0].bounds, &job->rooms[0]->trace);
    stats->prepare_s = csg_clock_now_s() - picture->started_s;
    job->columns = (picture->image->width + TILE - 1) / TILE;
    job->rows = (picture->image->height + TILE - 1) / TILE;
    if (status == CSGM_OK && !csg_pool_run(picture->context->pool, (size_t)job->columns * job->rows,
                                           draw_tile, csg_picture_poll, job))
        status = csg_picture_why_stopped(picture);
    if (status == CSGM_OK)
        fill_stats(job, stats);
    release_rooms(job);
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
    const csg_layer *solid = &job->layers[0];
    bool has_any = false;
    for (int i = 0; i < CSG_LAYERS; i++)
        has_any = has_any || job->layers[i].field;
    if (!has_any) {
        draw_background(picture);
        return CSGM_OK;
    }
    if (options->slice_axis >= 0)
        return csg_render_slice(picture, solid->field, solid->bounds, stats);
    if (options->evaluator == CSGM_EVALUATOR_LAZY)
        return csg_render_lazy(picture, solid->field, solid->bounds, stats);
    return trace_all(job, stats);
}

/* Sections and the evaluator that counts are of the solid alone. */
static csgm_status make_layers(scene_job *job, csgm_context *context, const csgm_field *field,
                               const csgm_render_options *options)
{
    csgm_status status = csg_layer_of_solid(&job->layers[0], context, field, options);
    bool shows_marks = options->slice_axis < 0 && options->evaluator == CSGM_EVALUATOR_FAST;
    if (status == CSGM_OK && shows_marks)
        status = csg_layers_of_marks(job->layers, context, field->scene, options);
    return status;
}

csgm_status csg_render_scene(csgm_context *context, const csgm_field *field,
                             const csgm_render_options *options, csgm_image **out,
                             csgm_render_stats *stats)
{
    CSG_ZONE(context, "render scene");
    csg_picture picture = {.context = context};
    scene_job job = {.picture = &picture};
    csg_box bounds = csg_box_empty();
    *stats = (csgm_render_stats){0};
    csgm_status status = make_layers(&job, context, field, options);
    for (int i = 0; i < CSG_LAYERS; i++)
        if (job.layers[i].field)
            bounds = csg_box_hull(bounds, job.layers[i].bounds);
    if (status == CSGM_OK)
        status = csg_picture_begin(&picture, context, options, bounds);
    if (status == CSGM_OK)
        status = draw(&job, stats);
    if (status == CSGM_OK && !stats->hits && options->slice_axis < 0)
        csg_diag_plain(&context->diags, CSG_DIAG_NO_SURFACE, NULL,
                       "the camera may look past the solid", "nothing of the solid is in sight");
    for (int i = 0; i < CSG_LAYERS; i++)
        csg_layer_release(&job.layers[i], context);
    stats->trace_s = csg_clock_now_s() - picture.started_s - stats->prepare_s;
    stats->memory_peak_bytes = atomic_load(&context->memory.peak_bytes);
    return csg_picture_end(&picture, status, out);
}
