/* SPDX-License-Identifier: MIT
 * Levels, regions and clamp boxes of the exact two-level scheme (operators.md 3.5), n-ary: from the
 * root down, each child gets the band of values in which it must be exact and the part of space in
 * which it matters.
 */
#include "scene/boxes/bounds.h"

#include "scene/boxes/exterior.h"
#include "scene/boxes/field_levels.h"
#include "scene/boxes/level_boxes.h"

/* The root's own box is then the hull of the leaves' boxes, and no look from above makes it
 * smaller. Scenes of a million solids are mostly like that. */
static bool is_union_of_placed_leaves(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        bool joins = node->kind == CSG_NODE_UNION && csg_blend_is_sharp(node->blend);
        if (csg_node_is_operator(node->kind) && !joins)
            return false;
        if (node->kind != CSG_NODE_TRANSFORM)
            continue;
        const csg_node *child = node;
        while (child->kind == CSG_NODE_TRANSFORM || child->kind == CSG_NODE_COLOR)
            child = &scene->nodes[csg_scene_children(scene, child)[0]];
        if (child->child_count)
            return false;
    }
    return true;
}

csgm_status csg_bounds_fill(csgm_scene *scene)
{
    csgm_status status = csg_level_boxes(scene, NULL, scene->bounds);
    csg_box root = csg_box_all();
    if (status == CSGM_OK && !is_union_of_placed_leaves(scene))
        status = csg_level_box_of_root(scene, &root);
    if (status == CSGM_OK)
        root = scene->bounds[scene->root] = csg_box_intersect(scene->bounds[scene->root], root);
    bool is_known = csg_box_is_finite(root) || csg_box_is_empty(root);
    if (status == CSGM_OK && scene->softness && !is_known) { /* else levels have said it all */
        status = csg_exterior_box(scene, &root);
        scene->bounds[scene->root] = csg_box_intersect(scene->bounds[scene->root], root);
    }
    return status;
}

csg_box csg_bounds_of_solid(const csgm_scene *scene)
{
    return scene->bounds[scene->root];
}

static bool takes_fields(const csg_node *node)
{
    return csg_node_is_operator(node->kind) && csg_blend_takes_fields(node->blend);
}

/* The band [-below, above] of child number `index`. */
static void hand_down_levels(const csgm_scene *scene, const csg_node *node, uint32_t index,
                             const csg_node_bounds *parent, csg_node_bounds *child)
{
    double support = 0, below = parent->below, above = parent->above;
    if (csg_node_is_operator(node->kind))
        support = csg_scene_support(scene, node);
    bool interior = csg_node_is_operator(node->kind) && csg_blend_is_interior(node->blend);
    if (node->kind == CSG_NODE_UNION || interior)
        below += support;
    if (node->kind != CSG_NODE_UNION || interior)
        above += support; /* intersection and difference */
    if (node->kind == CSG_NODE_SOFT || takes_fields(node)) {
        csg_field_band(scene, node, index, &child->below, &child->above);
        return;
    }
    if (node->kind == CSG_NODE_COMBINE) { /* not monotone: any value of an operand may matter */
        child->below = child->above = INFINITY;
        return;
    }
    double r = node->kind == CSG_NODE_OFFSET ? csg_scene_parameters(scene, node)[0] : 0;
    double scale = 1;
    if (node->kind == CSG_NODE_TRANSFORM)
        scale = scene->scales[node->payload];
    else if (node->kind == CSG_NODE_WARP)
        scale = csg_warp_scale(&scene->warps[node->payload]);
    below = fmax(below / scale + r, 0);
    above = fmax(above / scale - r, 0);
    bool subtracted = node->kind == CSG_NODE_DIFFERENCE && index > 0;
    child->below = subtracted ? above : below;
    child->above = subtracted ? below : above;
}

/* Below an intersection an operand matters only inside the others' boxes. A child's clamp_box
 * holds its region until the child is visited. */
static void hand_down_regions(const csgm_scene *scene, const csg_node *node, csg_box region,
                              csg_node_bounds *out)
{
    const csg_node_id *children = csg_scene_children(scene, node);
    uint32_t count = node->child_count;
    if (node->kind == CSG_NODE_TRANSFORM)
        region = csg_affine_box(&scene->inverses[node->payload], region);
    else if (node->kind == CSG_NODE_WARP)
        region = csg_box_all();
    for (uint32_t k = 0; k < count; k++)
        out[children[k]].clamp_box = region;
    if (takes_fields(node)) /* what one operand is can matter wherever another is */
        return;
    if (node->kind == CSG_NODE_DIFFERENCE) {
        for (uint32_t k = 1; k < count; k++)
            out[children[k]].clamp_box = csg_box_intersect(region, out[children[0]].level_box);
    } else if (node->kind == CSG_NODE_INTERSECTION) {
        csg_box after = region, before = region;
        for (uint32_t k = count; k-- > 0;) {
            out[children[k]].clamp_box = after;
            after = csg_box_intersect(after, out[children[k]].level_box);
        }
        for (uint32_t k = 0; k < count; k++) {
            out[children[k]].clamp_box = csg_box_intersect(out[children[k]].clamp_box, before);
            before = csg_box_intersect(before, out[children[k]].level_box);
        }
    }
}

static csgm_status fill_level_boxes(const csgm_scene *scene, csg_arena *scratch,
                                    csg_node_bounds *out)
{
    double *levels = csg_arena_calloc(scratch, scene->node_count, sizeof *levels);
    csg_box *boxes = csg_arena_calloc(scratch, scene->node_count, sizeof *boxes);
    if (!levels || !boxes)
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < scene->node_count; i++)
        levels[i] = out[i].below;
    csgm_status status = csg_level_boxes(scene, levels, boxes);
    for (size_t i = 0; i < scene->node_count; i++)
        out[i].level_box = boxes[i];
    return status;
}

csgm_status csg_bounds_compute(const csgm_scene *scene, double delta, csg_node_bounds *out)
{
    out[scene->root] = (csg_node_bounds){.below = delta, .above = delta};
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        for (uint32_t k = 0; k < node->child_count; k++)
            hand_down_levels(scene, node, k, &out[i], &out[csg_scene_children(scene, node)[k]]);
    }
    csg_arena scratch;
    csg_arena_init(&scratch, &scene->context->memory);
    csgm_status status = fill_level_boxes(scene, &scratch, out);
    csg_arena_reset(&scratch);
    if (status != CSGM_OK)
        return status;
    out[scene->root].clamp_box = csg_box_all();
    for (size_t i = scene->node_count; i-- > 0;) {
        csg_box region = out[i].clamp_box;
        out[i].clamp_box =
            csg_box_intersect(out[i].level_box, csg_box_grow(region, out[i].below + out[i].above));
        hand_down_regions(scene, &scene->nodes[i], csg_box_intersect(region, out[i].clamp_box),
                          out);
    }
    return CSGM_OK;
}
