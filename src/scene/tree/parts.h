/* SPDX-License-Identifier: MIT
 * Parts: solids of a scene that become meshes of their own. A part is what stands below a COLOR
 * node with a part's name, if it reaches the root through sharp unions, transforms and other looks
 * only; there, its share of the scene is a union of its own. All of one name are one part, and what
 * is in none is the part without a name. Elsewhere (an operand of a difference, of an intersection
 * or of a blend, below an offset, an extrusion or a warp, inside another part) a name changes
 * nothing.
 */
#ifndef CSG_SCENE_PARTS_H
#define CSG_SCENE_PARTS_H

#include "scene/scene.h"

/* What the ancestors of a solid say: its place, and the outermost look of each kind. */
typedef struct csg_part_way {
    csg_affine place;
    csg_look look;
} csg_part_way;

/* A solid on the way down from the root: the first node that is no union, transform or look. */
typedef struct csg_part_unit {
    csg_node_id node;
    uint32_t way;
} csg_part_unit;

typedef struct csg_parts {
    const csgm_scene *scene;
    csg_part_way *ways;
    csg_part_unit *units; /* in the order of the scene */
    uint32_t *numbers;    /* of parts as in csg_look, 0 first; those that have units */
    csg_node_id *lost;    /* COLOR nodes whose part's name changes nothing */
    size_t way_count, way_room, unit_count, unit_room, count, number_room, lost_count, lost_room;
} csg_parts;

/* count 0: the scene names no parts, or none that counts. CSGM_ERR_MEMORY is not reported. Reset it
 * in any case. */
csgm_status csg_parts_find(csg_parts *parts, const csgm_scene *scene);
void csg_parts_reset(csg_parts *parts);

/* NULL for the part without a name. index < count. */
const char *csg_parts_name(const csg_parts *parts, size_t index);
/* The part of that name, NULL being that of the part without one. False: there is none. */
bool csg_parts_index(const csg_parts *parts, const char *name, size_t *index);
/* A box that contains the part. */
csg_box csg_parts_box(const csg_parts *parts, size_t index);
/* The part as a scene of its own; reports nothing. */
csgm_status csg_parts_scene(const csg_parts *parts, size_t index, csgm_scene **out);

#endif
