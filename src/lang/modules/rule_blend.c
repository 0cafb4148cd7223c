/* SPDX-License-Identifier: MIT
 * Values of rules and profiles as blends of the scene.
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/evaluate/rule_value.h"
#include "lang/modules/formula_call.h"

/* What a profile's bounds say about it. */
static void warn_profile(csg_module_call *call, uint32_t index, const csg_profile *p)
{
    const double room = 1e-3; /* intervals say a little more than there is */
    if (!isfinite(p->support))
        csg_eval_report(call->e, CSG_DIAG_LOOSE_PROFILE, call->spans[index],
                        "end it, as max(0, w - x) does",
                        "the profile is not seen to end: it counts as reaching everywhere");
    if (p->slope[0] < -1 - room || p->slope[1] > room)
        csg_eval_report(call->e, CSG_DIAG_LOOSE_PROFILE, call->spans[index], NULL,
                        "the profile's slope lies between %g and %g, not -1 and 0: the blend is "
                        "not monotone",
                        p->slope[0], p->slope[1]);
}

static csg_blend profile_blend(csg_module_call *call, uint32_t index)
{
    csg_eval *e = call->e;
    csg_blend blend = CSG_SHARP;
    csg_profile profile;
    uint32_t count = 0;
    size_t bytes = 0;
    csg_formula_step *steps = csg_formula_of_literal(
        call, index, call->values[index].as.rule->function, 1, &count, &bytes);
    if (steps && count && !call->failed)
        blend = csg_build_profile(&e->builder, steps, count, &profile);
    csg_memory_release(e->heap.memory, steps, bytes);
    if (csg_blend_is_profile(blend.kind))
        warn_profile(call, index, &profile);
    return blend;
}

csg_blend csg_rule_blend(csg_module_call *call, uint32_t index)
{
    csg_eval *e = call->e;
    const csg_rule_value *value = call->values[index].as.rule;
    csg_blend blend =
        value->function ? profile_blend(call, index) : csg_build_rule(&e->builder, &value->rule);
    if (!e->stop && e->builder.status != CSGM_OK) {
        csg_check_node(e, CSG_NODE_NONE, call->spans[index]); /* reports */
        call->failed = true;
        blend = CSG_SHARP;
    }
    return blend;
}
