/* SPDX-License-Identifier: MIT
 * See same_leaf.h.
 */
#include "field/same_leaf.h"

#include <string.h>

#include "scene/primitives/primitive.h"

/* How many own numbers are to be compared; 0: of another kind of leaf. */
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

bool csg_tape_is_same_leaf(const csg_tape *tape, const csg_tape_node *a, const csg_tape_node *b)
{
    const float *p = tape->parameters + a->parameters, *q = tape->parameters + b->parameters;
    uint32_t count = own_count_of(a);
    if (a->op != b->op || a->frame != b->frame || !count)
        return false;
    uint32_t end = csg_tape_own_at(a) - a->parameters + count;
    return !memcmp(p + CSG_LEAF_FRAME, q + CSG_LEAF_FRAME,
                   (end - CSG_LEAF_FRAME) * sizeof(float)) &&
           are_warps_same(tape, a->warp, b->warp);
}
