/* SPDX-License-Identifier: MIT
 * Bounds of the nodes of a lazy tree (operators.md 3.3, 3.5), in one of three ways: each node's own
 * box; these boxes cut by each other up and down the tree until nothing changes, as the paper has
 * it; levels and clamp boxes of the exact scheme (scene/boxes/bounds.h).
 */
#include "scene/boxes/bounds.h"
#include "scene/boxes/level_boxes.h"
#include "scene/lazy/lazy_private.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"

enum { MOST_PASSES = 32 };

bool csg_lazy_is_plain(const csg_node *node)
{
    return csg_node_is_operator(node->kind) && node->blend < CSG_BLEND_COUNT &&
           !csg_blend_is_fillet(node->blend);
}

/* ---- boxes of the paper -------------------------------------------------------------------- */

static bool is_known_operator(const csg_node *node)
{
    return csg_lazy_is_plain(node) ||
           (csg_node_is_operator(node->kind) && csg_blend_is_orthogonal(node->blend));
}

/* Nodes below which a value that is cut by its own box still gives the same solid. */
static bool lets_boxes_through(const csg_node *node)
{
    return node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
           is_known_operator(node);
}

/* Eq. (14): a blended union grows by its support. */
static csg_box operator_box(const csgm_scene *tree, const csg_node *node, const csg_box *boxes)
{
    const csg_node_id *children = csg_scene_children(tree, node);
    csg_box box = boxes[children[0]];
    for (uint32_t k = 1; k < node->child_count && node->kind != CSG_NODE_DIFFERENCE; k++)
        box = node->kind == CSG_NODE_UNION ? csg_box_hull(box, boxes[children[k]])
                                           : csg_box_intersect(box, boxes[children[k]]);
    bool grows = node->kind == CSG_NODE_UNION;
    return grows ? csg_box_grow(box, csg_blend_support(csg_scene_blend(tree, node))) : box;
}

/* A node's box made from its children's; leaves, placed ones too, keep the box that they have. */
static void compute_upward(const csgm_scene *tree, csg_box *boxes, bool cut)
{
    for (size_t i = 0; i < tree->node_count; i++) {
        const csg_node *node = &tree->nodes[i];
        csg_box box = boxes[i];
        if (is_known_operator(node))
            box = operator_box(tree, node, boxes);
        else if (node->kind == CSG_NODE_COLOR)
            box = boxes[csg_scene_children(tree, node)[0]];
        else if (node->kind == CSG_NODE_TRANSFORM)
            box = csg_box_intersect(box, csg_affine_box(&tree->transforms[node->payload],
                                                        boxes[csg_scene_children(tree, node)[0]]));
        boxes[i] = cut ? csg_box_intersect(boxes[i], box) : box;
    }
}

/* Returns whether any box became smaller. */
static bool share_downward(const csgm_scene *tree, csg_box *boxes)
{
    bool changed = false;
    for (size_t i = tree->node_count; i-- > 0;) {
        const csg_node *node = &tree->nodes[i];
        if (!lets_boxes_through(node))
            continue;
        csg_box box = boxes[i];
        if (node->kind == CSG_NODE_TRANSFORM)
            box = csg_affine_box(&tree->inverses[node->payload], box);
        for (uint32_t k = 0; k < node->child_count; k++) {
            csg_box *child = &boxes[csg_scene_children(tree, node)[k]];
            changed = changed || (!csg_box_is_empty(*child) && !csg_box_contains_box(box, *child));
            *child = csg_box_intersect(*child, box);
        }
    }
    return changed;
}

static void take_boxes(csg_lazy *lazy, const csg_box *boxes)
{
    const csgm_scene *tree = &lazy->tree;
    lazy->bounds[tree->root].is_known = true;
    for (size_t i = tree->node_count; i-- > 0;) {
        const csg_node *node = &tree->nodes[i];
        bool inner = lazy->bounds[i].is_known && lets_boxes_through(node);
        lazy->bounds[i].box = boxes[i];
        lazy->bounds[i].below = 0;
        for (uint32_t k = 0; k < node->child_count; k++)
            lazy->bounds[csg_scene_children(tree, node)[k]].is_known = inner;
        if (node->kind == CSG_NODE_WARP) /* its box is not that of what the builder cuts off */
            lazy->bounds[i].is_known = false;
    }
}

static csgm_status find_paper_boxes(csg_lazy *lazy, csg_arena *scratch, bool shared)
{
    const csgm_scene *tree = &lazy->tree;
    csg_box *boxes = csg_arena_calloc(scratch, tree->node_count, sizeof *boxes);
    if (!boxes)
        return CSGM_ERR_MEMORY;
    csgm_status status = csg_level_boxes(tree, NULL, boxes);
    if (status != CSGM_OK)
        return status;
    compute_upward(tree, boxes, false);
    for (int pass = 0; shared && pass < MOST_PASSES; pass++) {
        if (!share_downward(tree, boxes))
            break;
        compute_upward(tree, boxes, true);
    }
    take_boxes(lazy, boxes);
    return CSGM_OK;
}

/* ---- the exact scheme ---------------------------------------------------------------------- */

/* Its value depends on its operands' gradients, which bounds change: they are left alone. It has no
 * Lipschitz constant either. */
static bool looks_at_gradients(const csgm_scene *tree, const csg_node *node)
{
    const csg_rule *rule = csg_scene_rule(tree, node);
    if (csg_node_is_fillet(node))
        return true;
    return rule && rule->kind == CSG_BLEND_SCALE_SET && rule->parameters[3] > 0;
}

static csgm_status find_exact_bounds(csg_lazy *lazy, csg_arena *scratch, double band)
{
    const csgm_scene *tree = &lazy->tree;
    csg_node_bounds *bounds = csg_arena_calloc(scratch, tree->node_count, sizeof *bounds);
    if (!bounds)
        return CSGM_ERR_MEMORY;
    csgm_status status = csg_bounds_compute(tree, band, bounds);
    if (status != CSGM_OK)
        return status;
    lazy->bounds[tree->root].is_known = true;
    for (size_t i = tree->node_count; i-- > 0;) {
        const csg_node *node = &tree->nodes[i];
        csg_lazy_bound *bound = &lazy->bounds[i];
        bool inner = bound->is_known && !looks_at_gradients(tree, node);
        bound->box = bounds[i].clamp_box;
        bound->below = bounds[i].below;
        for (uint32_t k = 0; k < node->child_count; k++)
            lazy->bounds[csg_scene_children(tree, node)[k]].is_known = inner;
        bound->is_known = bound->is_known && isfinite(bound->below);
    }
    return CSGM_OK;
}

/* ---- all ----------------------------------------------------------------------------------- */

static bool find_lipschitz(csg_lazy *lazy, csg_arena *scratch)
{
    const csgm_scene *tree = &lazy->tree;
    double *slopes = csg_arena_calloc(scratch, tree->node_count, sizeof *slopes);
    if (!slopes)
        return false;
    csg_scene_slopes(tree, slopes);
    for (size_t i = 0; i < tree->node_count; i++) {
        const csg_node *node = &tree->nodes[i];
        double lambda = looks_at_gradients(tree, node) ? INFINITY : fmax(slopes[i], 1);
        for (uint32_t k = 0; k < node->child_count; k++)
            if (lazy->bounds[csg_scene_children(tree, node)[k]].lambda == INFINITY)
                lambda = INFINITY;
        lazy->bounds[i].lambda = lambda;
    }
    return true;
}

static bool is_all_of_space(csg_box box)
{
    return csg_box_contains_box(box, csg_box_all());
}

csgm_status csg_lazy_find_bounds(csg_lazy *lazy, const csg_lazy_options *options)
{
    csg_arena scratch;
    csg_arena_init(&scratch, &lazy->context->memory);
    csgm_status status = CSGM_OK;
    if (!find_lipschitz(lazy, &scratch))
        status = CSGM_ERR_MEMORY;
    else if (options->bounds == CSG_LAZY_EXACT)
        status = find_exact_bounds(lazy, &scratch, options->band);
    else if (options->bounds != CSG_LAZY_NO_BOUNDS)
        status = find_paper_boxes(lazy, &scratch, options->bounds == CSG_LAZY_SHARED_BOXES);
    for (size_t i = 0; status == CSGM_OK && i < lazy->tree.node_count; i++) {
        csg_lazy_bound *bound = &lazy->bounds[i];
        if (!bound->is_known || is_all_of_space(bound->box) || !isfinite(bound->lambda))
            *bound = (csg_lazy_bound){csg_box_all(), bound->lambda, 0, false};
    }
    csg_arena_reset(&scratch);
    return status;
}
