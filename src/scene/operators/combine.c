/* SPDX-License-Identifier: MIT
 * Fields combined by a formula: what their boxes can be.
 */
#include "scene/operators/combine.h"

#include <math.h>

#include "scene/formula/formula.h"

/* Larger than any operand that matters; finite, so that products are. */
#define FARTHEST 1e15

void csg_combine_begin(csg_combine *c, const csgm_scene *scene, const csg_node *node)
{
    const csg_formula *formula = &scene->formulas[node->payload];
    *c = (csg_combine){.scene = scene, .formula = formula};
    c->operands = node->child_count;
    csg_formula_trends(&scene->context->memory, scene->steps + formula->first, formula->count,
                       c->operands, c->trends);
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
    double at[CSG_COMBINE_MOST] = {0};
    for (uint32_t k = 0; k < c->operands; k++)
        at[k] = c->trends[k] > 0 ? -t : -FARTHEST;
    csg_formula_dual dual = csg_formula_evaluate_group(c->scene->steps, c->formula, at, 0, c->work);
    return dual.value / c->formula->lipschitz;
}

double csg_combine_inner_level(const csg_combine *c, double level)
{
    bool known = c->work;
    for (uint32_t k = 0; k < c->operands; k++)
        known = known && c->trends[k];
    if (!known || !isfinite(level))
        return INFINITY;
    double t = fmax(level, 0);
    for (int i = 0; i < 60; i++, t = fmax(2 * t, 1e-6))
        if (highest_below(c, t) <= -level)
            return t;
    return INFINITY;
}
