/* SPDX-License-Identifier: MIT
 * The tree that is evaluated lazily: a scene in which sharp unions of many operands (and many
 * sharply subtracted ones) have become binary trees of joins, grouped by their boxes. A join is cut
 * as trees of boxes for ray tracing are: in the order of the boxes' centres along an axis, where
 * the two halves' surfaces, each times the number of operands in it, are least (surface area
 * heuristic): small boxes far from a point are left out together.
 */
#include "scene/lazy_private.h"

#include <stdlib.h>
#include <string.h>

enum {
    MOST_SWEPT = 4096, /* operands; more are halved along the longest axis */
};

typedef struct operand {
    double key; /* centre along the axis being sorted */
    csg_vec3 center;
    csg_box box; /* finite */
    csg_node_id node;
} operand;

/* Operands [first, first + count): one, or a join to be split. */
typedef struct range {
    size_t first, count;
    size_t parent;
    bool is_right;
} range;

/* A join, in the order of splitting: parents before children. Sides: operands (place in `nodes`)
 * are known at once, joins when they are made. */
typedef struct join {
    csg_node_id side[2];
    size_t parent; /* SIZE_MAX: the first */
    bool is_right;
} join;

typedef struct grower {
    const csgm_scene *from;
    csgm_scene *to;
    csg_arena *scratch;
    csg_node_id *places; /* per node of the scene: its place in the tree */
} grower;

static int compare_operands(const void *a, const void *b)
{
    const operand *l = a, *r = b;
    if (l->key != r->key)
        return l->key < r->key ? -1 : 1;
    return (l->node > r->node) - (l->node < r->node);
}

static double component(csg_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static void sort_along(operand *operands, size_t count, int axis)
{
    for (size_t i = 0; i < count; i++)
        operands[i].key = component(operands[i].center, axis);
    qsort(operands, count, sizeof *operands, compare_operands);
}

static double surface(csg_box box)
{
    csg_vec3 size = csg_box_size(box);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

static int longest_axis(const operand *operands, size_t count)
{
    csg_box centers = csg_box_empty();
    for (size_t i = 0; i < count; i++)
        centers = csg_box_hull(centers, (csg_box){operands[i].center, operands[i].center});
    csg_vec3 size = csg_box_size(centers);
    if (size.x >= size.y && size.x >= size.z)
        return 0;
    return size.y >= size.z ? 1 : 2;
}

/* The cheapest cut of operands in this order: how many go left. */
static size_t sweep(const operand *operands, size_t count, double *rest, double *cost)
{
    csg_box box = csg_box_empty();
    for (size_t i = count; i-- > 1;) {
        box = csg_box_hull(box, operands[i].box);
        rest[i] = surface(box) * (double)(count - i);
    }
    size_t best = count / 2;
    *cost = INFINITY;
    box = csg_box_empty();
    for (size_t i = 1; i < count; i++) {
        box = csg_box_hull(box, operands[i - 1].box);
        double here = surface(box) * (double)i + rest[i];
        if (here < *cost)
            best = i;
        *cost = fmin(*cost, here);
    }
    return best;
}

/* Sorts the operands and says how many go left. */
static size_t cut(operand *operands, size_t count, double *rest)
{
    if (count > MOST_SWEPT) {
        sort_along(operands, count, longest_axis(operands, count));
        return count / 2;
    }
    double least = INFINITY;
    int axis = 0;
    for (int i = 0; i < 3; i++) {
        double cost;
        sort_along(operands, count, i);
        sweep(operands, count, rest, &cost);
        if (cost < least)
            axis = i;
        least = fmin(least, cost);
    }
    sort_along(operands, count, axis);
    return sweep(operands, count, rest, &least);
}

/* Boxes without end and empty ones have no place: they stand where the others are. */
static void place_operands(operand *operands, size_t count)
{
    csg_box hull = csg_box_empty();
    for (size_t i = 0; i < count; i++)
        if (csg_box_is_finite(operands[i].box))
            hull = csg_box_hull(hull, operands[i].box);
    if (csg_box_is_empty(hull))
        hull = (csg_box){{0, 0, 0}, {0, 0, 0}};
    for (size_t i = 0; i < count; i++) {
        csg_box box = csg_box_intersect(operands[i].box, hull);
        operands[i].box = csg_box_is_empty(box) ? hull : box;
        operands[i].center = csg_box_center(operands[i].box);
    }
}

static csg_node_id append(grower *g, csg_node node, const csg_node_id *children, size_t count)
{
    csgm_scene *to = g->to;
    node.first_child = (uint32_t)to->child_count;
    node.child_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++)
        to->children[to->child_count++] = children[i];
    to->nodes[to->node_count] = node;
    return (csg_node_id)to->node_count++;
}

/* Splits ranges until each has one operand; returns the joins' count. */
static size_t split(operand *operands, size_t count, double *rest, range *waiting, join *joins)
{
    size_t join_count = 0, waiting_count = 0;
    waiting[waiting_count++] = (range){0, count, SIZE_MAX, false};
    while (waiting_count) {
        range r = waiting[--waiting_count];
        if (r.count == 1) {
            joins[r.parent].side[r.is_right] = operands[r.first].node;
            continue;
        }
        size_t left = cut(operands + r.first, r.count, rest);
        joins[join_count] = (join){.parent = r.parent, .is_right = r.is_right};
        waiting[waiting_count++] = (range){r.first + left, r.count - left, join_count, true};
        waiting[waiting_count++] = (range){r.first, left, join_count, false};
        join_count++;
    }
    return join_count;
}

/* The sharp union of these nodes of the scene as joins. */
static csg_node_id append_joins(grower *g, csg_node node, const csg_node_id *ids, size_t count)
{
    if (count == 1)
        return g->places[ids[0]];
    csg_arena_mark mark = csg_arena_get_mark(g->scratch);
    operand *operands = csg_arena_calloc(g->scratch, count, sizeof *operands);
    double *rest = csg_arena_calloc(g->scratch, count, sizeof *rest);
    range *waiting = csg_arena_calloc(g->scratch, count + 1, sizeof *waiting);
    join *joins = csg_arena_calloc(g->scratch, count, sizeof *joins);
    if (!operands || !rest || !waiting || !joins)
        return CSG_NODE_NONE;
    for (size_t i = 0; i < count; i++)
        operands[i] = (operand){.box = g->from->bounds[ids[i]], .node = g->places[ids[i]]};
    place_operands(operands, count);
    size_t join_count = split(operands, count, rest, waiting, joins);
    csg_node_id made = CSG_NODE_NONE;
    node.kind = CSG_NODE_UNION;
    for (size_t i = join_count; i-- > 0;) {
        made = append(g, node, joins[i].side, 2);
        if (i)
            joins[joins[i].parent].side[joins[i].is_right] = made;
    }
    csg_arena_release_to(g->scratch, mark);
    return made;
}

static bool is_long(const csg_node *node)
{
    return (node->kind == CSG_NODE_UNION || node->kind == CSG_NODE_DIFFERENCE) &&
           node->blend == CSG_BLEND_SHARP && node->child_count > 2;
}

static csg_node_id append_copy(grower *g, const csg_node *node)
{
    csgm_scene *to = g->to;
    csg_node copy = *node;
    const csg_node_id *children = csg_scene_children(g->from, node);
    copy.first_child = (uint32_t)to->child_count;
    for (uint32_t k = 0; k < node->child_count; k++)
        to->children[to->child_count++] = g->places[children[k]];
    to->nodes[to->node_count] = copy;
    return (csg_node_id)to->node_count++;
}

static csg_node_id append_node(grower *g, const csg_node *node)
{
    if (!is_long(node))
        return append_copy(g, node);
    const csg_node_id *children = csg_scene_children(g->from, node);
    if (node->kind == CSG_NODE_UNION)
        return append_joins(g, *node, children, node->child_count);
    csg_node_id sides[2] = {g->places[children[0]],
                            append_joins(g, *node, children + 1, node->child_count - 1)};
    return sides[1] == CSG_NODE_NONE ? CSG_NODE_NONE : append(g, *node, sides, 2);
}

csgm_status csg_lazy_grow_tree(csg_lazy *lazy, const csgm_scene *scene)
{
    csgm_scene *to = &lazy->tree;
    size_t most = scene->node_count; /* a join of two for each operand beyond the second */
    for (size_t i = 0; i < scene->node_count; i++)
        most += is_long(&scene->nodes[i]) ? scene->nodes[i].child_count - 2 : 0;
    *to = *scene;
    to->node_count = to->child_count = 0;
    to->nodes = csg_arena_calloc(&lazy->arena, most, sizeof *to->nodes);
    to->children = csg_arena_calloc(&lazy->arena, most, sizeof *to->children);
    csg_arena scratch;
    csg_arena_init(&scratch, &scene->context->memory);
    grower g = {scene, to, &scratch, NULL};
    g.places = csg_arena_calloc(&scratch, scene->node_count, sizeof *g.places);
    bool ok = to->nodes && to->children && g.places;
    for (size_t i = 0; ok && i < scene->node_count; i++) {
        g.places[i] = append_node(&g, &scene->nodes[i]);
        ok = g.places[i] != CSG_NODE_NONE;
    }
    if (ok)
        to->root = g.places[scene->root];
    csg_arena_reset(&scratch);
    return ok ? CSGM_OK : CSGM_ERR_MEMORY;
}
