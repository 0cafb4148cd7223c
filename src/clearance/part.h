/* SPDX-License-Identifier: MIT
 * A part at one pose: its scene, and once it is needed its field and the cubes over it.
 */
#ifndef CSG_CLEARANCE_PART_H
#define CSG_CLEARANCE_PART_H

#include "measure/walk.h"
#include "scene/tree/parts.h"

typedef struct csg_clear_part {
    csgm_scene *scene;
    csgm_field *field;
    csg_measure_walk walk;
    uint64_t digest[2]; /* of all that the scene is */
    bool is_open;       /* the walk is there; a part that is empty has none */
} csg_clear_part;

/* Of one of the pose's parts; it becomes *part unless that is the same already. *changed: it was
 * not. CSGM_OK, or why not (reported); release it in any case. */
csgm_status csg_clear_part_take(csg_clear_part *part, csgm_context *context, const csg_parts *parts,
                                size_t index, csg_mesh_watch *watch, bool *changed);
void csg_clear_part_release(csg_clear_part *part);

/* From a part's own frame to the scene's. */
static inline csg_vec3 csg_clear_part_origin(const csg_clear_part *part)
{
    return part->field->center;
}

#endif
