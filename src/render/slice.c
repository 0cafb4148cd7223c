/* SPDX-License-Identifier: MIT
 * The section of a field by a plane at right angles to an axis: warm inside, cool outside, the
 * surface drawn thick and iso-lines of f thin, every fifth one stronger. A line's distance from a
 * pixel is the field's difference to it over the slope in the plane, so that lines are as wide
 * everywhere. Each tile drops, before it is drawn, the operands that others hide all over it, which
 * changes no bit (field/prune/prune.h).
 */
#include <string.h>

#include "base/clock.h"
#include "base/trace.h"
#include "field/kernels/dispatch.h"
#include "field/prune/prune.h"
#include "render/job.h"

enum { TILE = 32, POINTS = TILE * TILE, LINES = 20, STRONG_LINE = 5 };

typedef struct slice_room {
    float x[POINTS], y[POINTS], z[POINTS], f[POINTS];
    float gx[POINTS], gy[POINTS], gz[POINTS];
    csg_pruner pruner;
    csg_arena tapes;
    float *scratch;
    size_t scratch_floats;
    uint64_t points, intervals, primitives;
} slice_room;

typedef struct slice_job {
    csg_picture *picture;
    const csgm_field *field;
    const csg_kernel *kernel;
    slice_room **rooms;
    uint32_t room_count, columns;
    double range, step; /* of f: where colours end; between lines */
    float rounding;
} slice_job;

csgm_camera csg_slice_camera(const csgm_render_options *options)
{
    csgm_camera camera = options->camera;
    camera.projection = CSGM_ORTHOGRAPHIC;
    camera.placed = false;
    camera.azimuth_deg = options->slice_axis == 0 ? 90 : 0;
    camera.elevation_deg = options->slice_axis == 2 ? 90 : 0;
    camera.zoom *= 0.8; /* room for the field around the solid */
    return camera;
}

/* ---- colours --------------------------------------------------------------------------------- */

static float mix(float a, float b, float share)
{
    return a + (b - a) * share;
}

/* 1 on the line, 0 away from it, one pixel of slope. */
static float line(float pixels, float half_width)
{
    float cover = half_width + 0.5f - pixels;
    return cover > 0 ? cover < 1 ? cover : 1 : 0;
}

static void color_of(const slice_job *job, float f, float slope, uint8_t pixel[4])
{
    static const float inside[2][3] = {{1.0f, 0.93f, 0.80f}, {0.80f, 0.36f, 0.10f}};
    static const float outside[2][3] = {{0.93f, 0.96f, 0.99f}, {0.22f, 0.42f, 0.66f}};
    const float(*ramp)[3] = f >= 0 ? inside : outside;
    float step = (float)job->step, size = f < 0 ? -f : f;
    float share = size / (float)job->range;
    share = share < 1 ? share : 1;
    float nearest = floorf(size / step + 0.5f);
    float per_pixel = slope * (float)job->picture->view.pixel;
    float away = (size - nearest * step) / per_pixel;
    bool is_strong = fmodf(nearest, STRONG_LINE) == 0;
    /* Where lines crowd closer than some pixels they fade. */
    float crowd = step / per_pixel / 6;
    float iso = line(away < 0 ? -away : away, is_strong ? 0.45f : 0.1f) *
                (is_strong ? 0.6f : 0.35f) * (crowd < 1 ? crowd : 1);
    float surface = line(size / per_pixel, 1.0f);
    for (int c = 0; c < 3; c++) {
        float value = mix(mix(mix(ramp[0][c], ramp[1][c], share), 0.1f, iso), 0.04f, surface);
        pixel[c] = (uint8_t)(255 * value + 0.5f);
    }
    pixel[3] = 255;
}

/* ---- tiles ----------------------------------------------------------------------------------- */

/* Points of a tile, in the field's frame; returns how many. */
static uint32_t place(const slice_job *job, slice_room *room, uint32_t x0, uint32_t y0, uint32_t x1,
                      uint32_t y1)
{
    const csg_picture *picture = job->picture;
    const csgm_render_options *options = picture->options;
    uint32_t count = 0;
    for (uint32_t y = y0; y < y1; y++)
        for (uint32_t x = x0; x < x1; x++, count++) {
            csg_vec3 p, direction;
            csg_view_ray(&picture->view, x + 0.5, y + 0.5, &p, &direction);
            *(options->slice_axis == 0   ? &p.x
              : options->slice_axis == 1 ? &p.y
                                         : &p.z) = options->slice_at;
            p = csg_vec3_sub(p, job->field->center);
            room->x[count] = (float)p.x;
            room->y[count] = (float)p.y;
            room->z[count] = (float)p.z;
        }
    for (uint32_t i = count; i % CSG_LANES; i++)
        room->x[i] = room->y[i] = room->z[i] = 0;
    return count;
}

/* The field's tape without what cannot matter in the tile. False: out of memory. */
static bool shorten(const slice_job *job, slice_room *room, uint32_t count, csg_tape *out)
{
    float c[3], radius = 0;
    const float *const at[3] = {room->x, room->y, room->z};
    for (int axis = 0; axis < 3; axis++) {
        c[axis] = (at[axis][0] + at[axis][count - 1]) / 2;
        radius = fmaxf(radius, fabsf(at[axis][0] - c[axis]));
    }
    room->intervals += CSG_OCTANTS;
    return csg_prune_cube(&room->pruner, &job->field->tape, c, radius * 1.7320510f) &&
           csg_prune_shorten(&room->pruner, 0, 1e30f, &room->tapes, out);
}

static void paint(const slice_job *job, const slice_room *room, uint32_t x0, uint32_t y0,
                  uint32_t x1, uint32_t y1)
{
    int axis = job->picture->options->slice_axis;
    uint32_t i = 0;
    for (uint32_t y = y0; y < y1; y++)
        for (uint32_t x = x0; x < x1; x++, i++) {
            float gx = axis == 0 ? 0 : room->gx[i], gy = axis == 1 ? 0 : room->gy[i],
                  gz = axis == 2 ? 0 : room->gz[i];
            float slope = sqrtf(gx * gx + gy * gy + gz * gz);
            color_of(job, room->f[i], slope > 1e-6f ? slope : 1e-6f,
                     csg_picture_pixel(job->picture, x, y));
        }
}

static bool draw_tile(void *user, uint32_t worker, size_t index)
{
    slice_job *job = user;
    slice_room *room = job->rooms[worker];
    const csgm_image *image = job->picture->image;
    uint32_t x0 = (uint32_t)(index % job->columns) * TILE,
             y0 = (uint32_t)(index / job->columns) * TILE;
    uint32_t x1 = x0 + TILE < image->width ? x0 + TILE : image->width;
    uint32_t y1 = y0 + TILE < image->height ? y0 + TILE : image->height;
    csg_tape tape;
    if (csg_picture_should_stop(job->picture))
        return false;
    uint32_t count = place(job, room, x0, y0, x1, y1);
    csg_arena_mark mark = csg_arena_get_mark(&room->tapes);
    if (!shorten(job, room, count, &tape)) {
        atomic_store(&job->picture->out_of_memory, true);
        return false;
    }
    job->kernel->values(&tape, room->x, room->y, room->z, count, room->f, room->scratch,
                        room->scratch_floats);
    job->kernel->gradients(&tape, room->x, room->y, room->z, count, room->gx, room->gy, room->gz,
                           room->scratch, room->scratch_floats);
    paint(job, room, x0, y0, x1, y1);
    room->points += count;
    for (uint32_t i = 0; i < tape.count; i++)
        room->primitives += csg_op_is_leaf(tape.nodes[i].op) ? 2 * (uint64_t)count : 0;
    csg_arena_release_to(&room->tapes, mark);
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool create_rooms(slice_job *job)
{
    csg_memory *memory = &job->picture->context->memory;
    job->room_count = csg_pool_threads(job->picture->context->pool);
    job->rooms = csg_memory_alloc(memory, job->room_count * sizeof *job->rooms);
    if (!job->rooms)
        return false;
    memset(job->rooms, 0, job->room_count * sizeof *job->rooms);
    for (uint32_t i = 0; i < job->room_count; i++) {
        slice_room *room = job->rooms[i] = csg_memory_alloc(memory, sizeof *room);
        if (!room)
            return false;
        memset(room, 0, sizeof *room);
        csg_pruner_init(&room->pruner, memory, job->kernel, job->rounding);
        csg_arena_init(&room->tapes, memory);
        room->scratch_floats = csg_kernel_scratch_floats(job->field->depth);
        room->scratch = csg_memory_alloc(memory, room->scratch_floats * sizeof(float));
        if (!room->scratch)
            return false;
    }
    return true;
}

static void release_rooms(slice_job *job, csgm_render_stats *stats)
{
    csg_memory *memory = &job->picture->context->memory;
    for (uint32_t i = 0; job->rooms && i < job->room_count && job->rooms[i]; i++) {
        slice_room *room = job->rooms[i];
        stats->point_evaluations += room->points;
        stats->gradient_evaluations += room->points;
        stats->interval_evaluations += room->intervals;
        stats->primitive_evaluations += room->primitives;
        csg_pruner_release(&room->pruner);
        csg_arena_reset(&room->tapes);
        csg_memory_release(memory, room->scratch, room->scratch_floats * sizeof(float));
        csg_memory_release(memory, room, sizeof *room);
    }
    csg_memory_release(memory, job->rooms, job->room_count * sizeof *job->rooms);
}

/* 1, 2 or 5 times a power of ten, not above. */
static double round_step(double step)
{
    double ten = 1;
    while (ten * 10 <= step && ten < 1e30)
        ten *= 10;
    while (ten > step && ten > 1e-30)
        ten /= 10;
    return ten * 5 <= step ? ten * 5 : ten * 2 <= step ? ten * 2 : ten;
}

csgm_status csg_render_slice(csg_picture *picture, const csgm_field *field, csg_box bounds,
                             csgm_render_stats *stats)
{
    CSG_ZONE(picture->context, "section");
    csgm_context *context = picture->context;
    csg_vec3 size = csg_box_size(bounds);
    double half_height = picture->view.pixel * picture->view.height / 2;
    double extent = csg_vec3_norm(size) + half_height * 4 + fabs(picture->options->slice_at);
    slice_job job = {.picture = picture,
                     .field = field,
                     .kernel = csg_kernel_for(context->isa),
                     .range = fmax(half_height, 1e-30),
                     .columns = (picture->image->width + TILE - 1) / TILE,
                     .rounding = (float)(extent * 0x1p-18)};
    job.step = picture->options->iso_step > 0 ? picture->options->iso_step
                                              : round_step(2 * job.range / LINES);
    size_t tiles = (size_t)job.columns * ((picture->image->height + TILE - 1) / TILE);
    csgm_status status = create_rooms(&job) ? CSGM_OK : csg_context_no_memory(context);
    if (status == CSGM_OK && !csg_pool_run(context->pool, tiles, draw_tile, csg_picture_poll, &job))
        status = csg_picture_why_stopped(picture);
    release_rooms(&job, stats);
    return status;
}
