/* SPDX-License-Identifier: MIT
 * Operands of which one is the other's negative but for a constant, as the two sides of a wall are
 * where a solid is hollowed by itself, moved inwards; see slopes.h. However little is known of
 * their gradients, these add up to nothing.
 */
#include <string.h>

#include "field/same_leaf.h"
#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/blends.h"

static bool are_leaves_opposite(const csg_tape *tape, const csg_tape_node *a,
                                const csg_tape_node *b)
{
    const float *p = tape->parameters + a->parameters, *q = tape->parameters + b->parameters;
    return p[CSG_LEAF_SIGMA] + q[CSG_LEAF_SIGMA] == 0 && csg_tape_is_same_leaf(tape, a, b);
}

/* A constant that is added to all operands of these is added to what they give. */
static bool keeps_constants(uint8_t blend)
{
    return !csg_blend_is_rule(blend) && blend != CSG_BLEND_ORTHOGONAL;
}

static bool are_parameters_same(const csg_tape *tape, uint32_t a, uint32_t b)
{
    return !memcmp(tape->parameters + a, tape->parameters + b,
                   CSG_OPERATOR_PARAMETERS * sizeof(float));
}

static bool are_operators_opposite(const csg_tape *tape, const csg_tape_node *a,
                                   const csg_tape_node *b)
{
    bool is_sharp = a->op == CSG_OP_UNION || a->op == CSG_OP_INTERSECTION;
    bool is_known = is_sharp || csg_op_is_round(a->op);
    if (!is_known || a->arity != b->arity || !keeps_constants(a->blend) ||
        csg_op_is_union(a->op) == csg_op_is_union(b->op))
        return false;
    return is_sharp
               ? b->op == CSG_OP_UNION || b->op == CSG_OP_INTERSECTION
               : csg_op_is_round(b->op) && are_parameters_same(tape, a->parameters, b->parameters);
}

static bool are_joins_opposite(const csg_tape *tape, const csg_tape_node *a, const csg_tape_node *b)
{
    if (!a->join || !b->join)
        return !a->join && !b->join;
    return a->join != b->join && a->join_blend == b->join_blend && keeps_constants(a->join_blend) &&
           are_parameters_same(tape, a->join_parameters, b->join_parameters);
}

bool csg_slopes_are_opposite(const csg_slopes_walker *w, const csg_slopes_operand *a,
                             const csg_slopes_operand *b)
{
    const csg_slopes_nodes *of_a = &w->nodes[a - w->stack], *of_b = &w->nodes[b - w->stack];
    uint32_t count = of_a->end - of_a->first;
    if (of_b->end - of_b->first != count)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        const csg_tape_node *p = &w->tape->nodes[of_a->first + i],
                            *q = &w->tape->nodes[of_b->first + i];
        bool is_leaf = csg_op_is_leaf(p->op);
        if (!(is_leaf ? are_leaves_opposite : are_operators_opposite)(w->tape, p, q))
            return false;
        if (i + 1 < count && !are_joins_opposite(w->tape, p, q))
            return false;
    }
    return true;
}
