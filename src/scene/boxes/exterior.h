/* SPDX-License-Identifier: MIT
 * A box of the solid by what its tree is far away, where levels do not tell (level_boxes.h): a soft
 * node is never below -1/(2 lambda), so that a level beyond this is met everywhere, although the
 * node it stands in is outside as soon as all of its operands are far.
 */
#ifndef CSG_SCENE_EXTERIOR_H
#define CSG_SCENE_EXTERIOR_H

#include "scene/scene.h"

/* Outside of *out the scene's field is negative. All of space where that is not found. */
csgm_status csg_exterior_box(const csgm_scene *scene, csg_box *out);

#endif
