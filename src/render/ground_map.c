/* SPDX-License-Identifier: MIT
 * Shadows of triangles on the ground; see ground_map.h.
 */
#include "render/ground_map.h"

#include <string.h>

#include "render/draw.h"

enum {
    MAP_TILES = 8, /* of the z-buffer, along each side */
    MAP_SIDE = MAP_TILES * CSG_DRAW_TILE,
    RINGS = 6, /* of places around one that are looked at: 1 + 6 + 12 + ... */
    LOOKS = 1 + 3 * RINGS * (RINGS + 1),
    FEWER = 3 /* of which one is looked at where a mean of distances is wanted */
};

static const size_t TABLE_BYTES = sizeof(float) * CSG_GROUND_SIDE * CSG_GROUND_SIDE;
static const double SOFTNESS = 0.11;     /* half the light's width over its distance */
static const double WIDEST = 1.0 / 16;   /* of the box's diagonal: the most that is blurred */
static const double LOWEST_LIGHT = 0.05; /* sine, below which shadows would have no end */

typedef struct map_job {
    csg_picture *picture;
    const csgm_mesh_view *mesh;
    csg_draw draw; /* from the light, or from below */
    csg_view view;
    csg_ground_map *out;
    float *nearness; /* MAP_SIDE^2 */
    double widest;
    double look[LOOKS][2]; /* places in the unit disc */
} map_job;

/* Parallel to a direction, all of the box; distances are along it, from before the box. */
static csg_view view_along(csg_vec3 forward, csg_vec3 up, csg_box box)
{
    csg_view view = {.orthographic = true, .width = MAP_SIDE, .height = MAP_SIDE};
    double diagonal = csg_vec3_norm(csg_box_size(box));
    view.forward = forward;
    view.right = csg_vec3_normalize(csg_vec3_cross(forward, up));
    view.up = csg_vec3_cross(view.right, forward);
    view.eye = csg_vec3_sub(csg_box_center(box), csg_vec3_scale(forward, diagonal));
    view.pixel = 1.01 * diagonal / MAP_SIDE;
    return view;
}

/* Rings of points, each the same share of the disc. */
static void make_looks(double look[LOOKS][2])
{
    int count = 0;
    for (int ring = 0; ring <= RINGS; ring++)
        for (int i = 0; i < (ring ? 6 * ring : 1); i++, count++) {
            double s = 0, c = 1, radius = (double)ring / RINGS;
            if (ring)
                csg_view_sine_cosine(60.0 * i / ring + 23.0 * ring, &s, &c);
            look[count][0] = radius * c;
            look[count][1] = radius * s;
        }
}

/* ---- from the light --------------------------------------------------------------------------- */

static bool map_tile(void *user, uint32_t worker, size_t index)
{
    csg_draw *draw = user;
    map_job *job = (map_job *)((char *)draw - offsetof(map_job, draw));
    if (csg_picture_should_stop(draw->picture))
        return false;
    uint32_t column = (uint32_t)(index % MAP_TILES), row = (uint32_t)(index / MAP_TILES);
    csg_draw_fill(draw, draw->rooms[worker], column, row);
    for (size_t y = 0; y < CSG_DRAW_TILE; y++)
        memcpy(job->nearness + (row * CSG_DRAW_TILE + y) * MAP_SIDE + column * CSG_DRAW_TILE,
               draw->rooms[worker]->nearness + y * CSG_DRAW_TILE, CSG_DRAW_TILE * sizeof(float));
    return true;
}

/* The depth of what is seen at a place of the map; INFINITY: nothing. */
static double depth_at(const map_job *job, double x, double y)
{
    if (!(x >= 0 && y >= 0 && x < MAP_SIDE && y < MAP_SIDE))
        return INFINITY;
    return -(double)job->nearness[(size_t)y * MAP_SIDE + (size_t)x];
}

/* ---- on the ground ---------------------------------------------------------------------------- */

/* How far before a place of the ground something stands in the light; 0: nothing does. */
static double distance_before(const map_job *job, double x, double y, double depth)
{
    double distance = depth - depth_at(job, x, y);
    return distance > 2 * job->view.pixel ? distance : 0;
}

/* The share of the key light that arrives: what is before the ground nearby tells how far the
 * shadow's edge is blurred, and that how much of it is dark. */
static float lit_at(const map_job *job, csg_vec3 at)
{
    double widest = job->widest / job->view.pixel, sum = 0;
    int blockers = 0, dark = 0;
    for (int i = 0; i < LOOKS; i += FEWER) {
        double distance = distance_before(job, at.x + widest * job->look[i][0],
                                          at.y + widest * job->look[i][1], at.z);
        sum += distance;
        blockers += distance > 0;
    }
    if (!blockers)
        return 1;
    double radius = fmin(SOFTNESS * sum / blockers / job->view.pixel, widest);
    radius = fmax(radius, 1); /* a step of the map */
    for (int i = 0; i < LOOKS; i++)
        dark += distance_before(job, at.x + radius * job->look[i][0],
                                at.y + radius * job->look[i][1], at.z) > 0;
    return 1 - (float)dark / LOOKS;
}

/* The share of the sky that is seen: the lower something is above the ground nearby, the more of it
 * is hidden. The view is from below, and the ground is before what stands on it. */
static float open_at(const map_job *job, csg_vec3 at)
{
    double widest = job->widest / job->view.pixel, hidden = 0;
    for (int i = 0; i < LOOKS; i += FEWER) {
        double depth =
            depth_at(job, at.x + widest * job->look[i][0], at.y + widest * job->look[i][1]);
        hidden += fmax(1 - (depth - at.z) / job->widest, 0);
    }
    return 1 - (float)(fmin(hidden * FEWER / LOOKS, 1));
}

static bool ground_row(void *user, uint32_t worker, size_t row)
{
    const map_job *job = user;
    const csg_ground_map *map = job->out;
    (void)worker;
    if (csg_picture_should_stop(job->picture))
        return false;
    for (size_t i = 0; i < CSG_GROUND_SIDE; i++) {
        csg_vec3 place =
            csg_vec3_make(map->x + (double)i * map->step, map->y + (double)row * map->step, map->z);
        csg_vec3 at = csg_view_project(&job->view, place);
        bool is_light = job->view.forward.z < 0;
        map->darkness[row * CSG_GROUND_SIDE + i] += csg_ground_darkness(
            job->picture->options, is_light ? lit_at(job, at) : 1, is_light ? 1 : open_at(job, at));
    }
    return true;
}

/* The box and where its upper side's shadow falls. */
static void place_table(csg_ground_map *map, const csg_picture *picture, csg_box box, double around)
{
    const float *key = picture->lights.key;
    double shift = (box.max.z - box.min.z) / (double)key[2];
    double x = -shift * (double)key[0], y = -shift * (double)key[1];
    double width = box.max.x - box.min.x + fabs(x), depth = box.max.y - box.min.y + fabs(y);
    map->z = box.min.z;
    map->x = box.min.x + fmin(x, 0) - around;
    map->y = box.min.y + fmin(y, 0) - around;
    map->step = (fmax(width, depth) + 2 * around) / (CSG_GROUND_SIDE - 1);
}

/* Adds what the key light (from above) or the sky leaves dark; `look` is filled. */
static csgm_status add_light(map_job *job, csg_vec3 forward, csg_vec3 up, csg_box box)
{
    csgm_render_stats ignored;
    job->view = view_along(forward, up, box);
    job->draw = (csg_draw){.picture = job->picture,
                           .view = &job->view,
                           .mesh = job->mesh,
                           .samples = 1,
                           .columns = MAP_TILES,
                           .rows = MAP_TILES};
    csgm_status status = csg_draw_run(&job->draw, map_tile, &ignored);
    if (status == CSGM_OK &&
        !csg_pool_run(job->picture->context->pool, CSG_GROUND_SIDE, ground_row, NULL, job))
        status = csg_picture_why_stopped(job->picture);
    return status;
}

static csgm_status fill(map_job *job, csg_box box)
{
    const csgm_render_options *options = job->picture->options;
    csgm_status status = CSGM_OK;
    make_looks(job->look);
    if (options->shadows)
        status = add_light(job, csg_vec3_scale(csg_vec3_from_floats(job->picture->lights.key), -1),
                           job->picture->view.up, box);
    if (status == CSGM_OK && options->occlusion)
        status = add_light(job, csg_vec3_make(0, 0, 1), csg_vec3_make(0, 1, 0), box);
    return status;
}

csgm_status csg_ground_map_make(csg_ground_map *out, csg_picture *picture,
                                const csgm_mesh_view *mesh, csg_box box)
{
    csgm_context *context = picture->context;
    *out = (csg_ground_map){.darkness = NULL};
    if (!csg_box_is_finite(box) || csg_box_is_empty(box) ||
        !(csg_vec3_norm(csg_box_size(box)) > 0) || (double)picture->lights.key[2] < LOWEST_LIGHT ||
        !csg_ground_is_seen(picture->options, &picture->view, box.min.z))
        return CSGM_OK;
    map_job job = {.picture = picture, .mesh = mesh, .out = out};
    job.widest = WIDEST * csg_vec3_norm(csg_box_size(box));
    place_table(out, picture, box, job.widest);
    size_t bytes = sizeof(float) * MAP_SIDE * MAP_SIDE;
    job.nearness = csg_memory_alloc(&context->memory, bytes);
    out->darkness = csg_memory_alloc(&context->memory, TABLE_BYTES);
    bool has_room = job.nearness && out->darkness;
    if (has_room)
        memset(out->darkness, 0, TABLE_BYTES);
    csgm_status status = has_room ? fill(&job, box) : csg_context_no_memory(context);
    csg_memory_release(&context->memory, job.nearness, bytes);
    return status;
}

void csg_ground_map_release(csg_ground_map *map, csgm_context *context)
{
    csg_memory_release(&context->memory, map->darkness, TABLE_BYTES);
}

float csg_ground_map_at(const csg_ground_map *map, csg_vec3 origin, csg_vec3 direction)
{
    double t = (map->z - origin.z) / direction.z;
    if (!map->darkness || !(direction.z < 0) || !(t > 0))
        return 0;
    double x = (origin.x + t * direction.x - map->x) / map->step;
    double y = (origin.y + t * direction.y - map->y) / map->step;
    if (!(x >= 0 && y >= 0 && x < CSG_GROUND_SIDE - 1 && y < CSG_GROUND_SIDE - 1))
        return 0;
    size_t column = (size_t)x, row = (size_t)y;
    const float *at = map->darkness + row * CSG_GROUND_SIDE + column;
    float u = (float)(x - (double)column), v = (float)(y - (double)row);
    float above = at[0] + u * (at[1] - at[0]);
    float below = at[CSG_GROUND_SIDE] + u * (at[CSG_GROUND_SIDE + 1] - at[CSG_GROUND_SIDE]);
    return above + v * (below - above);
}
