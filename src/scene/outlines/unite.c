/* SPDX-License-Identifier: MIT
 * See unite.h. A walk down notes the nodes, parents before children and siblings together; on the
 * way back each one says how many leaves of straight edges it is made of, and largest subtrees of
 * nothing else become regions (flatten.h).
 */
#include "scene/outlines/unite.h"

#include "scene/outlines/flatten.h"
#include "scene/primitives/kinds.h"
#include "scene/tree/build_private.h"
#include "scene/tree/figures.h"
#include "shape/plane/region.h"

/* Points that pass through the polygon library for one figure: about a second. A long chain of
 * differences, each of which the library would see again, stays as it is. */
enum { MOST_WORK = 1 << 20 };

typedef struct visit {
    csg_node_id node;
    size_t first;          /* its first child among the visits */
    uint32_t leaves;       /* of straight edges; 0: there is something else below, or too much */
    uint64_t points, work; /* of them; that all operators below together look at */
} visit;

typedef struct uniting {
    csg_scene_builder *builder;
    csg_memory *memory;
    visit *visits;
    csg_node_id *group; /* operands that become one */
    size_t count, capacity, group_capacity;
} uniting;

static const csg_node *node_of(const uniting *u, const visit *v)
{
    return &u->builder->scene->nodes[v->node];
}

/* Whether its figure is what its children's are joined to, or one of them placed or painted. */
static bool descends(const csg_node *node)
{
    return node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
           (csg_node_is_operator(node->kind) && csg_blend_is_sharp(node->blend) &&
            !(node->flags & CSG_FLAG_SOFT));
}

static bool is_straight_leaf(const csgm_scene *scene, const csg_node *node)
{
    enum { ROUNDING = 2 };
    if (node->kind == CSG_NODE_RECTANGLE)
        return !(csg_scene_parameters(scene, node)[ROUNDING] > 0);
    return node->kind == CSG_NODE_SHAPE && scene->shapes[node->payload]->kind == CSG_SHAPE_REGION;
}

static bool add_visit(uniting *u, csg_node_id node)
{
    void *data = u->visits;
    if (!csg_memory_reserve(u->memory, &data, &u->capacity, u->count + 1, sizeof *u->visits))
        return false;
    u->visits = data;
    u->visits[u->count++] = (visit){.node = node};
    return true;
}

static bool walk(uniting *u, csg_node_id root)
{
    const csgm_scene *scene = u->builder->scene;
    bool done = add_visit(u, root);
    for (size_t i = 0; i < u->count && done; i++) {
        const csg_node *node = node_of(u, &u->visits[i]);
        u->visits[i].first = u->count;
        for (uint32_t k = 0; k < node->child_count && descends(node) && done; k++)
            done = add_visit(u, csg_scene_children(scene, node)[k]);
    }
    return done;
}

static void look_at_leaf(const uniting *u, visit *v)
{
    const csgm_scene *scene = u->builder->scene;
    const csg_node *node = node_of(u, v);
    v->leaves = is_straight_leaf(scene, node);
    if (v->leaves && node->kind == CSG_NODE_SHAPE)
        v->points = csg_region_outline(scene->shapes[node->payload])->point_count;
    else
        v->points = 4;
}

/* Of what its children are made of; false: something else is among them. */
static bool add_children(const uniting *u, visit *v)
{
    const csg_node *node = node_of(u, v);
    bool all = true;
    for (uint32_t k = 0; k < node->child_count; k++) {
        const visit *child = &u->visits[v->first + k];
        all = all && child->leaves;
        if (!child->leaves)
            continue;
        v->leaves += child->leaves;
        v->points += child->points;
        v->work += child->work;
    }
    if (csg_node_is_operator(node->kind))
        v->work += v->points;
    return all;
}

/* *id, made of straight edges, becomes a region where that can be. False: no memory. */
static bool make_region(uniting *u, csg_node_id *id)
{
    csg_outline outline;
    csg_shape *shape = NULL;
    csg_span where = u->builder->scene->nodes[*id].where;
    csgm_status status = csg_flatten(u->builder, *id, 1, &outline); /* no curve needs a tolerance */
    if (status == CSGM_OK && outline.loop_count)
        status = csg_figures_region(&u->builder->figures, u->memory, &outline, &shape);
    csg_outline_release(&outline);
    if (shape)
        *id = csg_build_shape(u->builder, shape, where);
    return status != CSGM_ERR_MEMORY && *id != CSG_NODE_NONE;
}

/* Of a sharp operator's straight operands: the first in place of all. What a difference begins with
 * may be one of them; else the others are added up. */
static bool unite_operands(uniting *u, const visit *v)
{
    csg_scene_builder *builder = u->builder;
    csg_node node = *node_of(u, v);
    bool is_whole = u->visits[v->first].leaves > 0; /* the first one is straight */
    csg_node_kind kind =
        node.kind == CSG_NODE_DIFFERENCE && !is_whole ? CSG_NODE_UNION : (csg_node_kind)node.kind;
    uint32_t count = 0, kept = 0, at = 0;
    if (!csg_memory_reserve(u->memory, (void **)&u->group, &u->group_capacity, node.child_count,
                            sizeof *u->group))
        return false;
    for (uint32_t k = 0; k < node.child_count; k++)
        if (u->visits[v->first + k].leaves)
            u->group[count++] = csg_scene_children(builder->scene, &node)[k];
    csg_node_id united = csg_build_operator(builder, kind, CSG_SHARP, u->group, count, node.where);
    if (united == CSG_NODE_NONE || !make_region(u, &united))
        return false;
    csg_node_id *children = builder->scene->children + node.first_child;
    for (uint32_t k = 0; k < node.child_count; k++) {
        bool is_straight = u->visits[v->first + k].leaves > 0;
        if (!is_straight || !at)
            children[kept++] = is_straight ? united : children[k];
        at |= is_straight;
    }
    builder->scene->nodes[v->node].child_count = kept;
    return true;
}

static bool unite_child(uniting *u, const visit *v)
{
    csg_node_id made = csg_scene_children(u->builder->scene, node_of(u, v))[0];
    if (!make_region(u, &made))
        return false;
    u->builder->scene->children[node_of(u, v)->first_child] = made; /* arrays may have moved */
    return true;
}

/* Once what is below is done. */
static bool leave(uniting *u, visit *v)
{
    const csg_node *node = node_of(u, v);
    if (!descends(node)) {
        look_at_leaf(u, v);
        return true;
    }
    bool all = add_children(u, v), fits = v->work <= MOST_WORK, several = v->leaves >= 2;
    if (all && fits && node->kind != CSG_NODE_COLOR)
        return true; /* what stands above decides */
    v->leaves = 0;
    if (!fits || !several)
        return true;
    return node->kind == CSG_NODE_COLOR ? unite_child(u, v) : unite_operands(u, v);
}

csg_node_id csg_unite(csg_scene_builder *builder, csg_node_id flat)
{
    uniting u = {.builder = builder, .memory = &builder->context->memory};
    if (!csg_build_is_usable(builder, flat))
        return CSG_NODE_NONE;
    bool done = walk(&u, flat);
    for (size_t i = u.count; i-- > 0 && done;)
        done = leave(&u, &u.visits[i]);
    if (done && u.visits[0].leaves > 1)
        done = make_region(&u, &flat);
    csg_memory_release(u.memory, u.visits, u.capacity * sizeof *u.visits);
    csg_memory_release(u.memory, u.group, u.group_capacity * sizeof *u.group);
    return done ? flat : csg_build_no_memory(builder);
}
