/* SPDX-License-Identifier: MIT
 * .vm tapes, the text that the programs fidget and libfive exchange formulas in: a line for each
 * step, `name op operands`, operands being names of lines above; # begins a comment; the last line
 * is the result, negative inside. Angles are radians.
 */
#ifndef CSG_SCENE_VM_H
#define CSG_SCENE_VM_H

#include "scene/formula/step.h"
#include "scene/scene.h"

typedef struct csg_vm_problem {
    size_t line; /* from 1; 0: the whole */
    char text[120];
} csg_vm_problem;

/* The tape's formula, its sign turned, in `terms`, which was begun. CSGM_ERR_FORMAT: *problem says
 * what is wrong; CSGM_ERR_MEMORY. Operations that formulas do not have are composed of others;
 * compare, not, and, or become steep steps. */
csgm_status csg_vm_read(csg_terms *terms, const char *text, size_t length, csg_term *result,
                        csg_vm_problem *problem);

/* The scene as a tape. Reports why not: a solid bounded by triangles that is not convex
 * (CSGM_ERR_UNSUPPORTED), too long (CSGM_ERR_LIMIT), memory. */
csgm_status csg_vm_print(const csgm_scene *scene, csgm_text_fn *sink, void *user);

#endif
