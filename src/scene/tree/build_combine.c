/* SPDX-License-Identifier: MIT
 * Building nodes whose value is a formula of their operands' values.
 */
#include <math.h>

#include "scene/operators/combine.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

csg_node_id csg_build_combine(csg_scene_builder *builder, const csg_formula_step *steps,
                              uint32_t count, double slope, const csg_node_id *children,
                              size_t child_count, csg_span where)
{
    csg_box all = csg_box_all();
    if (builder->status != CSGM_OK || !csg_check_field(builder, steps, count, all, slope))
        return CSG_NODE_NONE;
    if (child_count < 1 || child_count > CSG_COMBINE_MOST) {
        csg_check_fail(builder, CSGM_ERR_SCENE, "it combines one to %d solids, not %zu",
                       CSG_COMBINE_MOST, child_count);
        return CSG_NODE_NONE;
    }
    for (size_t i = 0; i < child_count; i++)
        if (!csg_build_is_usable(builder, children[i]))
            return CSG_NODE_NONE;
    csg_formula formula = {.count = count, .lipschitz = slope, .bounds = all};
    if (slope == 0)
        formula.lipschitz = csg_formula_partials_sum(&builder->context->memory, steps, count);
    if (isnan(formula.lipschitz))
        return csg_build_no_memory(builder);
    if (!(formula.lipschitz <= 1e12)) {
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "how steep the formula gets cannot be told; give lipschitz =");
        return CSG_NODE_NONE;
    }
    formula.lipschitz = fmax(formula.lipschitz, 1);
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, child_count) ||
        !csg_build_append_formula(builder, steps, &formula))
        return CSG_NODE_NONE;
    csg_node node = {.kind = CSG_NODE_COMBINE,
                     .payload = (uint32_t)builder->scene->formula_count - 1,
                     .where = where};
    return csg_build_append(builder, node, children, child_count);
}
