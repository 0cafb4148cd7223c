/* SPDX-License-Identifier: MIT
 * Parts of a scene; see parts.h.
 */
#include "scene/tree/parts.h"

#include <string.h>

#include "scene/operators/rule.h"
#include "scene/tree/build.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"
#include "scene/tree/excerpt.h"

/* ---- finding ------------------------------------------------------------------------------- */

typedef struct finder {
    csg_parts *parts;
    csg_memory *memory;
    csg_part_unit *stack; /* still to be looked at */
    size_t stack_count, stack_room;
    uint8_t *counts; /* per node: a COLOR node whose part does count */
} finder;

static bool add_way(finder *f, const csg_part_way *way)
{
    csg_parts *parts = f->parts;
    if (!csg_memory_reserve(f->memory, (void **)&parts->ways, &parts->way_room,
                            parts->way_count + 1, sizeof *way))
        return false;
    parts->ways[parts->way_count++] = *way;
    return true;
}

/* What a node adds to the way to its children. */
static bool descend(finder *f, csg_part_unit *at)
{
    csg_parts *parts = f->parts;
    const csgm_scene *scene = parts->scene;
    const csg_node *node = &scene->nodes[at->node];
    csg_part_way way = parts->ways[at->way];
    if (node->kind == CSG_NODE_UNION)
        return true;
    if (node->kind == CSG_NODE_TRANSFORM) {
        way.place = csg_affine_multiply(way.place, scene->transforms[node->payload]);
    } else {
        const csg_look *look = &scene->looks[node->payload];
        csg_look_take_inner(&way.look, look);
        f->counts[at->node] = look->part && !way.look.part;
        way.look.part = way.look.part ? way.look.part : look->part;
    }
    at->way = (uint32_t)parts->way_count;
    return add_way(f, &way);
}

static bool is_way(const csg_node *node)
{
    return node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
           (node->kind == CSG_NODE_UNION && csg_blend_is_sharp(node->blend));
}

static bool push_unit(finder *f, csg_part_unit item)
{
    if (!csg_memory_reserve(f->memory, (void **)&f->stack, &f->stack_room, f->stack_count + 1,
                            sizeof item))
        return false;
    f->stack[f->stack_count++] = item;
    return true;
}

/* Children are pushed from the last on, so that units come in their order. */
static bool visit(finder *f)
{
    csg_parts *parts = f->parts;
    const csgm_scene *scene = parts->scene;
    csg_part_unit at = f->stack[--f->stack_count];
    const csg_node *node = &scene->nodes[at.node];
    if (!is_way(node)) {
        if (!csg_memory_reserve(f->memory, (void **)&parts->units, &parts->unit_room,
                                parts->unit_count + 1, sizeof at))
            return false;
        parts->units[parts->unit_count++] = at;
        return true;
    }
    if (!descend(f, &at))
        return false;
    for (uint32_t i = node->child_count; i-- > 0;)
        if (!push_unit(f, (csg_part_unit){csg_scene_children(scene, node)[i], at.way}))
            return false;
    return true;
}

static bool find_units(finder *f)
{
    csg_parts *parts = f->parts;
    const csgm_scene *scene = parts->scene;
    csg_part_way start = {.place = csg_affine_identity()};
    memset(f->counts, 0, scene->node_count);
    bool done = add_way(f, &start) && push_unit(f, (csg_part_unit){scene->root, 0});
    while (done && f->stack_count)
        done = visit(f);
    for (csg_node_id i = 0; done && i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        if (node->kind != CSG_NODE_COLOR || !scene->looks[node->payload].part || f->counts[i])
            continue;
        done = csg_memory_reserve(f->memory, (void **)&parts->lost, &parts->lost_room,
                                  parts->lost_count + 1, sizeof i);
        if (done)
            parts->lost[parts->lost_count++] = i;
    }
    return done;
}

static bool names_parts(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->look_count; i++)
        if (scene->looks[i].part)
            return true;
    return false;
}

/* Parts with units, by their numbers; none when there is only the one without a name. */
static bool count_parts(csg_parts *parts, csg_memory *memory)
{
    size_t most = (size_t)parts->scene->part_count + 1;
    uint8_t *seen = csg_memory_alloc(memory, most);
    bool done = seen && csg_memory_reserve(memory, (void **)&parts->numbers, &parts->number_room,
                                           most, sizeof *parts->numbers);
    if (done)
        memset(seen, 0, most);
    for (size_t i = 0; done && i < parts->unit_count; i++)
        seen[parts->ways[parts->units[i].way].look.part] = 1;
    for (uint32_t i = 0; done && i < most; i++)
        if (seen[i])
            parts->numbers[parts->count++] = i;
    if (parts->count == 1 && parts->numbers[0] == 0)
        parts->count = 0;
    csg_memory_release(memory, seen, most);
    return done;
}

csgm_status csg_parts_find(csg_parts *parts, const csgm_scene *scene)
{
    csg_memory *memory = &scene->context->memory;
    *parts = (csg_parts){.scene = scene};
    if (!names_parts(scene))
        return CSGM_OK;
    finder f = {.parts = parts, .memory = memory};
    f.counts = csg_memory_alloc(memory, scene->node_count);
    bool done = f.counts && find_units(&f) && count_parts(parts, memory);
    csg_memory_release(memory, f.counts, scene->node_count);
    csg_memory_release(memory, f.stack, f.stack_room * sizeof *f.stack);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

void csg_parts_reset(csg_parts *parts)
{
    csg_memory *memory = &parts->scene->context->memory;
    csg_memory_release(memory, parts->ways, parts->way_room * sizeof *parts->ways);
    csg_memory_release(memory, parts->units, parts->unit_room * sizeof *parts->units);
    csg_memory_release(memory, parts->numbers, parts->number_room * sizeof *parts->numbers);
    csg_memory_release(memory, parts->lost, parts->lost_room * sizeof *parts->lost);
    *parts = (csg_parts){.scene = parts->scene};
}

const char *csg_parts_name(const csg_parts *parts, size_t index)
{
    uint32_t number = parts->numbers[index];
    return number ? parts->scene->part_names[number - 1] : NULL;
}

bool csg_parts_index(const csg_parts *parts, const char *name, size_t *index)
{
    for (size_t i = 0; i < parts->count; i++) {
        const char *own = csg_parts_name(parts, i);
        *index = i;
        if (own && name ? strcmp(own, name) == 0 : own == name)
            return true;
    }
    return false;
}

csg_box csg_parts_box(const csg_parts *parts, size_t index)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < parts->unit_count; i++) {
        const csg_part_unit *unit = &parts->units[i];
        const csg_part_way *way = &parts->ways[unit->way];
        if (way->look.part == parts->numbers[index])
            box = csg_box_hull(box, csg_affine_box(&way->place, parts->scene->bounds[unit->node]));
    }
    return box;
}

/* ---- a part alone ---------------------------------------------------------------------------- */

csgm_status csg_parts_scene(const csg_parts *parts, size_t index, csgm_scene **out)
{
    csg_memory *memory = &parts->scene->context->memory;
    size_t count = 0, bytes = parts->unit_count * sizeof(csg_excerpt_item);
    csg_excerpt_item *items = csg_memory_alloc(memory, bytes);
    if (!items)
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < parts->unit_count; i++) {
        const csg_part_way *way = &parts->ways[parts->units[i].way];
        if (way->look.part == parts->numbers[index])
            items[count++] = (csg_excerpt_item){parts->units[i].node, way->place, way->look};
    }
    const csg_excerpt excerpt = {
        .kind = CSG_NODE_UNION, .items = items, .count = count, .within = csg_box_empty()};
    csgm_status status = csg_scene_excerpt(parts->scene, &excerpt, out);
    csg_memory_release(memory, items, bytes);
    return status;
}

/* ---- naming ---------------------------------------------------------------------------------- */

/* The number of a name, 0 after a failure. */
static uint32_t intern(csg_scene_builder *b, const char *name)
{
    enum { MOST = 10000 };
    csgm_scene *scene = b->scene;
    csg_memory *memory = &b->context->memory;
    size_t bytes = strlen(name) + 1;
    for (uint32_t i = 0; i < scene->part_count; i++)
        if (strcmp(scene->part_names[i], name) == 0)
            return i + 1;
    if (scene->part_count == MOST) {
        csg_check_fail(b, CSGM_ERR_LIMIT, "the scene has more than %d parts", MOST);
        return 0;
    }
    char *copy = csg_memory_reserve(memory, (void **)&scene->part_names, &b->part_capacity,
                                    scene->part_count + 1, sizeof *scene->part_names)
                     ? csg_memory_alloc(memory, bytes)
                     : NULL;
    if (!copy) {
        csg_build_no_memory(b);
        return 0;
    }
    memcpy(copy, name, bytes);
    scene->part_names[scene->part_count++] = copy;
    return scene->part_count;
}

csg_node_id csg_build_part(csg_scene_builder *b, const char *name, csg_node_id child,
                           csg_span where)
{
    if (!csg_build_is_usable(b, child))
        return CSG_NODE_NONE;
    csg_look look = {.part = intern(b, name)};
    return look.part ? csg_build_look(b, &look, child, where) : CSG_NODE_NONE;
}
