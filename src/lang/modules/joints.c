/* SPDX-License-Identifier: MIT
 * Warnings about what blends do where solids come together (scene/operators/joints.h).
 */
#include <stdio.h>

#include "base/scene_codes.h"
#include "lang/modules/modules.h"
#include "scene/operators/joints.h"

typedef struct reporter {
    csg_eval *e;
    const csgm_scene *scene;
} reporter;

static void warn(void *user, const csg_joint *joint)
{
    const reporter *r = user;
    csg_blend blend = csg_scene_blend(r->scene, joint->node);
    char axis = (char)('x' + joint->axis), hint[80];
    snprintf(hint, sizeof hint, "blend = fillet(%g) %s", blend.n,
             joint->kind == CSG_JOINT_SWELLS ? "ends flush with it" : "keeps gaps open");
    const char *round_hint = csg_blend_is_round(blend.kind) ? hint : NULL;
    bool is_near = csg_blend_is_fillet(blend.kind) && joint->amount < csg_blend_support(blend);
    if (is_near)
        snprintf(hint, sizeof hint, "blend = round(%g) joins what does not meet", blend.n);
    switch (joint->kind) {
    case CSG_JOINT_SWELLS:
        csg_eval_report(r->e, CSG_DIAG_SWELLS, joint->node->where, round_hint,
                        "the blend swells by %.3g beyond the face at %c = %.6g, which its solids "
                        "have in common",
                        joint->amount, axis, joint->at);
        break;
    case CSG_JOINT_FILLS:
        csg_eval_report(r->e, CSG_DIAG_GAP_FILLED, joint->node->where, round_hint,
                        "the blend fills the gap of %.3g between its solids around %c = %.6g",
                        joint->amount, axis, joint->at);
        break;
    case CSG_JOINT_MISSES:
        if (csg_node_is_idle(joint->node)) {
            snprintf(hint, sizeof hint,
                     "blend = round(%g) also joins solids that are nearer than it", blend.n);
            csg_eval_report(r->e, CSG_DIAG_UNUSED_BLEND, joint->node->where, hint,
                            "the blend joins nothing: no two of its solids%s meet",
                            joint->node->kind == CSG_NODE_UNION ? "" : "' surfaces");
            break;
        }
        csg_eval_report(r->e, CSG_DIAG_UNUSED_BLEND, joint->node->where, is_near ? hint : NULL,
                        "the blend joins nothing: its solids%s are %.3g apart",
                        joint->node->kind == CSG_NODE_UNION ? "" : "' surfaces", joint->amount);
        break;
    case CSG_JOINT_GROOVES:
        csg_eval_report(r->e, CSG_DIAG_SEAM_CUT, joint->node->where,
                        "let the two overlap: where they only touch, the union's field is 0",
                        "the blend %s of %.3g along the face at %c = %.6g where two solids lie "
                        "against each other, at [%.4g, %.4g, %.4g]",
                        joint->is_fin ? "leaves a fin" : "cuts a groove", joint->amount, axis,
                        joint->at, joint->place.x, joint->place.y, joint->place.z);
        break;
    }
}

csgm_status csg_warn_joints(csg_eval *e, const csgm_scene *scene)
{
    reporter r = {e, scene};
    csgm_status status = csg_joints_find(scene, warn, &r);
    return status == CSGM_OK ? CSGM_OK : csg_context_no_memory(e->context);
}
