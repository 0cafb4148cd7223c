/* SPDX-License-Identifier: MIT
 * Shadows of triangles on the ground; see ground_map.h.
 */
#include "render/ground_map.h"

static const size_t TABLE_BYTES = sizeof(float) * CSG_GROUND_SIDE * CSG_GROUND_SIDE;
static const double LOWEST_LIGHT = 0.05; /* sine, below which shadows would have no end */

typedef struct map_job {
    csg_picture *picture;
    const csg_mesh_light *light;
    csg_ground_map *out;
} map_job;

static bool ground_row(void *user, uint32_t worker, size_t row)
{
    const map_job *job = user;
    const csg_ground_map *map = job->out;
    const csg_vec3 up = {0, 0, 1};
    (void)worker;
    if (csg_picture_should_stop(job->picture))
        return false;
    for (size_t i = 0; i < CSG_GROUND_SIDE; i++) {
        csg_vec3 at =
            csg_vec3_make(map->x + (double)i * map->step, map->y + (double)row * map->step, map->z);
        map->darkness[row * CSG_GROUND_SIDE + i] =
            csg_ground_darkness(job->picture->options, csg_mesh_light_key(job->light, at, up),
                                csg_mesh_light_sky(job->light, at));
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

bool csg_ground_map_is_wanted(const csg_picture *picture, csg_box box)
{
    return csg_mesh_light_is_cast(box) && (double)picture->lights.key[2] >= LOWEST_LIGHT &&
           csg_ground_is_seen(picture->options, &picture->view, box.min.z);
}

csgm_status csg_ground_map_make(csg_ground_map *out, csg_picture *picture,
                                const csg_mesh_light *light, csg_box box)
{
    csgm_context *context = picture->context;
    map_job job = {.picture = picture, .light = light, .out = out};
    *out = (csg_ground_map){.darkness = NULL};
    place_table(out, picture, box, light->widest);
    out->darkness = csg_memory_alloc(&context->memory, TABLE_BYTES);
    if (!out->darkness)
        return csg_context_no_memory(context);
    if (csg_pool_run(context->pool, CSG_GROUND_SIDE, ground_row, NULL, &job))
        return CSGM_OK;
    return csg_picture_why_stopped(picture);
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
