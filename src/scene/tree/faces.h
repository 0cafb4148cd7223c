/* SPDX-License-Identifier: MIT
 * What fillets look at beside the values of their operands (operators.md 16): the smooth faces of
 * leaves that have edges, and half-spaces that hold the others; and which nodes are handed up to a
 * fillet one by one.
 */
#ifndef CSG_SCENE_FACES_H
#define CSG_SCENE_FACES_H

#include "scene/tree/build.h"

/* What csg_faces_add has changed. */
typedef struct csg_faces {
    size_t node_count;  /* before */
    csg_node_id *taken; /* leaves that have been wrapped, in pairs with their places in children */
    size_t count, capacity;
} csg_faces;

/* Puts every leaf with faces below a fillet, in the tree of *root, into an intersection with them
 * (CSG_FLAG_FACES), which has the same field; and every union with a fillet into one with the sides
 * of its box, so that the fillet ends there. boxes: of the builder's nodes, in their own frames. */
csgm_status csg_faces_add(csg_scene_builder *builder, csg_node_id *root, const csg_box *boxes,
                          csg_faces *faces);
/* Whether any of the nodes is a fillet. */
bool csg_faces_are_needed(const csgm_scene *scene);
/* Takes them away again. */
void csg_faces_remove(csg_scene_builder *builder, csg_faces *faces);

/* Marks what is held in a sealed scene. */
csgm_status csg_faces_mark(csgm_scene *scene);

#endif
