/* SPDX-License-Identifier: MIT
 * Fillets on the tape: how far the field strays because of them from one with a Lipschitz constant.
 */
#include "field/compile/compile_private.h"

#include <math.h>

#include "scene/operators/fillet.h"

/* Of a fillet alone: it lies between its largest operand and that plus this. */
static float excess_of(const csg_tape *tape, const csg_tape_node *node)
{
    float r = tape->parameters[node->parameters + CSG_OPERATOR_N];
    return node->arity > 2 ? r : (float)CSG_FILLET_PAIR_EXCESS * r;
}

/* Operators of lengths hand on how far their operands stray. */
bool csg_compile_waver(csg_memory *memory, csg_tape *tape)
{
    uint32_t top = 0, depth = csg_tape_depth(tape);
    float *stack = csg_memory_alloc(memory, depth * sizeof *stack);
    if (!stack)
        return false;
    tape->waver = 0;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        if (csg_op_is_leaf(node->op))
            stack[top++] = 0;
        for (uint32_t k = 1; csg_op_takes_all(node->op) && k < node->arity; k++, top--)
            stack[top - 2] = fmaxf(stack[top - 2], stack[top - 1]);
        if (csg_op_is_fillet(node->op)) {
            stack[top - 1] += excess_of(tape, node);
            tape->turns = true;
        }
        bool bends = node->op == CSG_OP_COMBINE || csg_op_delivers(node->op);
        if (bends && stack[top - 1] > 0)
            stack[top - 1] = INFINITY;
        if (node->join_blend == CSG_BLEND_TURNING && node->join)
            stack[top - 2] = INFINITY;
        if (node->join) {
            top--;
            stack[top - 1] = fmaxf(stack[top - 1], stack[top]);
        }
    }
    tape->waver = stack[0];
    csg_memory_release(memory, stack, depth * sizeof *stack);
    return true;
}
