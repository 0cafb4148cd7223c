/* SPDX-License-Identifier: MIT
 * The source texts of a scene, kept for findings about solids after the language is done with them.
 */
#ifndef CSG_SCENE_TEXTS_H
#define CSG_SCENE_TEXTS_H

#include "scene/scene.h"

/* Copies names and texts (one text at two places once) into the scene; a span's source is an index.
 * False: out of memory. */
bool csg_scene_keep_texts(csgm_scene *scene, const csg_scene_text *texts, size_t count);

/* Fills the place of a finding about a node: source, line, column. False: none is known. */
bool csg_scene_show_node(const csgm_scene *scene, csg_node_id id, csgm_diag *diag);

#endif
