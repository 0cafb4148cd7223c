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
