/* SPDX-License-Identifier: MIT
 * A z-buffer for shadows; see depth_map.h. Unlike that of pictures (raster.c) it needs to know no
 * triangle, so it sorts none: most of a fine mesh's contain no place's middle and are passed over.
 * Places on an edge belong to both of its triangles.
 */
#include "render/depth_map.h"

enum { TRIANGLES_PER_ITEM = 1 << 13 };

typedef struct draw_job {
    csg_picture *picture;
    const csgm_mesh_view *mesh;
    const csg_depth_map *maps; /* of points without the mesh's origin */
    size_t map_count;
} draw_job;

csg_depth_map csg_depth_map_along(csg_vec3 forward, csg_vec3 up, csg_box box, uint32_t side)
{
    double diagonal = csg_vec3_norm(csg_box_size(box)), place = 1.01 * diagonal / side;
    csg_vec3 center = csg_box_center(box);
    csg_vec3 right = csg_vec3_normalize(csg_vec3_cross(forward, up));
    csg_vec3 down = csg_vec3_cross(forward, right);
    csg_depth_map map = {.side = side,
                         .place = place,
                         .x = csg_vec3_scale(right, 1 / place),
                         .y = csg_vec3_scale(down, 1 / place),
                         .away = forward,
                         .farthest = INFINITY};
    map.x0 = 0.5 * side - csg_vec3_dot(map.x, center);
    map.y0 = 0.5 * side - csg_vec3_dot(map.y, center);
    map.away0 = diagonal - csg_vec3_dot(forward, center);
    return map;
}

static size_t places_of(const csg_depth_map *map)
{
    return (size_t)map->side * map->side;
}

void csg_depth_map_release(csg_depth_map *map, csgm_context *context)
{
    csg_memory_release(&context->memory, map->nearest, places_of(map) * sizeof *map->nearest);
    map->nearest = NULL;
}

/* Bits of floats that are not negative are ordered as these are. */
static unsigned bits_of(float distance)
{
    unsigned bits;
    memcpy(&bits, &distance, sizeof bits);
    return bits;
}

static void keep_nearest(atomic_uint *at, float distance)
{
    unsigned bits = bits_of(distance), now = atomic_load_explicit(at, memory_order_relaxed);
    while (bits < now && !atomic_compare_exchange_weak_explicit(
                             at, &now, bits, memory_order_relaxed, memory_order_relaxed))
        ;
}

static double least_of(double a, double b)
{
    return a < b ? a : b;
}

static double most_of(double a, double b)
{
    return a > b ? a : b;
}

/* Places whose middles lie from the least to below the greatest of three: [*first, *end). False:
 * there are none, as for most triangles of a fine mesh. */
static bool places_between(double a, double b, double c, uint32_t side, uint32_t *first,
                           uint32_t *end)
{
    double low = least_of(least_of(a, b), c), high = most_of(most_of(a, b), c);
    *first = (uint32_t)(most_of(least_of(low, side), 0) + 0.5);
    *end = (uint32_t)(most_of(least_of(high, side - 0.5), -0.5) + 0.5);
    return *first < *end;
}

/* Twice the area of two corners and a place, per place along x and y, and at 0, 0; divided by that
 * of the triangle, so that it is a share. */
typedef struct share {
    double x, y, at;
} share;

static share share_of(const csg_vec3 *from, const csg_vec3 *to, double area2)
{
    share s = {(from->y - to->y) / area2, (to->x - from->x) / area2, 0};
    s.at = -(s.x * from->x + s.y * from->y);
    return s;
}

static void fill(const csg_depth_map *map, const csg_vec3 c[3], const uint32_t range[4])
{
    const double inside = -1e-9; /* rounding leaves no gap along an edge */
    double area2 = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    double least = least_of(least_of(c[0].z, c[1].z), c[2].z);
    double most = most_of(most_of(c[0].z, c[1].z), c[2].z);
    share s[3];
    for (int i = 0; i < 3; i++)
        s[i] = share_of(&c[(i + 1) % 3], &c[(i + 2) % 3], area2);
    if (!isfinite(s[0].at + s[1].at + s[2].at)) /* seen from its edge */
        return;
    for (uint32_t y = range[1]; y < range[3]; y++)
        for (uint32_t x = range[0]; x < range[2]; x++) {
            double w[3], z = 0;
            for (int i = 0; i < 3; i++) {
                w[i] = s[i].x * (x + 0.5) + s[i].y * (y + 0.5) + s[i].at;
                z += w[i] * c[i].z;
            }
            if (w[0] >= inside && w[1] >= inside && w[2] >= inside)
                keep_nearest(&map->nearest[(size_t)y * map->side + x],
                             (float)least_of(most_of(z, least), most));
        }
}

static void draw_triangle(const csg_depth_map *map, const csg_vec3 corner[3])
{
    csg_vec3 c[3];
    uint32_t range[4];
    for (int i = 0; i < 3; i++)
        c[i].z = csg_vec3_dot(map->away, corner[i]) + map->away0;
    if (c[0].z > map->farthest && c[1].z > map->farthest && c[2].z > map->farthest)
        return;
    for (int i = 0; i < 3; i++)
        c[i].x = csg_vec3_dot(map->x, corner[i]) + map->x0;
    if (!places_between(c[0].x, c[1].x, c[2].x, map->side, &range[0], &range[2]))
        return;
    for (int i = 0; i < 3; i++)
        c[i].y = csg_vec3_dot(map->y, corner[i]) + map->y0;
    if (places_between(c[0].y, c[1].y, c[2].y, map->side, &range[1], &range[3]))
        fill(map, c, range);
}

static bool draw_item(void *user, uint32_t worker, size_t item)
{
    const draw_job *job = user;
    const csgm_mesh_view *mesh = job->mesh;
    uint64_t first = (uint64_t)item * TRIANGLES_PER_ITEM, end = first + TRIANGLES_PER_ITEM;
    (void)worker;
    if (csg_picture_should_stop(job->picture))
        return false;
    for (uint64_t t = first; t < end && t < mesh->triangle_count; t++) {
        const uint32_t *index = mesh->indices + 3 * t;
        csg_vec3 corner[3];
        if (index[0] >= mesh->vertex_count || index[1] >= mesh->vertex_count ||
            index[2] >= mesh->vertex_count)
            continue;
        for (int i = 0; i < 3; i++)
            corner[i] = csg_vec3_from_floats(mesh->positions + 3 * (size_t)index[i]);
        for (size_t k = 0; k < job->map_count; k++)
            draw_triangle(&job->maps[k], corner);
    }
    return true;
}

static csgm_status draw_all(draw_job *job)
{
    uint64_t count = job->mesh->triangle_count;
    size_t items = (size_t)((count + TRIANGLES_PER_ITEM - 1) / TRIANGLES_PER_ITEM);
    for (size_t k = 0; k < job->map_count; k++)
        for (size_t i = 0; i < places_of(&job->maps[k]); i++)
            atomic_init(&job->maps[k].nearest[i], bits_of(INFINITY));
    if (csg_pool_run(job->picture->context->pool, items, draw_item, NULL, job))
        return CSGM_OK;
    return csg_picture_why_stopped(job->picture);
}

csgm_status csg_depth_maps_draw(csg_depth_map *maps, size_t count, csg_picture *picture,
                                const csgm_mesh_view *mesh)
{
    csg_memory *memory = &picture->context->memory;
    bool has_room = true;
    for (size_t k = 0; k < count; k++) {
        maps[k].nearest = csg_memory_alloc(memory, places_of(&maps[k]) * sizeof *maps[k].nearest);
        has_room = has_room && maps[k].nearest;
    }
    csg_depth_map local[CSG_DEPTH_MAPS];
    for (size_t k = 0; k < count; k++) {
        csg_vec3 at = csg_depth_map_project(&maps[k], mesh->origin);
        local[k] = maps[k];
        local[k].x0 = at.x;
        local[k].y0 = at.y;
        local[k].away0 = at.z;
    }
    draw_job job = {.picture = picture, .mesh = mesh, .maps = local, .map_count = count};
    return has_room ? draw_all(&job) : csg_context_no_memory(picture->context);
}
