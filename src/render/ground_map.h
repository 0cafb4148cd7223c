/* SPDX-License-Identifier: MIT
 * The shadow that triangles throw on the ground (ground.h), as a table over the ground: a z-buffer
 * from the light tells what is before each place, and how far before it, which is how soft its
 * shadow is there (Fernando 2005), and one from below how near to the ground things are, which hide
 * the sky from it.
 */
#ifndef CSG_RENDER_GROUND_MAP_H
#define CSG_RENDER_GROUND_MAP_H

#include "render/ground.h"

typedef struct csg_ground_map {
    double z, x, y, step; /* the ground's height; the table's corner; from place to place */
    float *darkness; /* CSG_GROUND_SIDE in each row along x; 0: nothing is made, none is seen */
} csg_ground_map;

enum { CSG_GROUND_SIDE = 320 };

/* box: of the mesh. Without a darkness where no ground is to be seen. */
csgm_status csg_ground_map_make(csg_ground_map *out, csg_picture *picture,
                                const csgm_mesh_view *mesh, csg_box box);
void csg_ground_map_release(csg_ground_map *map, csgm_context *context);

/* How dark the ground is where a ray of the view meets it. */
float csg_ground_map_at(const csg_ground_map *map, csg_vec3 origin, csg_vec3 direction);

#endif
