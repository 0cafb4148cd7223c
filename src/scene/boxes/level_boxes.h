/* SPDX-License-Identifier: MIT
 * Boxes of {f >= -level} for the nodes of a scene (levelbox of operators.md 3.3, n-ary).
 */
#ifndef CSG_SCENE_LEVEL_BOXES_H
#define CSG_SCENE_LEVEL_BOXES_H

#include "scene/scene.h"

/* out[i] = a box of {f_i >= -levels[i]} in node i's own frame, ancestors not regarded.
 * levels NULL = 0 for all. */
csgm_status csg_level_boxes(const csgm_scene *scene, const double *levels, csg_box *out);

/* Box of the solid in the scene's frame: every operator cuts what its operands need to show, up
 * and down the tree until nothing changes (Cameron's S-bounds). */
csgm_status csg_level_box_of_root(const csgm_scene *scene, csg_box *out);

#endif
