/* SPDX-License-Identifier: MIT
 * See excerpt.h: made by the builder, from a copy of the whole scene's nodes, under a new root.
 */
#include "scene/tree/excerpt.h"

#include <string.h>

#include "scene/operators/rule.h"
#include "scene/tree/build_private.h"

/* array: where the pointer stands. */
static bool load_array(csg_memory *memory, void *array, size_t *capacity, const void *from,
                       size_t count, size_t bytes)
{
    void *data = NULL;
    if (!count)
        return true;
    if (!csg_memory_reserve(memory, &data, capacity, count, bytes))
        return false;
    memcpy(data, from, count * bytes);
    memcpy(array, &data, sizeof data);
    return true;
}

static bool load_shapes(csg_scene_builder *b, const csgm_scene *from)
{
    csgm_scene *scene = b->scene;
    if (!load_array(&b->context->memory, &scene->shapes, &b->shape_capacity, from->shapes,
                    from->shape_count, sizeof *scene->shapes))
        return false;
    scene->shape_count = from->shape_count;
    for (size_t i = 0; i < scene->shape_count; i++)
        csg_shape_retain(scene->shapes[i]);
    return true;
}

bool csg_excerpt_load(csg_scene_builder *b, const csgm_scene *from)
{
    csg_memory *memory = &b->context->memory;
    csgm_scene *to = b->scene;
#define LOAD(array, room, number)                                                                  \
    (load_array(memory, &to->array, &b->room, from->array, from->number, sizeof *to->array) &&     \
     ((to->number = from->number), true))
    return LOAD(nodes, node_capacity, node_count) && LOAD(children, child_capacity, child_count) &&
           LOAD(parameters, parameter_capacity, parameter_count) &&
           LOAD(transforms, transform_capacity, transform_count) &&
           LOAD(looks, look_capacity, look_count) &&
           LOAD(formulas, formula_capacity, formula_count) &&
           LOAD(steps, step_capacity, step_count) && LOAD(warps, warp_capacity, warp_count) &&
           LOAD(rules, rule_capacity, rule_count) && load_shapes(b, from);
#undef LOAD
}

csg_node_id csg_excerpt_place(csg_scene_builder *b, const csg_excerpt_item *item)
{
    csg_look look = item->look;
    csg_span where = b->scene->nodes[item->node].where;
    csg_node_id node = csg_build_transform(b, &item->place, item->node, where);
    look.part = 0;
    bool plain = !look.has_color && !look.has_material;
    return node == CSG_NODE_NONE || plain ? node : csg_build_look(b, &look, node, where);
}

/* nodes: room for all items. */
static csg_node_id build(csg_scene_builder *b, const csg_excerpt *excerpt, csg_span where,
                         csg_node_id *nodes)
{
    for (size_t i = 0; i < excerpt->count; i++) {
        nodes[i] = csg_excerpt_place(b, &excerpt->items[i]);
        if (nodes[i] == CSG_NODE_NONE)
            return CSG_NODE_NONE;
    }
    csg_node_id node =
        csg_build_operator(b, excerpt->kind, CSG_SHARP, nodes, excerpt->count, where);
    if (csg_box_is_empty(excerpt->within) || node == CSG_NODE_NONE)
        return node;
    csg_node_id both[] = {csg_build_block(b, excerpt->within, where), node};
    return both[0] == CSG_NODE_NONE
               ? CSG_NODE_NONE
               : csg_build_operator(b, CSG_NODE_INTERSECTION, CSG_SHARP, both, 2, where);
}

csgm_status csg_scene_excerpt(const csgm_scene *scene, const csg_excerpt *excerpt, csgm_scene **out)
{
    csg_scene_builder b;
    csgm_context *context = scene->context;
    size_t bytes = excerpt->count * sizeof(csg_node_id);
    csg_node_id *nodes = csg_memory_alloc(&context->memory, bytes);
    csgm_status status = nodes ? csg_build_begin(&b, context) : CSGM_ERR_MEMORY;
    if (status == CSGM_OK) {
        if (!csg_excerpt_load(&b, scene))
            csg_build_no_memory(&b);
        else
            csg_build_finish(&b, build(&b, excerpt, scene->nodes[scene->root].where, nodes), NULL,
                             0, out);
        status = b.status;
        csg_build_abandon(&b);
    }
    if (status == CSGM_OK) {
        (*out)->texts = scene->texts;
        (*out)->text_count = scene->text_count;
    }
    csg_memory_release(&context->memory, nodes, bytes);
    return status;
}
