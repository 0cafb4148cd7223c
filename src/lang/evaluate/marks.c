/* SPDX-License-Identifier: MIT
 * Marks of # and %; see marks.h.
 */
#include "lang/evaluate/marks.h"

/* What is in the solid as well is copied: the builder changes nodes that it moves. */
void csg_marks_add(csg_eval *e, size_t first_part, csgm_mark kind, csg_span where)
{
    for (size_t i = first_part; i < e->part_count && !e->stop; i++) {
        csg_node_id node = e->parts[i].node;
        if (csg_eval_is_empty(e, node))
            continue;
        if (kind == CSGM_MARK_HIGHLIGHT)
            node = csg_check_node(e, csg_build_copy(&e->builder, node), where);
        if (node == CSG_NODE_NONE)
            return;
        if (csg_memory_reserve(&e->context->memory, (void **)&e->marks, &e->mark_capacity,
                               e->mark_count + 1, sizeof *e->marks))
            e->marks[e->mark_count++] = (csg_mark){node, kind};
        else
            csg_eval_no_memory(e);
    }
}

/* NONE of none. */
static csg_node_id unite_nodes(csg_eval *e, const csg_node_id *nodes, size_t count, csg_span where)
{
    const csg_blend sharp = CSG_SHARP;
    if (count < 2)
        return count ? nodes[0] : CSG_NODE_NONE;
    return csg_check_node(
        e, csg_build_operator(&e->builder, CSG_NODE_UNION, sharp, nodes, count, where), where);
}

/* Those of one kind and dimension from `first` on, united; NONE where there is none. */
static csg_node_id unite(csg_eval *e, size_t first, csgm_mark kind, bool flat, csg_span where)
{
    size_t most = e->mark_count - first, bytes = most * sizeof(csg_node_id), count = 0;
    if (most == 0 || e->stop)
        return CSG_NODE_NONE;
    csg_node_id *nodes = csg_memory_alloc(&e->context->memory, bytes);
    if (!nodes) {
        csg_eval_no_memory(e);
        return CSG_NODE_NONE;
    }
    for (size_t i = first; i < e->mark_count; i++)
        if (e->marks[i].kind == kind && csg_eval_is_flat(e, e->marks[i].node) == flat)
            nodes[count++] = e->marks[i].node;
    csg_node_id node = unite_nodes(e, nodes, count, where);
    csg_memory_release(&e->context->memory, nodes, bytes);
    return node;
}

void csg_marks_move(csg_eval *e, size_t first, const csg_affine *by, csg_span where)
{
    csg_mark moved[2 * CSGM_MARK_COUNT];
    size_t count = 0;
    for (int i = 0; i < 2 * CSGM_MARK_COUNT && e->mark_count > first; i++) {
        csgm_mark kind = (csgm_mark)(i / 2);
        bool flat = i % 2;
        csg_affine map = flat ? csg_affine_of_plane(*by) : *by;
        csg_node_id node = unite(e, first, kind, flat, where);
        if (node == CSG_NODE_NONE || csg_affine_determinant(map) == 0)
            continue;
        node = csg_check_node(e, csg_build_transform(&e->builder, &map, node, where), where);
        if (node != CSG_NODE_NONE)
            moved[count++] = (csg_mark){node, kind};
    }
    e->mark_count = e->mark_count > first ? first : e->mark_count;
    for (size_t i = 0; i < count; i++) /* not more than there were */
        e->marks[e->mark_count++] = moved[i];
}

void csg_marks_take(csg_eval *e, size_t first, csg_span where, csg_node_id out[CSGM_MARK_COUNT])
{
    for (int kind = 0; kind < CSGM_MARK_COUNT; kind++) {
        csg_node_id both[2] = {unite(e, first, (csgm_mark)kind, false, where),
                               unite(e, first, (csgm_mark)kind, true, where)};
        if (both[1] != CSG_NODE_NONE) /* as thick as a scene that is flat */
            both[1] = csg_eval_plate(e, both[1], where);
        if (both[0] == CSG_NODE_NONE || both[1] == CSG_NODE_NONE)
            out[kind] = both[0] != CSG_NODE_NONE ? both[0] : both[1];
        else
            out[kind] = unite_nodes(e, both, 2, where);
    }
    e->mark_count = first;
}
