/* SPDX-License-Identifier: MIT
 * See units.h. Parents have larger numbers than their children, so one loop downwards hands places
 * and looks on.
 */
#include "mesh/own/units.h"

#include <string.h>

#include "scene/primitives/kinds.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"
#include "shape/polyhedra/prism.h"

/* More units than that are meshed as ever: each is held against each. */
enum { MOST_UNITS = 4096 };

/* What stands above a node. */
typedef struct above {
    csg_affine place;
    csg_look look;
    bool is_taken; /* it is of a unit that stands above */
} above;

static bool is_shape(const csgm_scene *scene, const csg_node *node, csg_shape_kind kind)
{
    return node->kind == CSG_NODE_SHAPE && scene->shapes[node->payload]->kind == kind;
}

static bool is_sharp_box(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_BOX && !(csg_scene_parameters(scene, node)[3] > 0);
}

static bool is_sharp_rectangle(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_RECTANGLE && !(csg_scene_parameters(scene, node)[2] > 0);
}

/* At most so many units; 0: there is something that is in no such scene. */
static size_t most_units(const csgm_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        bool is_way = node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
                      node->kind == CSG_NODE_SLAB || is_shape(scene, node, CSG_SHAPE_REGION) ||
                      is_sharp_rectangle(scene, node) ||
                      (csg_node_is_operator(node->kind) && csg_blend_is_sharp(node->blend));
        if (is_shape(scene, node, CSG_SHAPE_POLYHEDRON) || csg_node_is_plate(node) ||
            is_sharp_box(scene, node))
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

/* ---- boxes -------------------------------------------------------------------------------------
 */

/* half: sizes. */
static csgm_status make_box(csg_memory *memory, csg_vec3 half, double middle, csg_own_unit *unit)
{
    static const uint32_t SIDES[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    csg_triangles triangles;
    bool added = true;
    csg_triangles_init(&triangles, memory);
    for (int i = 0; i < 8 && added; i++)
        added = csg_triangles_add_point(
            &triangles, csg_vec3_make(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
                                      middle + (i & 4 ? half.z : -half.z)));
    for (int i = 0; i < 6 && added; i++)
        added = csg_triangles_add_face(&triangles, SIDES[i], 4);
    csgm_status status = CSGM_ERR_MEMORY;
    if (added)
        status = csg_polyhedron_create(memory, &triangles, NULL, &unit->shape);
    csg_triangles_release(&triangles);
    return status;
}

/* ---- plates ------------------------------------------------------------------------------------
 */

/* Down to a leaf through transforms and colours. */
static const csg_node *leaf_below(const csgm_scene *scene, const csg_node *node, above *a)
{
    while (node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR) {
        *a = below(scene, node, *a);
        node = &scene->nodes[csg_scene_children(scene, node)[0]];
    }
    return node;
}

/* To places that are floats in the scene, where these are the same all along z: triangles of a lid
 * that are thin are then as thin as they will be. */
static void round_points(csg_outline *outline, const csg_affine *place)
{
    csg_affine back;
    if (place->m[0][2] != 0 || place->m[1][2] != 0 || !csg_affine_invert(*place, &back))
        return;
    for (size_t i = 0; i < outline->point_count; i++) {
        csg_vec2 *p = &outline->points[i];
        csg_vec3 at = csg_affine_point(place, csg_vec3_make(p->x, p->y, 0));
        at.x = (double)(float)at.x;
        at.y = (double)(float)at.y;
        at = csg_affine_point(&back, at);
        *p = (csg_vec2){at.x, at.y};
    }
}

static csgm_status make_prism(const csgm_scene *scene, const csg_node *figure, double half,
                              double middle, csg_own_unit *unit)
{
    csg_memory *memory = &scene->context->memory;
    csg_outline outline;
    csg_triangles triangles;
    csg_repairs repairs;
    csgm_status status = CSGM_ERR_MEMORY;
    csg_outline_init(&outline, memory);
    if (csg_outline_append(&outline, csg_region_outline(scene->shapes[figure->payload]))) {
        round_points(&outline, &unit->place);
        status = csg_prism(memory, &outline, middle - half, middle + half, &triangles);
    }
    csg_outline_release(&outline);
    if (status != CSGM_OK)
        return status;
    status = csg_polyhedron_create(memory, &triangles, &repairs, &unit->shape);
    csg_triangles_release(&triangles);
    return status;
}

/* The unit's shape stays NULL: the plate is none of an outline. */
static csgm_status extrude(const csgm_scene *scene, const csg_node *plate, csg_own_unit *unit)
{
    const csg_node_id *children = csg_scene_children(scene, plate);
    above flat = {.place = csg_affine_identity(), .look = unit->look}, ends = flat;
    const csg_node *figure = leaf_below(scene, &scene->nodes[children[0]], &flat);
    const csg_node *slab = leaf_below(scene, &scene->nodes[children[1]], &ends);
    if (slab->kind != CSG_NODE_SLAB)
        return CSGM_OK;
    unit->place = csg_affine_multiply(unit->place, csg_affine_of_plane(flat.place));
    unit->look = flat.look;
    double half = csg_scene_parameters(scene, slab)[0], middle = ends.place.t[2];
    const double *sizes = csg_scene_parameters(scene, figure);
    csgm_status status = CSGM_OK;
    if (is_shape(scene, figure, CSG_SHAPE_REGION))
        status = make_prism(scene, figure, half, middle, unit);
    else if (is_sharp_rectangle(scene, figure))
        status = make_box(&scene->context->memory, csg_vec3_make(sizes[0], sizes[1], half), middle,
                          unit);
    return status == CSGM_ERR_MEMORY ? status : CSGM_OK;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

/* The unit that a node is. unit->shape stays NULL: it is none. */
static csgm_status take_unit(const csgm_scene *scene, const csg_node *node, const above *a,
                             csg_own_unit *unit)
{
    *unit = (csg_own_unit){
        .place = a->place, .look = a->look, .node = (csg_node_id)(node - scene->nodes)};
    if (csg_node_is_plate(node))
        return extrude(scene, node, unit);
    if (is_sharp_box(scene, node)) {
        const double *half = csg_scene_parameters(scene, node);
        return make_box(&scene->context->memory, csg_vec3_make(half[0], half[1], half[2]), 0, unit);
    }
    if (is_shape(scene, node, CSG_SHAPE_POLYHEDRON)) {
        unit->shape = scene->shapes[node->payload];
        csg_shape_retain(unit->shape);
    }
    return CSGM_OK;
}

/* room: for what is above each node. *all: nothing is left over. Units come from the last to the
 * first. */
static csgm_status place_units(csg_own_units *units, const csgm_scene *scene, above *room,
                               bool *all)
{
    csgm_status status = CSGM_OK;
    *all = true;
    room[scene->root] = (above){.place = csg_affine_identity()};
    for (size_t i = scene->node_count; i-- > 0 && status == CSGM_OK && *all;) {
        const csg_node *node = &scene->nodes[i];
        above a = below(scene, node, room[i]);
        bool is_unit = !a.is_taken && (csg_node_is_plate(node) || !node->child_count);
        if (is_unit) {
            csg_own_unit *unit = &units->items[units->count];
            status = take_unit(scene, node, &a, unit);
            a.is_taken = *all = unit->shape != NULL;
            units->count += unit->shape != NULL;
        }
        for (uint32_t k = 0; k < node->child_count; k++)
            room[csg_scene_children(scene, node)[k]] = a;
    }
    return status;
}

/* In the order of the scene, each with its box. */
static void arrange(csg_own_units *units)
{
    for (size_t i = 0, k = units->count; i < k; i++) {
        csg_own_unit unit = units->items[i];
        units->items[i] = units->items[--k];
        units->items[k] = unit;
    }
    for (size_t i = 0; i < units->count; i++) {
        csg_own_unit *unit = &units->items[i];
        unit->box = csg_affine_box(&unit->place, unit->shape->box);
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

static bool has_unions_only(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        if (csg_node_is_operator(node->kind) && node->kind != CSG_NODE_UNION &&
            !csg_node_is_plate(node))
            return false;
    }
    return true;
}

/* Corners have numbers, too. */
static bool can_be_numbered(const csg_own_units *units)
{
    static const uint64_t MOST = UINT32_MAX / 3 - 1;
    return units->vertex_count <= MOST && units->triangle_count <= MOST;
}

static void number(csg_own_units *units)
{
    units->vertex_count = units->triangle_count = 0;
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
    *units = (csg_own_units){.memory = &scene->context->memory};
    size_t room_bytes = scene->node_count * sizeof(above);
    units->room = most_units(scene);
    if (!units->room)
        return CSGM_OK;
    bool all = false;
    above *room = csg_memory_alloc(units->memory, room_bytes);
    units->items = csg_memory_alloc(units->memory, units->room * sizeof *units->items);
    csgm_status status = CSGM_ERR_MEMORY;
    if (room && units->items)
        status = place_units(units, scene, room, &all);
    csg_memory_release(units->memory, room, room_bytes);
    if (status == CSGM_OK && all) {
        arrange(units);
        number(units);
        units->are_apart = has_unions_only(scene) && are_apart(units);
    }
    if (!all || !can_be_numbered(units))
        csg_own_units_reset(units);
    return status;
}

void csg_own_units_replace(csg_own_units *units, csg_shape *joined)
{
    csg_look look = units->items[0].look;
    for (size_t i = 0; i < units->count; i++)
        csg_shape_release(units->items[i].shape);
    units->items[0] = (csg_own_unit){
        .shape = joined, .place = csg_affine_identity(), .look = look, .box = joined->box};
    units->count = 1;
    units->are_apart = true;
    number(units);
    if (!can_be_numbered(units))
        csg_own_units_reset(units);
}

void csg_own_units_reset(csg_own_units *units)
{
    for (size_t i = 0; i < units->count; i++)
        csg_shape_release(units->items[i].shape);
    if (units->items)
        csg_memory_release(units->memory, units->items, units->room * sizeof *units->items);
    units->items = NULL;
    units->count = 0;
}
