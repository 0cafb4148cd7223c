/* SPDX-License-Identifier: MIT
 * Where the fillets of a scene end, kept in it; see union_ends.h.
 */
#include <string.h>

#include "scene/operators/union_ends.h"

typedef struct kept {
    csgm_scene *scene;
    csg_fillet_end *ends;
    double *reaches;
    size_t count, capacity, reach_count, reach_capacity;
} kept;

/* Behind those found before. */
static bool keep(void *user, csg_node_id id, const csg_union_ends *found)
{
    kept *k = user;
    const csg_node *node = &k->scene->nodes[id];
    csg_memory *memory = &k->scene->context->memory;
    size_t reaches = found->count * node->child_count;
    void *ends = k->ends, *reached = k->reaches;
    if (!csg_memory_reserve(memory, &ends, &k->capacity, k->count + found->count, sizeof *k->ends))
        return false;
    k->ends = ends;
    if (!csg_memory_reserve(memory, &reached, &k->reach_capacity, k->reach_count + reaches,
                            sizeof *k->reaches))
        return false;
    k->reaches = reached;
    if (found->count) {
        memcpy(k->ends + k->count, found->ends, found->count * sizeof *k->ends);
        memcpy(k->reaches + k->reach_count, found->reaches, reaches * sizeof *k->reaches);
    }
    double *v = k->scene->parameters + node->payload;
    v[CSG_FILLET_FIRST_NORMAL] = (double)k->count;
    v[CSG_FILLET_FIRST_REACH] = (double)k->reach_count;
    v[CSG_FILLET_PLANES] = (double)found->count;
    k->count += found->count;
    k->reach_count += reaches;
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
