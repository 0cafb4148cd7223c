/* SPDX-License-Identifier: MIT
 * Operands of which one is the other's negative but for a constant, as the two sides of a wall are
 * where a solid is hollowed by itself, moved inwards; see slopes.h. However little is known of
 * their gradients, these add up to nothing.
 */
#include <string.h>

#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/blends.h"
#include "scene/primitives/primitive.h"

/* Of a leaf that is looked at, as floats: the frame, and its own numbers. 0: of a kind that is
 * not. */
static uint32_t own_count_of(const csg_tape_node *leaf)
{
    if (leaf->op == CSG_OP_SHAPE || leaf->op == CSG_OP_FIELD)
        return 1;
    return csg_op_is_primitive(leaf->op)
               ? (uint32_t)csg_primitive_of(csg_op_node_kind(leaf->op))->own_count
               : 0;
}

/* One behind the other: every body has its own. */
static bool are_warps_same(const csg_tape *tape, uint32_t a, uint32_t b)
{
    while (a != b) {
        if (!a || !b)
            return false;
        const csg_tape_warp *p = &tape->warps[a - 1], *q = &tape->warps[b - 1];
        if (p->kind != q->kind || memcmp(p->frame, q->frame, sizeof p->frame) != 0 ||
            memcmp(p->own, q->own, sizeof p->own) != 0)
            return false;
        a = p->outer;
        b = q->outer;
    }
    return true;
}

static bool are_leaves_opposite(const csg_tape *tape, const csg_tape_node *a,
                                const csg_tape_node *b)
{
    const float *p = tape->parameters + a->parameters, *q = tape->parameters + b->parameters;
    uint32_t count = own_count_of(a);
    if (a->op != b->op || a->frame != b->frame || !count ||
        p[CSG_LEAF_SIGMA] + q[CSG_LEAF_SIGMA] != 0 || !are_warps_same(tape, a->warp, b->warp))
        return false;
    uint32_t end = csg_tape_own_at(a) - a->parameters + count;
    return !memcmp(p + CSG_LEAF_FRAME, q + CSG_LEAF_FRAME, (end - CSG_LEAF_FRAME) * sizeof(float));
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
