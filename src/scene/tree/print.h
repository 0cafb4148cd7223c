/* SPDX-License-Identifier: MIT
 * The evaluated tree as text in the scene language: it parses back to the same tree.
 */
#ifndef CSG_SCENE_PRINT_H
#define CSG_SCENE_PRINT_H

#include "scene/scene.h"

/* CSGM_OK or CSGM_ERR_MEMORY (part of the text may have been handed out then). */
csgm_status csg_scene_print(const csgm_scene *scene, csgm_text_fn *sink, void *user);
/* The line that a node begins with, without what is below it. False: out of memory. */
bool csg_scene_print_node(const csgm_scene *scene, csg_node_id node, csgm_text_fn *sink,
                          void *user);

#endif
