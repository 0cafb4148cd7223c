/* SPDX-License-Identifier: MIT
 * Fields combined by a formula: building the node, and what its box can be.
 */
#include "scene/combine.h"

#include "scene/build_private.h"
#include "scene/check.h"

/* Larger than any operand that matters; finite, so that products are. */
#define FARTHEST 1e15

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

void csg_combine_begin(csg_combine *c, const csgm_scene *scene, const csg_node *node)
{
    const csg_formula *formula = &scene->formulas[node->payload];
    *c = (csg_combine){.scene = scene, .formula = formula};
    csg_formula_trends(&scene->context->memory, scene->steps + formula->first, formula->count,
                       c->trends);
    c->bytes = formula->count * sizeof *c->work;
    c->work = csg_memory_alloc(&scene->context->memory, c->bytes);
}

void csg_combine_end(csg_combine *c)
{
    csg_memory_release(&c->scene->context->memory, c->work, c->work ? c->bytes : 0);
}

/* The largest value where every operand that the formula rises with is below -t. */
static double highest_below(const csg_combine *c, double t)
{
    double at[3];
    for (int k = 0; k < 3; k++)
        at[k] = c->trends[k] > 0 ? -t : -FARTHEST;
    csg_formula_dual dual = csg_formula_evaluate(c->scene->steps, c->formula,
                                                 csg_vec3_make(at[0], at[1], at[2]), c->work);
    return dual.value / c->formula->lipschitz;
}

double csg_combine_inner_level(const csg_combine *c, double level)
{
    bool known = c->work && c->trends[0] && c->trends[1] && c->trends[2];
    if (!known || !isfinite(level))
        return INFINITY;
    double t = fmax(level, 0);
    for (int i = 0; i < 60; i++, t = fmax(2 * t, 1e-6))
        if (highest_below(c, t) <= -level)
            return t;
    return INFINITY;
}
