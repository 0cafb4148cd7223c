/* SPDX-License-Identifier: MIT
 * The evaluated tree as text that OpenSCAD reads, as its own .csg files.
 */
#ifndef CSG_SCENE_PRINT_OPENSCAD_H
#define CSG_SCENE_PRINT_OPENSCAD_H

#include "scene/scene.h"

/* CSGM_ERR_UNSUPPORTED: a solid that OpenSCAD cannot say, which is reported with its place before
 * any text is handed out. CSGM_ERR_MEMORY: part of the text may have been. */
csgm_status csg_scene_print_openscad(const csgm_scene *scene, csgm_text_fn *sink, void *user);

#endif
