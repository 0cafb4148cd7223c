/* SPDX-License-Identifier: MIT
 * What blends do where solids come together: what is told of it (joints.h, seams.h).
 */
#ifndef CSG_SCENE_JOINT_H
#define CSG_SCENE_JOINT_H

#include "scene/scene.h"

enum {
    CSG_JOINT_GRID = 5,         /* places looked at along each side of a face */
    CSG_JOINT_LEAST_LOOKS = 100 /* an operator that could not be asked so often is not looked at */
};

/* Of the box: ends that are nearer are one. */
#define CSG_JOINT_SAME 1e-9

typedef enum csg_joint_kind {
    CSG_JOINT_SWELLS, /* beyond a face that solids have in common, by `amount` at least */
    CSG_JOINT_FILLS,  /* a gap, `amount` wide, between two solids */
    CSG_JOINT_MISSES, /* surfaces that are `amount` apart: the blend acts nowhere */
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

#endif
