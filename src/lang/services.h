/* SPDX-License-Identifier: MIT
 * What the language needs from layers that stand below it in the pipeline: mesh files and meshes.
 * The public functions hand it down (api/services.c), so that no layer includes a lower one.
 */
#ifndef CSG_LANG_SERVICES_H
#define CSG_LANG_SERVICES_H

#include "solid/solid.h"

typedef struct csg_services {
    /* The triangles of a mesh file. On failure `problem` says what is wrong, in one sentence
     * without a place, and nothing was reported. */
    csgm_status (*read_mesh)(csgm_context *context, const char *path, csg_triangles *out,
                             char *problem, size_t problem_size);
    csg_tessellate *tessellate; /* handed on to solid/ */
} csg_services;

#endif
