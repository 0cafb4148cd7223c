/* SPDX-License-Identifier: MIT
 * Half-spaces that contain operands of a fillet (operators.md 16): what a ball fills that rolls
 * along some of them lies in their convex hull, so the blend ends where half-spaces do that hold
 * them all.
 */
#ifndef CSG_SCENE_FILLET_PLANES_H
#define CSG_SCENE_FILLET_PLANES_H

#include "scene/scene.h"

/* Fills the planes of a sealed scene whose bounds are known. */
csgm_status csg_fillet_planes_find(csgm_scene *scene);

#endif
