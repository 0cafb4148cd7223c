/* SPDX-License-Identifier: MIT
 * The tree that is evaluated lazily: a scene in which sharp unions of many operands (and many
 * sharply subtracted ones) have become binary trees of joins, grouped by their boxes. A join is cut
 * as trees of boxes for ray tracing are: in the order of the boxes' centres along an axis, where
 * the two halves' surfaces, each times the number of operands in it, are least (surface area
 * heuristic): small boxes far from a point are left out together.
 */
#include "scene/lazy/lazy_private.h"

#include <stdlib.h>

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
    /* per node of the scene */
    csg_node_id *places; /* in the tree */
    uint8_t *in_union;   /* whether it is an operand of a sharp union, or becomes one */
    uint32_t *widths;    /* operands that it is for such a union */
    double *softness;    /* per node of the tree, where the scene has soft nodes */
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

static csg_node_id append(grower *g, csg_node node, const csg_node_id *children, size_t count,
                          double softness)
{
    csgm_scene *to = g->to;
    node.first_child = (uint32_t)to->child_count;
    node.child_count = (uint32_t)count;
    for (size_t i = 0; i < count; i++)
        to->children[to->child_count++] = children[i];
    to->nodes[to->node_count] = node;
    if (g->softness)
        g->softness[to->node_count] = softness;
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

static bool is_sharp(const csg_node *node, csg_node_kind kind)
{
    return node->kind == kind && csg_blend_is_sharp(node->blend);
}

/* Whether the node vanishes into the sharp union above it. */
static bool is_absorbed(const grower *g, csg_node_id id)
{
    return g->in_union[id] && is_sharp(&g->from->nodes[id], CSG_NODE_UNION);
}

/* The operands of a sharp union of these nodes; room for their widths and as much again for what
 * waits. */
static size_t gather(const grower *g, const csg_node_id *ids, size_t count, operand *out,
                     csg_node_id *waiting)
{
    size_t waiting_count = 0, gathered = 0;
    for (size_t i = count; i-- > 0;)
        waiting[waiting_count++] = ids[i];
    while (waiting_count) {
        csg_node_id id = waiting[--waiting_count];
        const csg_node *node = &g->from->nodes[id];
        const csg_node_id *children = csg_scene_children(g->from, node);
        if (node->kind != CSG_NODE_COLOR && !is_absorbed(g, id)) {
            out[gathered++] = (operand){.box = g->from->bounds[id], .node = g->places[id]};
            continue;
        }
        for (uint32_t k = node->child_count; k-- > 0;)
            waiting[waiting_count++] = children[k];
    }
    return gathered;
}

/* The sharp union of these nodes of the scene as joins. */
static csg_node_id append_joins(grower *g, csg_node node, const csg_node_id *ids, size_t count,
                                double softness)
{
    csg_arena_mark mark = csg_arena_get_mark(g->scratch);
    size_t width = 0;
    for (size_t i = 0; i < count; i++)
        width += g->widths[ids[i]];
    operand *operands = csg_arena_calloc(g->scratch, width, sizeof *operands);
    csg_node_id *queue = csg_arena_calloc(g->scratch, width, sizeof *queue);
    double *rest = csg_arena_calloc(g->scratch, width, sizeof *rest);
    range *waiting = csg_arena_calloc(g->scratch, width + 1, sizeof *waiting);
    join *joins = csg_arena_calloc(g->scratch, width, sizeof *joins);
    if (!operands || !queue || !rest || !waiting || !joins)
        return CSG_NODE_NONE;
    gather(g, ids, count, operands, queue);
    place_operands(operands, width);
    size_t join_count = width > 1 ? split(operands, width, rest, waiting, joins) : 0;
    csg_node_id made = operands[0].node; /* of one */
    node.kind = CSG_NODE_UNION;
    for (size_t i = join_count; i-- > 0;) {
        made = append(g, node, joins[i].side, 2, softness);
        if (i)
            joins[joins[i].parent].side[joins[i].is_right] = made;
    }
    csg_arena_release_to(g->scratch, mark);
    return made;
}

static csg_node_id append_copy(grower *g, const csg_node *node, double softness)
{
    const csg_node_id *children = csg_scene_children(g->from, node);
    csg_node_id made = append(g, *node, NULL, 0, softness);
    csgm_scene *to = g->to;
    for (uint32_t k = 0; k < node->child_count; k++)
        to->children[to->child_count++] = g->places[children[k]];
    to->nodes[made].child_count = node->child_count;
    return made;
}

static csg_node_id append_node(grower *g, csg_node_id id)
{
    const csg_node *node = &g->from->nodes[id];
    const csg_node_id *children = csg_scene_children(g->from, node);
    double softness = csg_scene_softness(g->from, id);
    if (node->kind == CSG_NODE_COLOR)
        return g->places[children[0]];
    if (is_sharp(node, CSG_NODE_UNION))
        return is_absorbed(g, id) ? 0
                                  : append_joins(g, *node, children, node->child_count, softness);
    if (!is_sharp(node, CSG_NODE_DIFFERENCE) || node->child_count < 2)
        return append_copy(g, node, softness);
    csg_node_id sides[2] = {g->places[children[0]],
                            append_joins(g, *node, children + 1, node->child_count - 1,
                                         csg_scene_softness(g->from, children[1]))};
    return sides[1] == CSG_NODE_NONE ? CSG_NODE_NONE : append(g, *node, sides, 2, softness);
}

/* From the root down who is in a union, from the leaves up how many operands that makes. */
static void find_unions(grower *g)
{
    const csgm_scene *from = g->from;
    for (size_t i = from->node_count; i-- > 0;) {
        const csg_node *node = &from->nodes[i];
        bool all =
            is_sharp(node, CSG_NODE_UNION) || (node->kind == CSG_NODE_COLOR && g->in_union[i]);
        for (uint32_t k = 0; k < node->child_count; k++)
            g->in_union[csg_scene_children(from, node)[k]] =
                all || (k > 0 && is_sharp(node, CSG_NODE_DIFFERENCE));
    }
    for (size_t i = 0; i < from->node_count; i++) {
        const csg_node *node = &from->nodes[i];
        g->widths[i] = 1;
        if (node->kind != CSG_NODE_COLOR && !is_absorbed(g, (csg_node_id)i))
            continue;
        g->widths[i] = 0;
        for (uint32_t k = 0; k < node->child_count; k++)
            g->widths[i] += g->widths[csg_scene_children(from, node)[k]];
    }
}

/* Joins are as many as operands but one, of all unions together. */
static size_t most_nodes(const csgm_scene *scene)
{
    size_t most = scene->node_count;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        bool grows = is_sharp(node, CSG_NODE_UNION) || is_sharp(node, CSG_NODE_DIFFERENCE);
        most += grows && node->child_count > 2 ? node->child_count - 2 : 0;
    }
    return most;
}

static bool grower_begin(grower *g, csg_arena *kept, size_t most)
{
    size_t nodes = g->from->node_count;
    g->to->nodes = csg_arena_calloc(kept, most, sizeof *g->to->nodes);
    g->to->children = csg_arena_calloc(kept, most, sizeof *g->to->children);
    g->places = csg_arena_calloc(g->scratch, nodes, sizeof *g->places);
    g->in_union = csg_arena_calloc(g->scratch, nodes, sizeof *g->in_union);
    g->widths = csg_arena_calloc(g->scratch, nodes, sizeof *g->widths);
    if (g->from->softness)
        g->to->softness = g->softness = csg_arena_calloc(kept, most, sizeof *g->softness);
    return g->to->nodes && g->to->children && g->places && g->in_union && g->widths &&
           (g->softness || !g->from->softness);
}

csgm_status csg_lazy_grow_tree(csg_lazy *lazy, const csgm_scene *scene)
{
    csgm_scene *to = &lazy->tree;
    *to = *scene;
    to->node_count = to->child_count = 0;
    csg_arena scratch;
    csg_arena_init(&scratch, &scene->context->memory);
    grower g = {.from = scene, .to = to, .scratch = &scratch};
    bool ok = grower_begin(&g, &lazy->arena, most_nodes(scene));
    if (ok)
        find_unions(&g);
    for (size_t i = 0; ok && i < scene->node_count; i++) {
        g.places[i] = append_node(&g, (csg_node_id)i);
        ok = g.places[i] != CSG_NODE_NONE;
    }
    if (ok)
        to->root = g.places[scene->root];
    csg_arena_reset(&scratch);
    return ok ? CSGM_OK : CSGM_ERR_MEMORY;
}
