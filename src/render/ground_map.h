/* SPDX-License-Identifier: MIT
 * The shadow that triangles throw on the ground (ground.h), as a table over the ground.
 */
#ifndef CSG_RENDER_GROUND_MAP_H
#define CSG_RENDER_GROUND_MAP_H

#include "render/ground.h"
#include "render/mesh_light.h"

typedef struct csg_ground_map {
    double z, x, y, step; /* the ground's height; the table's corner; from place to place */
    float *darkness; /* CSG_GROUND_SIDE in each row along x; 0: nothing is made, none is seen */
} csg_ground_map;

enum { CSG_GROUND_SIDE = 320 };

/* box: of the mesh. */
bool csg_ground_map_is_wanted(const csg_picture *picture, csg_box box);
csgm_status csg_ground_map_make(csg_ground_map *out, csg_picture *picture,
                                const csg_mesh_light *light, csg_box box);
void csg_ground_map_release(csg_ground_map *map, csgm_context *context);

/* How dark the ground is where a ray of the view meets it. */
float csg_ground_map_at(const csg_ground_map *map, csg_vec3 origin, csg_vec3 direction);

#endif
