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

#include "scene/scene.h"

typedef enum csg_joint_kind {
    CSG_JOINT_SWELLS, /* beyond a face that solids have in common, by `amount` at least */
    CSG_JOINT_FILLS,  /* a gap, `amount` wide, between two solids */
    CSG_JOINT_MISSES, /* solids that are `amount` apart: the blend acts nowhere */
    CSG_JOINT_GROOVES /* along a face at which two solids meet, `amount` deep at least (seams.h) */
} csg_joint_kind;

typedef struct csg_joint {
    csg_joint_kind kind;
    const csg_node *node; /* the operator that blends */
    double amount;
    int axis; /* of the union's own frame: the face lies there, the gap around it */
    double at;
    csg_vec3 place; /* GROOVES: one place in it, in the scene's frame */
    bool is_fin;    /* GROOVES: something is left there, instead of nothing */
} csg_joint;

typedef void csg_joint_take(void *user, const csg_joint *joint);

/* Gives the worst joint of each kind of each blended union of a sealed scene. The work is bounded:
 * of scenes with very many blends the first are looked at. CSGM_OK or CSGM_ERR_MEMORY (not
 * reported). */
csgm_status csg_joints_find(const csgm_scene *scene, csg_joint_take *take, void *user);

#endif
