/* SPDX-License-Identifier: MIT
 * Boxes of solids.
 */
#include "scene/bounds.h"

csgm_status csg_bounds_fill(csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++)
        scene->bounds[i] = csg_box_all();
    return CSGM_OK;
}

csg_box csg_bounds_of_solid(const csgm_scene *scene)
{
    return scene->bounds[scene->root];
}
