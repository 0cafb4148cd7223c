/* SPDX-License-Identifier: MIT
 * See units.h. Parents have larger numbers than their children, so one loop downwards hands places
 * and looks on.
 */
#include "mesh/own/units.h"

#include <string.h>

#include "scene/operators/blend_kinds.h"
#include "shape/polyhedra/polyhedron.h"

/* More units than that are meshed as ever: each is held against each. */
enum { MOST_UNITS = 4096 };

/* What stands above a node. */
typedef struct above {
    csg_affine place;
    csg_look look;
} above;

static bool is_unit(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_SHAPE &&
           scene->shapes[node->payload]->kind == CSG_SHAPE_POLYHEDRON;
}

/* The number of units; 0: there is something else. */
static size_t count_units(const csgm_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        bool is_way = node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
                      (node->kind == CSG_NODE_UNION && csg_blend_is_sharp(node->blend));
        if (is_unit(scene, node))
            count++;
        else if (!is_way)
            return 0;
    }
    return count <= MOST_UNITS ? count : 0;
}

static above below(const csgm_scene *scene, const csg_node *node, above a)
{
    if (node->kind == CSG_NODE_TRANSFORM)
        a.place = csg_affine_multiply(a.place, scene->transforms[node->payload]);
    else if (node->kind == CSG_NODE_COLOR)
        csg_look_take_inner(&a.look, &scene->looks[node->payload]);
    return a;
}

/* room: for what is above each node. */
static void place_units(csg_own_units *units, const csgm_scene *scene, above *room)
{
    size_t left = units->count;
    room[scene->root] = (above){.place = csg_affine_identity()};
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        if (is_unit(scene, node)) {
            const csg_shape *shape = scene->shapes[node->payload];
            units->items[--left] =
                (csg_own_unit){.shape = shape,
                               .place = room[i].place,
                               .look = room[i].look,
                               .box = csg_affine_box(&room[i].place, shape->box)};
            continue;
        }
        above a = below(scene, node, room[i]);
        for (uint32_t k = 0; k < node->child_count; k++)
            room[csg_scene_children(scene, node)[k]] = a;
    }
}

/* By more than rounding moves anything. */
static bool are_apart(const csg_own_units *units)
{
    static const double ROUNDING = 0x1p-20;
    csg_box all = csg_box_empty();
    for (size_t i = 0; i < units->count; i++)
        all = csg_box_hull(all, units->items[i].box);
    double farthest = fmax(csg_vec3_norm(all.min), csg_vec3_norm(all.max));
    for (size_t i = 0; i < units->count; i++) {
        csg_box box = csg_box_grow(units->items[i].box, ROUNDING * farthest);
        for (size_t k = 0; k < i; k++)
            if (!csg_box_is_empty(csg_box_intersect(box, units->items[k].box)))
                return false;
    }
    return true;
}

static void number(csg_own_units *units)
{
    for (size_t i = 0; i < units->count; i++) {
        csg_own_unit *unit = &units->items[i];
        const csg_triangles *triangles = csg_polyhedron_triangles(unit->shape);
        unit->first_vertex = (uint32_t)units->vertex_count;
        unit->first_triangle = (uint32_t)units->triangle_count;
        units->vertex_count += triangles->point_count;
        units->triangle_count += triangles->count;
    }
}

csgm_status csg_own_units_find(csg_own_units *units, const csgm_scene *scene)
{
    static const uint64_t MOST = UINT32_MAX / 3 - 1; /* corners have numbers too */
    *units = (csg_own_units){.memory = &scene->context->memory};
    size_t count = count_units(scene), bytes = scene->node_count * sizeof(above);
    if (!count)
        return CSGM_OK;
    above *room = csg_memory_alloc(units->memory, bytes);
    units->items = csg_memory_alloc(units->memory, count * sizeof *units->items);
    if (units->items)
        units->count = count;
    bool done = room && units->items;
    if (done)
        place_units(units, scene, room);
    csg_memory_release(units->memory, room, bytes);
    if (!done)
        return CSGM_ERR_MEMORY;
    number(units);
    if (units->vertex_count > MOST || units->triangle_count > MOST || !are_apart(units))
        csg_own_units_reset(units);
    return CSGM_OK;
}

void csg_own_units_reset(csg_own_units *units)
{
    csg_memory_release(units->memory, units->items, units->count * sizeof *units->items);
    units->items = NULL;
    units->count = 0;
}
