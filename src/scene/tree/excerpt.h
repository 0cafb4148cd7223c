/* SPDX-License-Identifier: MIT
 * Some solids of a scene as a scene of their own.
 */
#ifndef CSG_SCENE_EXCERPT_H
#define CSG_SCENE_EXCERPT_H

#include "scene/tree/build.h"

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

/* The same in steps, for trees of another form: all nodes of a sealed scene into a builder that is
 * empty, with the same numbers (false: out of memory, not noted), then each item's node in its
 * place, under its look. */
bool csg_excerpt_load(csg_scene_builder *builder, const csgm_scene *scene);
csg_node_id csg_excerpt_place(csg_scene_builder *builder, const csg_excerpt_item *item);

#endif
