/* SPDX-License-Identifier: MIT
 * Some solids of a scene as a scene of their own.
 */
#ifndef CSG_SCENE_EXCERPT_H
#define CSG_SCENE_EXCERPT_H

#include "scene/scene.h"

/* A node, and what its ancestors say: its place, and the outermost look of each kind; the part is
 * not looked at. */
typedef struct csg_excerpt_item {
    csg_node_id node; /* of which no other item is an ancestor */
    csg_affine place;
    csg_look look;
} csg_excerpt_item;

typedef struct csg_excerpt {
    csg_node_kind kind; /* the sharp operator that takes them */
    const csg_excerpt_item *items;
    size_t count;
    csg_box within; /* cut by this box; empty: not cut */
} csg_excerpt;

/* The scene is sealed. Spans go on to point into its texts. Reports nothing. */
csgm_status csg_scene_excerpt(const csgm_scene *scene, const csg_excerpt *excerpt,
                              csgm_scene **out);

#endif
