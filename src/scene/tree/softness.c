/* SPDX-License-Identifier: MIT
 * Which nodes of a sealed scene are soft, the lambda that each divides its field by, and Lipschitz
 * constants of all nodes (operators.md 9). A sharp operator whose operands are soft by different
 * lambdas compares their fields only where something above takes fields; else it compares values.
 */
#include "scene/tree/softness.h"

#include <string.h>

#include "scene/operators/rule.h"
#include "scene/operators/soft.h"

static double slope_of_operand(const csgm_scene *scene, const csg_node *node, uint32_t index,
                               const double *slopes)
{
    csg_operand operand = csg_scene_operand(scene, node, index);
    const double steepest = 1.125; /* of H3 */
    return slopes[csg_scene_children(scene, node)[index]] * operand.slope *
           (operand.soft ? 1 : steepest);
}

static double largest_slope(const csgm_scene *scene, const csg_node *node, const double *slopes)
{
    double most = 0;
    for (uint32_t k = 0; k < node->child_count; k++)
        most = fmax(most, slopes[csg_scene_children(scene, node)[k]]);
    return most;
}

/* Of G on the operands' fields. */
static double field_slope(const csgm_scene *scene, const csg_node *node, const double *slopes,
                          double *room)
{
    for (uint32_t k = 0; k < node->child_count; k++)
        room[k] = slope_of_operand(scene, node, k, slopes);
    double slope = csg_rule_slope(csg_scene_rule(scene, node), node->kind == CSG_NODE_UNION, room,
                                  node->child_count);
    return slope > 0 ? slope : 1;
}

static double own_slope(const csgm_scene *scene, const csg_node *node, const double *slopes)
{
    const csg_rule *rule = csg_scene_rule(scene, node);
    if (node->kind == CSG_NODE_EMPTY)
        return 0;
    if (node->kind == CSG_NODE_FIELD)
        return scene->formulas[node->payload].lipschitz;
    if (!node->child_count)
        return 1; /* exact distances, gauges */
    if (rule && csg_blend_takes_fields(rule->kind))
        return 1; /* divided by what it is */
    if (node->kind == CSG_NODE_SOFT)
        return 1;
    double most = largest_slope(scene, node, slopes);
    return rule ? most * rule->k[node->kind != CSG_NODE_UNION] : most;
}

void csg_scene_slopes(const csgm_scene *scene, double *out)
{
    for (size_t i = 0; i < scene->node_count; i++)
        out[i] = own_slope(scene, &scene->nodes[i], out);
}

/* ---- sealing ----------------------------------------------------------------------------------
 */

typedef struct work {
    csgm_scene *scene;
    double *slopes, *room;
    uint8_t *wanted; /* something above takes its field */
} work;

static bool passes_fields_on(const csg_node *node)
{
    bool sharp = csg_node_is_operator(node->kind) && csg_blend_is_sharp(node->blend);
    return node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
           node->kind == CSG_NODE_WARP || (sharp && (node->flags & CSG_FLAG_SOFT));
}

static void mark_wanted(work *w)
{
    const csgm_scene *scene = w->scene;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        const csg_rule *rule = csg_scene_rule(scene, node);
        bool asks =
            rule ? csg_blend_takes_fields(rule->kind) : w->wanted[i] && passes_fields_on(node);
        for (uint32_t k = 0; k < node->child_count; k++)
            w->wanted[csg_scene_children(scene, node)[k]] = asks;
    }
}

static bool all_alike(const csgm_scene *scene, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(scene, node);
    for (uint32_t k = 1; k < node->child_count; k++)
        if (scene->softness[children[k]] != scene->softness[children[0]])
            return false;
    return true;
}

/* The last of the rules is FIELD_SHARP. */
static void settle_operator(work *w, size_t i)
{
    csgm_scene *scene = w->scene;
    csg_node *node = &scene->nodes[i];
    double *parameters = scene->parameters + node->payload;
    if (!(node->flags & CSG_FLAG_SOFT))
        return;
    if (csg_blend_is_sharp(node->blend)) {
        if (all_alike(scene, node)) {
            scene->softness[i] = scene->softness[csg_scene_children(scene, node)[0]];
            return;
        }
        if (!w->wanted[i]) {
            node->flags &= (uint8_t)~CSG_FLAG_SOFT;
            return;
        }
        node->blend = (uint8_t)csg_rule_of_fields().kind;
        parameters[0] = (double)(scene->rule_count - 1);
    }
    scene->softness[i] = parameters[CSG_OPERATOR_LAMBDA] =
        field_slope(scene, node, w->slopes, w->room);
}

static void settle_node(work *w, size_t i)
{
    csgm_scene *scene = w->scene;
    csg_node *node = &scene->nodes[i];
    csg_node_id child = node->child_count ? csg_scene_children(scene, node)[0] : 0;
    if (csg_node_is_operator(node->kind)) {
        settle_operator(w, i);
    } else if (node->kind == CSG_NODE_SOFT) {
        double *parameters = scene->parameters + node->payload;
        double slope = w->slopes[child] > 0 ? w->slopes[child] : 1;
        scene->softness[i] = parameters[CSG_SOFT_LAMBDA] =
            slope * csg_soft_lambda(csg_scene_soft(scene, node));
    } else if (node->child_count && scene->softness[child] > 0 && passes_fields_on(node)) {
        double scale = node->kind == CSG_NODE_TRANSFORM ? scene->scales[node->payload]
                       : node->kind == CSG_NODE_WARP ? csg_warp_scale(&scene->warps[node->payload])
                                                     : 1;
        scene->softness[i] = scene->softness[child] / scale;
    }
    w->slopes[i] = own_slope(scene, node, w->slopes);
}

bool csg_softness_settle(csgm_scene *scene, csg_arena *scratch)
{
    work w = {.scene = scene};
    w.slopes = csg_arena_calloc(scratch, scene->node_count, sizeof *w.slopes);
    w.room = csg_arena_calloc(scratch, scene->node_count, sizeof *w.room);
    w.wanted = csg_arena_calloc(scratch, scene->node_count, sizeof *w.wanted);
    scene->softness = csg_arena_calloc(&scene->arena, scene->node_count, sizeof *scene->softness);
    if (!w.slopes || !w.room || !w.wanted || !scene->softness)
        return false;
    mark_wanted(&w);
    for (size_t i = 0; i < scene->node_count; i++)
        settle_node(&w, i);
    scene->slope = w.slopes[scene->root];
    return true;
}
