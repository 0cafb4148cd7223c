/* SPDX-License-Identifier: MIT
 * Softness of the nodes of a scene that is being sealed.
 */
#ifndef CSG_SCENE_SOFTNESS_H
#define CSG_SCENE_SOFTNESS_H

#include "scene/scene.h"

/* Fills scene->softness and the lambdas among the parameters; sharp operators that compare fields
 * become FIELD_SHARP, which is the last of the scene's rules. False: no memory. */
bool csg_softness_settle(csgm_scene *scene, csg_arena *scratch);

#endif
