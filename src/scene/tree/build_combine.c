/* SPDX-License-Identifier: MIT
 * Building nodes whose value is a formula of their operands' values.
 */
#include <math.h>

#include "scene/formula/formula.h"
#include "scene/operators/combine.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

static bool check_combine(csg_scene_builder *builder, const csg_formula_step *steps, uint32_t count,
                          double slope, const csg_node_id *children, size_t child_count)
{
    csg_box all = csg_box_all();
    if (builder->status != CSGM_OK || !csg_check_field(builder, steps, count, all, slope))
        return false;
    if (child_count < 1 || child_count > CSG_COMBINE_MOST) {
        csg_check_fail(builder, CSGM_ERR_SCENE, "it combines one to %d solids, not %zu",
                       CSG_COMBINE_MOST, child_count);
        return false;
    }
    for (size_t i = 0; i < child_count; i++)
        if (!csg_build_is_usable(builder, children[i]))
            return false;
    return true;
}

csg_node_id csg_build_combine_known(csg_scene_builder *builder, const csg_formula_step *steps,
                                    uint32_t count, double slope, const csg_node_id *children,
                                    size_t child_count, csg_span where)
{
    csg_formula formula = {.count = count, .lipschitz = fmax(slope, 1), .bounds = csg_box_all()};
    if (!check_combine(builder, steps, count, slope, children, child_count))
        return CSG_NODE_NONE;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, child_count) ||
        !csg_build_append_formula(builder, steps, &formula))
        return CSG_NODE_NONE;
    csg_node node = {.kind = CSG_NODE_COMBINE,
                     .payload = (uint32_t)builder->scene->formula_count - 1,
                     .where = where};
    return csg_build_append(builder, node, children, child_count);
}

/* Which values the operands take together is not known, so that nothing refutes a slope. */
csg_node_id csg_build_combine(csg_scene_builder *builder, const csg_formula_step *steps,
                              uint32_t count, double slope, const csg_node_id *children,
                              size_t child_count, csg_span where)
{
    if (!check_combine(builder, steps, count, slope, children, child_count))
        return CSG_NODE_NONE;
    double bound = csg_formula_partials_sum(&builder->context->memory, steps, count);
    if (isnan(bound))
        return csg_build_no_memory(builder);
    bool told = bound <= 1e12;
    if (!told && slope == 0) {
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "how steep the formula gets cannot be told; give lipschitz =");
        return CSG_NODE_NONE;
    }
    if (told && bound > slope * (1 + 1e-9)) /* rounding of a constant that it gave before */
        slope = bound;
    return csg_build_combine_known(builder, steps, count, slope, children, child_count, where);
}
