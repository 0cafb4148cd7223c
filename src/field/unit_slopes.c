/* SPDX-License-Identifier: MIT
 * Copies of parameters and formulas; see unit_slopes.h.
 */
#include "field/unit_slopes.h"

#include <string.h>

#include "scene/operators/blend_kinds.h"

/* What is rounded up. */
static const float UP = 1 + 0x1p-20f;

/* Of its formula: each field has one of its own. */
static uint32_t number_of(const csg_tape *tape, const csg_tape_node *field)
{
    return (uint32_t)(csg_tape_formula_of(tape, field) - tape->formulas);
}

static bool is_steep(const csg_tape *tape, const csg_tape_node *node)
{
    return node->op == CSG_OP_FIELD && csg_tape_formula_of(tape, node)->lipschitz > UP;
}

/* Whether nothing looks at more than the signs of leaves that are steep. What raises a formula is
 * rounded, and its zero would be another one. */
static bool is_by_signs(const csg_tape *tape, const csg_tape_node *node)
{
    if (csg_op_is_leaf(node->op))
        return !is_steep(tape, node) || tape->parameters[node->parameters + CSG_LEAF_RAISE] == 0;
    return (node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION) &&
           csg_blend_is_sharp(node->blend);
}

bool csg_tape_is_by_signs(const csg_tape *tape)
{
    bool all = true;
    for (uint32_t i = 0; i < tape->count && all; i++)
        all = is_by_signs(tape, &tape->nodes[i]);
    return all;
}

void csg_leaf_divide(const csg_tape *tape, const csg_tape_node *leaf, float by, float *parameters)
{
    const float *from = tape->parameters + leaf->parameters;
    float *own = parameters + leaf->parameters;
    own[CSG_LEAF_SIGMA] = from[CSG_LEAF_SIGMA] / by;
    own[CSG_LEAF_SLACK] = from[CSG_LEAF_SLACK] / by * UP;
    own[CSG_LEAF_OFF] = from[CSG_LEAF_OFF] / by * UP;
    own[CSG_LEAF_TURNED] = from[CSG_LEAF_TURNED] / by * UP;
}

static void divide(const csg_tape *tape, const csg_tape_node *leaf, float *parameters,
                   csg_tape_formula *formulas)
{
    csg_tape_formula *formula = &formulas[number_of(tape, leaf)];
    csg_leaf_divide(tape, leaf, formula->lipschitz, parameters);
    formula->lipschitz = UP;
}

bool csg_field_with_unit_slopes(const csgm_field *field, csg_arena *arena, csgm_field *out)
{
    const csg_tape *tape = &field->tape;
    uint32_t steep = 0, formula_count = 0;
    *out = *field;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        steep += is_steep(tape, node);
        if (node->op == CSG_OP_FIELD && number_of(tape, node) >= formula_count)
            formula_count = number_of(tape, node) + 1;
    }
    if (!steep || !csg_tape_is_by_signs(tape))
        return true;
    float *parameters = csg_arena_alloc(arena, field->parameter_count * sizeof *parameters);
    csg_tape_formula *formulas = csg_arena_alloc(arena, formula_count * sizeof *formulas);
    if (!parameters || !formulas)
        return false;
    memcpy(parameters, tape->parameters, field->parameter_count * sizeof *parameters);
    memcpy(formulas, tape->formulas, formula_count * sizeof *formulas);
    for (uint32_t i = 0; i < tape->count; i++)
        if (is_steep(tape, &tape->nodes[i]))
            divide(tape, &tape->nodes[i], parameters, formulas);
    out->tape.parameters = parameters;
    out->tape.formulas = formulas;
    out->tape.lipschitz = out->tape.steepest = UP;
    return true;
}
