/* SPDX-License-Identifier: MIT
 * See units.h. Parents have larger numbers than their children, so one loop downwards hands places
 * and looks on.
 */
#include "mesh/own/units.h"

#include <string.h>

#include "mesh/own/leaves.h"
#include "shape/polyhedra/polyhedron.h"

/* More units than that are meshed as ever: each is held against each. Polyhedra of fewer triangles
 * cost cells little, and cells put corners where they serve both sides of an edge. */
enum { MOST_UNITS = 4096, LEAST_TRIANGLES_BESIDE_RESTS = 256 };
/* More looks than that in a scene are taken as several anywhere: each is held against each. */
enum { MOST_LOOKS = 64 };

typedef struct finder {
    csg_own_units *units;
    const csgm_scene *scene;
    bool boxes;       /* count as polyhedra: where there is nothing else */
    uint8_t *holds;   /* per node: there are polyhedra below, and only sharp operators above them */
    uint8_t *reached; /* per node: it is on the way to them */
    csg_own_way *ways;
    uint32_t *looks; /* per node: the number of that of its leaves */
    bool all;        /* nothing is left over */
} finder;

/* ---- where polyhedra are -----------------------------------------------------------------------
 */

static bool is_leaf(const finder *f, const csg_node *node)
{
    csg_own_leaf_kind kind = csg_own_leaf_kind_of(f->scene, node);
    return kind == CSG_OWN_LEAF_SHAPE || (f->boxes && kind == CSG_OWN_LEAF_BOX);
}

static bool is_way(const csg_node *node)
{
    return node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
           (csg_node_is_operator(node->kind) && csg_blend_is_sharp(node->blend));
}

/* Of a node that is no leaf: how many of its children hold polyhedra. */
static uint32_t count_holding(const finder *f, const csg_node *node)
{
    uint32_t count = 0;
    for (uint32_t k = 0; is_way(node) && k < node->child_count; k++)
        count += f->holds[csg_scene_children(f->scene, node)[k]];
    return count;
}

/* all: a node counts only where everything below it does. */
static void look_for_polyhedra(finder *f, bool all)
{
    for (csg_node_id i = 0; i <= f->scene->root; i++) {
        const csg_node *node = &f->scene->nodes[i];
        uint32_t count = count_holding(f, node);
        f->holds[i] = is_leaf(f, node) || (all ? count && count == node->child_count : count);
    }
}

/* ---- looks -------------------------------------------------------------------------------------
 */

static bool is_same_look(const csg_look *a, const csg_look *b)
{
    return a->has_color == b->has_color && a->has_material == b->has_material &&
           a->color.r == b->color.r && a->color.g == b->color.g && a->color.b == b->color.b &&
           a->color.a == b->color.a && a->metallic == b->metallic && a->roughness == b->roughness;
}

/* False: no memory. */
static bool number_look(csg_own_units *units, const csg_look *look, uint32_t *number)
{
    for (size_t i = units->look_count; i-- > 0;)
        if (is_same_look(&units->looks[i], look)) {
            *number = (uint32_t)i;
            return true;
        }
    *number = CSG_OWN_SEVERAL_LOOKS;
    if (units->look_count == MOST_LOOKS)
        return true;
    if (!csg_memory_reserve(units->memory, (void **)&units->looks, &units->look_room,
                            units->look_count + 1, sizeof *look))
        return false;
    units->looks[units->look_count] = *look;
    *number = (uint32_t)units->look_count++;
    return true;
}

static uint32_t look_of_both(uint32_t a, uint32_t b)
{
    return a == CSG_OWN_NO_LOOK ? b : b == CSG_OWN_NO_LOOK || a == b ? a : CSG_OWN_SEVERAL_LOOKS;
}

/* Downwards to the leaves. There may be nodes that the root does not have. */
static bool look_at_leaves(finder *f)
{
    const csgm_scene *scene = f->scene;
    bool added = true;
    memset(f->reached, 0, scene->node_count);
    f->reached[scene->root] = true;
    f->ways[scene->root] = (csg_own_way){.place = csg_affine_identity()};
    for (csg_node_id i = scene->root + 1; i-- > 0 && added;) {
        const csg_node *node = &scene->nodes[i];
        f->looks[i] = CSG_OWN_NO_LOOK;
        if (!f->reached[i])
            continue;
        csg_own_way way = csg_own_way_below(scene, node, f->ways[i]);
        for (uint32_t k = 0; k < node->child_count; k++) {
            csg_node_id child = csg_scene_children(scene, node)[k];
            f->reached[child] = true;
            f->ways[child] = way;
        }
        if (csg_node_is_primitive(node->kind))
            added = number_look(f->units, &f->ways[i].look, &f->looks[i]);
    }
    return added;
}

/* And upwards again. A plate looks as its figure does. */
static void look_at_nodes(finder *f)
{
    for (csg_node_id i = 0; i <= f->scene->root; i++) {
        const csg_node *node = &f->scene->nodes[i];
        uint32_t count = csg_node_is_plate(node) ? 1 : node->child_count;
        for (uint32_t k = 0; k < count; k++)
            f->looks[i] =
                look_of_both(f->looks[i], f->looks[csg_scene_children(f->scene, node)[k]]);
    }
}

/* ---- units -------------------------------------------------------------------------------------
 */

static bool add_unit(finder *f, const csg_own_unit *unit)
{
    csg_own_units *units = f->units;
    f->all = units->count < MOST_UNITS;
    if (!f->all)
        return true;
    if (!csg_memory_reserve(units->memory, (void **)&units->items, &units->room, units->count + 1,
                            sizeof *unit))
        return false;
    units->items[units->count++] = *unit;
    return true;
}

static bool add_leaf(finder *f, csg_node_id i)
{
    csg_own_leaf leaf;
    if (csg_own_leaf_make(f->scene, &f->scene->nodes[i], &f->ways[i], &leaf) != CSGM_OK)
        return false;
    f->all = leaf.shape != NULL;
    if (!f->all)
        return true;
    const csg_own_unit unit = {.shape = leaf.shape,
                               .place = leaf.way.place,
                               .look = f->looks[i],
                               .node = i,
                               .box = csg_affine_box(&leaf.way.place, leaf.shape->box)};
    bool added = add_unit(f, &unit);
    if (!added || !f->all)
        csg_shape_release(leaf.shape);
    return added;
}

/* As yet without members. */
static bool add_rest(finder *f, csg_node_id i, csg_node_kind kind, bool is_operand)
{
    const csg_own_unit unit = {.place = csg_affine_identity(),
                               .look = CSG_OWN_NO_LOOK,
                               .node = i,
                               .kind = kind,
                               .is_operand = is_operand,
                               .first_member = f->units->member_count};
    f->units->rest_count++;
    return add_unit(f, &unit);
}

static bool add_member(finder *f, csg_node_id node, const csg_own_way *way)
{
    csg_own_units *units = f->units;
    if (!csg_memory_reserve(units->memory, (void **)&units->members, &units->member_room,
                            units->member_count + 1, sizeof *units->members))
        return false;
    units->members[units->member_count++] =
        (csg_excerpt_item){.node = node, .place = way->place, .look = way->look};
    csg_own_unit *rest = &units->items[units->count - 1];
    rest->member_count++;
    rest->look = look_of_both(rest->look, f->looks[node]);
    return true;
}

/* An operand that is on the way, or one of those that are taken together: all that are subtracted,
 * or all that are united or intersected. */
static bool goes_on(const finder *f, const csg_node *node, uint32_t k)
{
    return f->holds[csg_scene_children(f->scene, node)[k]] ||
           (node->kind == CSG_NODE_DIFFERENCE && k == 0);
}

static bool add_operands(finder *f, csg_node_id i)
{
    const csg_node *node = &f->scene->nodes[i];
    const csg_node_id *children = csg_scene_children(f->scene, node);
    csg_own_way way = csg_own_way_below(f->scene, node, f->ways[i]);
    bool has_rest = false, added = true;
    for (uint32_t k = 0; k < node->child_count && added && f->all; k++) {
        if (goes_on(f, node, k)) {
            f->reached[children[k]] = true;
            f->ways[children[k]] = way;
            continue;
        }
        if (!has_rest)
            added = add_rest(
                f, i, node->kind == CSG_NODE_INTERSECTION ? CSG_NODE_INTERSECTION : CSG_NODE_UNION,
                true);
        has_rest = true;
        if (added && f->all)
            added = add_member(f, children[k], &way);
    }
    return added;
}

/* Units come from the last to the first. False: no memory. */
static bool walk(finder *f)
{
    csg_node_id root = f->scene->root;
    bool added = true;
    f->ways[root] = (csg_own_way){.place = csg_affine_identity()};
    f->reached[root] = f->all = f->holds[root];
    for (csg_node_id i = root + 1; i-- > 0 && added && f->all;) {
        const csg_node *node = &f->scene->nodes[i];
        if (!f->reached[i])
            continue;
        if (!f->holds[i])
            added =
                add_rest(f, i, CSG_NODE_UNION, false) && (!f->all || add_member(f, i, &f->ways[i]));
        else if (is_leaf(f, node))
            added = add_leaf(f, i);
        else
            added = add_operands(f, i);
    }
    return added;
}

static void turn_round(csg_own_units *units)
{
    for (size_t i = 0, k = units->count; i < k; i++) {
        csg_own_unit unit = units->items[i];
        units->items[i] = units->items[--k];
        units->items[k] = unit;
    }
}

/* ---- what they are together --------------------------------------------------------------------
 */

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

/* Those that are combined at all. */
static bool has_unions_only(const csgm_scene *scene, const uint8_t *reached)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        csg_node_kind kind = scene->nodes[i].kind;
        bool is_plate = csg_node_is_plate(&scene->nodes[i]);
        if (reached[i] && !is_plate && csg_node_is_operator(kind) && kind != CSG_NODE_UNION)
            return false;
    }
    return true;
}

static void number(csg_own_units *units)
{
    units->vertex_count = units->triangle_count = 0;
    for (size_t i = 0; i < units->count; i++) {
        csg_own_unit *unit = &units->items[i];
        if (!unit->shape)
            continue;
        const csg_triangles *triangles = csg_polyhedron_triangles(unit->shape);
        unit->first_vertex = (uint32_t)units->vertex_count;
        unit->first_triangle = (uint32_t)units->triangle_count;
        units->vertex_count += triangles->point_count;
        units->triangle_count += triangles->count;
    }
}

/* Corners have numbers, too. */
static bool can_be_numbered(const csg_own_units *units)
{
    static const uint64_t MOST = UINT32_MAX / 3 - 1;
    return units->vertex_count <= MOST && units->triangle_count <= MOST;
}

/* ---- all of it ---------------------------------------------------------------------------------
 */

/* Boxes are polyhedra where there is nothing else; beside what needs cells, cells are best for
 * them. */
static bool find(finder *f)
{
    csg_own_units *units = f->units;
    if (!look_at_leaves(f))
        return false;
    look_at_nodes(f);
    f->boxes = true;
    look_for_polyhedra(f, true);
    f->boxes = f->holds[f->scene->root];
    if (!f->boxes)
        look_for_polyhedra(f, false);
    memset(f->reached, 0, f->scene->node_count);
    if (!walk(f))
        return false;
    turn_round(units);
    number(units);
    units->are_apart =
        f->all && !units->rest_count && has_unions_only(f->scene, f->reached) && are_apart(units);
    bool is_worth_it = !units->rest_count || units->triangle_count >= LEAST_TRIANGLES_BESIDE_RESTS;
    if (!f->all || !can_be_numbered(units) || !is_worth_it)
        csg_own_units_reset(units);
    return true;
}

csgm_status csg_own_units_find(csg_own_units *units, const csgm_scene *scene)
{
    csg_memory *memory = &scene->context->memory;
    size_t nodes = scene->node_count;
    *units = (csg_own_units){.memory = memory};
    finder f = {.units = units, .scene = scene};
    f.holds = csg_memory_alloc(memory, nodes);
    f.reached = csg_memory_alloc(memory, nodes);
    f.ways = csg_memory_alloc(memory, nodes * sizeof *f.ways);
    f.looks = csg_memory_alloc(memory, nodes * sizeof *f.looks);
    bool done = f.holds && f.reached && f.ways && f.looks && find(&f);
    csg_memory_release(memory, f.holds, nodes);
    csg_memory_release(memory, f.reached, nodes);
    csg_memory_release(memory, f.ways, nodes * sizeof *f.ways);
    csg_memory_release(memory, f.looks, nodes * sizeof *f.looks);
    if (!done)
        csg_own_units_reset(units);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

void csg_own_units_give(csg_own_unit *unit, csg_shape *shape)
{
    unit->shape = shape;
    unit->box = shape->box;
}

void csg_own_units_forget_looks(csg_own_units *units)
{
    units->look_count = units->count > 0;
    for (size_t i = 0; i < units->count; i++)
        units->items[i].look = 0;
}

bool csg_own_units_have_looks(const csg_own_units *units)
{
    for (size_t i = 0; i < units->count; i++)
        if (units->items[i].look >= units->look_count)
            return false;
    return true;
}

void csg_own_units_replace(csg_own_units *units, csg_shape *joined, uint32_t *triangle_looks,
                           size_t room)
{
    for (size_t i = 0; i < units->count; i++)
        csg_shape_release(units->items[i].shape);
    units->items[0] = (csg_own_unit){.shape = joined,
                                     .place = csg_affine_identity(),
                                     .look = CSG_OWN_SEVERAL_LOOKS,
                                     .box = joined->box};
    units->triangle_looks = triangle_looks;
    units->triangle_look_room = room;
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
    csg_memory_release(units->memory, units->items, units->room * sizeof *units->items);
    csg_memory_release(units->memory, units->members, units->member_room * sizeof *units->members);
    csg_memory_release(units->memory, units->looks, units->look_room * sizeof *units->looks);
    csg_memory_release(units->memory, units->triangle_looks,
                       units->triangle_look_room * sizeof *units->triangle_looks);
    *units = (csg_own_units){.memory = units->memory};
}
