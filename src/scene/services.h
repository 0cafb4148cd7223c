/* SPDX-License-Identifier: MIT
 * What the language needs from layers that stand below it in the pipeline: mesh files and meshes.
 * The public functions hand it down (api/services.c), so that no layer includes a lower one.
 */
#ifndef CSG_SCENE_SERVICES_H
#define CSG_SCENE_SERVICES_H

#include "scene/scene.h"
#include "shape/polyhedra/triangles.h"

typedef struct csg_services {
    /* The triangles of a mesh file. On failure `problem` says what is wrong, in one sentence
     * without a place, and nothing was reported. */
    csgm_status (*read_mesh)(csgm_context *context, const char *path, csg_triangles *out,
                             char *problem, size_t problem_size);
    /* Triangles on the scene's surface, `cells` along the longest side of its bounds; none where it
     * has no surface. Reports nothing. */
    csgm_status (*tessellate)(csgm_context *context, const csgm_scene *scene, uint32_t cells,
                              csg_triangles *out);
} csg_services;

#endif
