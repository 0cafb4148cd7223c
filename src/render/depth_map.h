/* SPDX-License-Identifier: MIT
 * How far away a mesh is in each direction parallel to one: from the light, or from below. All
 * threads draw triangles into one map, whose places keep the least distance, so that their order
 * does not matter.
 */
#ifndef CSG_RENDER_DEPTH_MAP_H
#define CSG_RENDER_DEPTH_MAP_H

#include <stdatomic.h>
#include <string.h>

#include "render/job.h"

typedef struct csg_depth_map {
    uint32_t side;        /* places along each side */
    double place;         /* side of one, in scene units */
    csg_vec3 x, y, away;  /* a point's coordinates in places, and its distance: these by it ... */
    double x0, y0, away0; /* ... and these added; no distance in the box is below 0 */
    double farthest;      /* what is wholly beyond is left out */
    /* Bits of floats; INFINITY: nothing is there; NULL: there is no map. */
    atomic_uint *nearest;
} csg_depth_map;

/* Sees all of the box; nothing is drawn yet. up: not parallel to forward. */
csg_depth_map csg_depth_map_along(csg_vec3 forward, csg_vec3 up, csg_box box, uint32_t side);

enum { CSG_DEPTH_MAPS = 2 }; /* at most at once */

/* Draws the mesh into each of the maps. They must be released, also when it fails. */
csgm_status csg_depth_maps_draw(csg_depth_map *maps, size_t count, csg_picture *picture,
                                const csgm_mesh_view *mesh);
void csg_depth_map_release(csg_depth_map *map, csgm_context *context);

/* x, y in places; z the distance. */
static inline csg_vec3 csg_depth_map_project(const csg_depth_map *map, csg_vec3 point)
{
    return csg_vec3_make(csg_vec3_dot(map->x, point) + map->x0,
                         csg_vec3_dot(map->y, point) + map->y0,
                         csg_vec3_dot(map->away, point) + map->away0);
}

/* Of what is seen at a place; INFINITY: nothing. */
static inline float csg_depth_map_at(const csg_depth_map *map, float x, float y)
{
    float side = (float)map->side;
    if (!(x >= 0 && y >= 0 && x < side && y < side))
        return INFINITY;
    size_t place = (size_t)(uint32_t)(int32_t)y * map->side + (uint32_t)(int32_t)x;
    unsigned bits = atomic_load_explicit(&map->nearest[place], memory_order_relaxed);
    float distance;
    memcpy(&distance, &bits, sizeof distance);
    return distance;
}

#endif
