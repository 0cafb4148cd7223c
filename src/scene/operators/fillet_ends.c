/* SPDX-License-Identifier: MIT
 * Where the fillets of a scene end, kept in it; see union_ends.h.
 */
#include <math.h>
#include <string.h>

#include "scene/operators/union_ends.h"

typedef struct kept {
    csgm_scene *scene;
    csg_fillet_end *ends;
    double *reaches;
    size_t count, capacity, reach_count, reach_capacity;
} kept;

/* A half-space that holds all that the cylinder does, for each operand: n . p is no more than
 * n . foot and the distance from the axis. */
static bool is_behind(const csg_union_ends *found, size_t half_space, size_t cylinder,
                      uint32_t operands)
{
    const csg_fillet_end *plane = &found->ends[half_space], *round = &found->ends[cylinder];
    double at = csg_vec3_dot(plane->normal, round->foot);
    if (plane->is_round || !round->is_round || fabs(csg_vec3_dot(plane->normal, round->normal)) > 0)
        return false;
    for (uint32_t k = 0; k < operands; k++)
        if (!(found->reaches[k * found->count + half_space] >=
              at + found->reaches[k * found->count + cylinder]))
            return false;
    return true;
}

/* What ends at a cylinder ends at no half-space around it. */
static bool is_needed(const csg_union_ends *found, size_t i, uint32_t operands)
{
    for (size_t k = 0; k < found->count; k++)
        if (is_behind(found, i, k, operands))
            return false;
    return true;
}

/* Behind those found before. */
static bool keep(void *user, csg_node_id id, const csg_union_ends *found)
{
    kept *k = user;
    const csg_node *node = &k->scene->nodes[id];
    csg_memory *memory = &k->scene->context->memory;
    size_t most = found->count * node->child_count, needed = 0, at = 0;
    void *ends = k->ends, *reached = k->reaches;
    if (!csg_memory_reserve(memory, &ends, &k->capacity, k->count + found->count, sizeof *k->ends))
        return false;
    k->ends = ends;
    if (!csg_memory_reserve(memory, &reached, &k->reach_capacity, k->reach_count + most,
                            sizeof *k->reaches))
        return false;
    k->reaches = reached;
    for (size_t i = 0; i < found->count; i++)
        needed += is_needed(found, i, node->child_count);
    for (size_t i = 0; i < found->count; i++) {
        if (!is_needed(found, i, node->child_count))
            continue;
        k->ends[k->count + at] = found->ends[i];
        for (uint32_t n = 0; n < node->child_count; n++)
            k->reaches[k->reach_count + n * needed + at] = found->reaches[n * found->count + i];
        at++;
    }
    double *v = k->scene->parameters + node->payload;
    v[CSG_FILLET_FIRST_NORMAL] = (double)k->count;
    v[CSG_FILLET_FIRST_REACH] = (double)k->reach_count;
    v[CSG_FILLET_PLANES] = (double)needed;
    k->count += needed;
    k->reach_count += needed * node->child_count;
    return true;
}

csgm_status csg_fillet_planes_find(csgm_scene *scene)
{
    kept k = {.scene = scene};
    csgm_status status = csg_union_ends_find(scene, csg_node_is_fillet, keep, &k);
    if (status == CSGM_OK && k.count) {
        scene->ends = csg_arena_calloc(&scene->arena, k.count, sizeof *k.ends);
        scene->reaches = csg_arena_calloc(&scene->arena, k.reach_count, sizeof *k.reaches);
        status = scene->ends && scene->reaches ? CSGM_OK : CSGM_ERR_MEMORY;
    }
    if (status == CSGM_OK && k.count) {
        memcpy(scene->ends, k.ends, k.count * sizeof *k.ends);
        memcpy(scene->reaches, k.reaches, k.reach_count * sizeof *k.reaches);
    }
    csg_memory_release(&scene->context->memory, k.ends, k.capacity * sizeof *k.ends);
    csg_memory_release(&scene->context->memory, k.reaches, k.reach_capacity * sizeof *k.reaches);
    return status;
}
