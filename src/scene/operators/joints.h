/* SPDX-License-Identifier: MIT
 * What a blended union does where its solids come together that whoever wrote it may not expect:
 * `round` and the other blends by values alone take all faces for such that meet at a right angle.
 * Where two solids end in one plane they swell beyond it; across a narrow gap they fill it. And
 * what a blended operator does along faces at which solids lie against each other (seams.h).
 *
 * Boxes say where to look, the field what happens there: nothing is found that is not so in the
 * whole scene, too. What lies along no axis of the union's own frame, and what is cut out of
 * others, is not found.
 */
#ifndef CSG_SCENE_JOINTS_H
#define CSG_SCENE_JOINTS_H

#include "scene/operators/joint.h"

/* Gives the worst joint of each kind of each blended union of a sealed scene. The work is bounded:
 * of scenes with very many blends the first are looked at. CSGM_OK or CSGM_ERR_MEMORY (not
 * reported). */
csgm_status csg_joints_find(const csgm_scene *scene, csg_joint_take *take, void *user);

#endif
