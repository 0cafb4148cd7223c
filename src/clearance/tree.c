/* SPDX-License-Identifier: MIT
 * See tree.h.
 */
#include "clearance/tree.h"

#include <string.h>

static bool add(csg_clear_tree *t, csg_measure_cube *cube)
{
    csg_halves halves;
    csg_clear_pieces *pieces = NULL;
    csg_memory *memory = &t->part->walk.context->memory;
    if (cube->state == CSG_CELL_SURFACE &&
        csg_measure_enclose(&t->part->walk, t->worker, cube, &halves) &&
        cube->state == CSG_CELL_SURFACE) {
        pieces = csg_arena_alloc(&t->arena, sizeof *pieces);
        if (!pieces)
            return false;
        csg_clear_pieces_find(&halves, cube->half, pieces);
        if (!pieces->count)
            cube->state = CSG_CELL_OUTSIDE;
    }
    if (cube->state == CSG_CELL_OUTSIDE)
        return true;
    if (!csg_memory_reserve(memory, (void **)&t->nodes, &t->capacity, t->count + 1,
                            sizeof *t->nodes))
        return false;
    t->nodes[t->count++] = (csg_clear_node){.cube = *cube, .pieces = pieces};
    return true;
}

bool csg_clear_tree_begin(csg_clear_tree *t, const csg_clear_part *part, uint32_t worker)
{
    csg_measure_cube root = csg_measure_root(&part->walk);
    *t = (csg_clear_tree){.part = part, .worker = &part->walk.workers[worker]};
    csg_arena_init(&t->arena, &part->walk.context->memory);
    return add(t, &root);
}

void csg_clear_tree_release(csg_clear_tree *t)
{
    csg_memory *memory = t->arena.memory;
    if (!memory)
        return;
    csg_memory_release(memory, t->nodes, t->capacity * sizeof *t->nodes);
    csg_arena_reset(&t->arena);
}

bool csg_clear_tree_may_divide(const csg_clear_tree *t, uint32_t node)
{
    const csg_measure_cube *cube = &t->nodes[node].cube;
    return cube->state == CSG_CELL_SURFACE && cube->level < CSG_MEASURE_DEEPEST;
}

bool csg_clear_tree_divide(csg_clear_tree *t, uint32_t node)
{
    csg_measure_cube children[CSG_OCTANTS];
    if (t->nodes[node].is_divided)
        return true;
    if (!csg_measure_divide(&t->part->walk, t->worker, &t->nodes[node].cube, &t->arena, children))
        return false;
    uint32_t first = (uint32_t)t->count;
    for (int o = 0; o < CSG_OCTANTS; o++)
        if (children[o].state != CSG_CELL_OUTSIDE && !add(t, &children[o]))
            return false;
    t->nodes[node].first_child = first;
    t->nodes[node].child_count = (uint8_t)(t->count - first);
    t->nodes[node].is_divided = true;
    return true;
}

csg_vec3 csg_clear_offset(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                          uint32_t cube_b)
{
    const double *ca = a->nodes[cube_a].cube.c, *cb = b->nodes[cube_b].cube.c;
    csg_vec3 between = csg_vec3_sub(csg_clear_part_origin(b->part), csg_clear_part_origin(a->part));
    return csg_vec3_make(between.x + (cb[0] - ca[0]), between.y + (cb[1] - ca[1]),
                         between.z + (cb[2] - ca[2]));
}

int csg_clear_choose(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                     uint32_t cube_b)
{
    bool may_a = csg_clear_tree_may_divide(a, cube_a), may_b = csg_clear_tree_may_divide(b, cube_b);
    if (may_a && may_b)
        return a->nodes[cube_a].cube.half >= b->nodes[cube_b].cube.half ? 0 : 1;
    return may_a ? 0 : may_b ? 1 : -1;
}
