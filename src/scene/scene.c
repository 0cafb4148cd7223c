/* SPDX-License-Identifier: MIT
 * Names and numbers of primitives, read out of primitives.def, and what nodes say of themselves.
 */
#include "scene/scene.h"

#include <assert.h>

#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"
#include "shape/plane/drawing.h"

typedef struct kind_row {
    const char *name;
    uint32_t parameter_count;
} kind_row;

static const kind_row kinds[] = {
    [CSG_NODE_EMPTY] = {"empty", 0},           [CSG_NODE_FIELD] = {"field", 0},
    [CSG_NODE_SHAPE] = {"shape", 0},
#define CSG_PRIMITIVE(NAME, name, count, ...) [CSG_NODE_##NAME] = {#name, count},
#include "scene/primitives/primitives.def"
    [CSG_NODE_TRANSFORM] = {"transform", 0},   [CSG_NODE_COLOR] = {"color", 0},
    [CSG_NODE_OFFSET] = {"offset", 1},         [CSG_NODE_WARP] = {"warp", 0},
    [CSG_NODE_COMBINE] = {"combine", 0},       [CSG_NODE_SOFT] = {"soft", CSG_SOFT_PARAMETERS},
    [CSG_NODE_UNION] = {"union", 0},           [CSG_NODE_INTERSECTION] = {"intersection", 0},
    [CSG_NODE_DIFFERENCE] = {"difference", 0},
};

const char *csg_node_kind_name(csg_node_kind kind)
{
    assert((size_t)kind < sizeof kinds / sizeof *kinds);
    return kinds[kind].name;
}

uint32_t csg_primitive_parameter_count(csg_primitive_kind kind)
{
    assert((size_t)kind < sizeof kinds / sizeof *kinds);
    return kinds[kind].parameter_count;
}

void csg_look_take_inner(csg_look *outer, const csg_look *inner)
{
    if (!outer->has_color)
        outer->color = inner->color;
    if (!outer->has_material) {
        outer->metallic = inner->metallic;
        outer->roughness = inner->roughness;
    }
    outer->has_color |= inner->has_color;
    outer->has_material |= inner->has_material;
}

csg_blend csg_scene_blend(const csgm_scene *scene, const csg_node *node)
{
    return (csg_blend){node->blend, scene->parameters[node->payload], false};
}

uint32_t csg_node_parameter_count(const csg_node *node)
{
    if (!csg_node_is_operator(node->kind))
        return csg_primitive_parameter_count(node->kind);
    bool fields = csg_blend_takes_fields(node->blend) ||
                  (csg_blend_is_sharp(node->blend) && (node->flags & CSG_FLAG_SOFT));
    if (csg_blend_is_fillet(node->blend))
        return CSG_FILLET_PARAMETERS;
    return fields ? CSG_OPERATOR_FIELD_PARAMETERS : 1;
}

bool csg_node_is_plate(const csg_node *node)
{
    return node->kind == CSG_NODE_INTERSECTION && csg_blend_is_orthogonal(node->blend);
}

bool csg_node_is_fillet(const csg_node *node)
{
    return csg_node_is_operator(node->kind) && csg_blend_is_fillet(node->blend);
}

bool csg_node_is_idle(const csg_node *node)
{
    return csg_node_is_operator(node->kind) && csg_blend_is_sharp(node->blend) &&
           (node->flags & (CSG_FLAG_NUMBER | CSG_FLAG_SOFT)) == CSG_FLAG_NUMBER;
}

bool csg_node_ends_flush(const csg_node *node)
{
    return node->kind == CSG_NODE_UNION &&
           (csg_blend_is_fillet(node->blend) ||
            (node->flags & (CSG_FLAG_UNGROUPED | CSG_FLAG_UNENDED)));
}

csg_fillet_planes csg_scene_fillet_planes(const csgm_scene *scene, const csg_node *node)
{
    const double *v = csg_scene_parameters(scene, node);
    csg_fillet_planes planes = {.count = (size_t)v[CSG_FILLET_PLANES]};
    if (planes.count) {
        planes.ends = scene->ends + (size_t)v[CSG_FILLET_FIRST_NORMAL];
        planes.reaches = scene->reaches + (size_t)v[CSG_FILLET_FIRST_REACH];
    }
    if (v[CSG_FILLET_APART] > 0 && scene->apart)
        planes.apart = scene->apart + ((size_t)v[CSG_FILLET_APART] - 1);
    return planes;
}

bool csg_fillet_planes_are_apart(const csg_fillet_planes *planes, uint32_t a, uint32_t b)
{
    for (uint32_t i = planes->apart[a]; i < planes->apart[a + 1]; i++)
        if (planes->apart[i] == b)
            return true;
    return false;
}

double csg_fillet_towards(const csg_fillet_end *end, csg_vec3 p, csg_vec3 *away)
{
    *away = end->normal;
    if (!end->is_round)
        return csg_vec3_dot(end->normal, p);
    csg_vec3 v = csg_vec3_sub(p, end->foot);
    v = csg_vec3_sub(v, csg_vec3_scale(end->normal, csg_vec3_dot(end->normal, v)));
    *away = csg_vec3_normalize(v);
    return csg_vec3_norm(v);
}

const csg_rule *csg_scene_rule(const csgm_scene *scene, const csg_node *node)
{
    bool has = csg_node_is_operator((csg_node_kind)node->kind) && csg_blend_is_rule(node->blend);
    return has ? &scene->rules[(size_t)scene->parameters[node->payload]] : NULL;
}

csg_soft csg_scene_soft(const csgm_scene *scene, const csg_node *node)
{
    const double *v = csg_scene_parameters(scene, node);
    return (csg_soft){(csg_falloff)v[CSG_SOFT_FALLOFF], v[CSG_SOFT_RANGE]};
}

csg_operand csg_scene_operand(const csgm_scene *scene, const csg_node *node, uint32_t index)
{
    double lambda = csg_scene_softness(scene, csg_scene_children(scene, node)[index]);
    double range = csg_scene_parameters(scene, node)[CSG_OPERATOR_RANGE];
    return lambda > 0 ? (csg_operand){lambda, true} : (csg_operand){1 / range, false};
}

double csg_scene_support(const csgm_scene *scene, const csg_node *node)
{
    const csg_rule *rule = csg_scene_rule(scene, node);
    return rule ? csg_rule_support(rule) : csg_blend_support(csg_scene_blend(scene, node));
}

double csg_scene_excess(const csgm_scene *scene, const csg_node *node)
{
    const csg_rule *rule = csg_scene_rule(scene, node);
    return rule ? csg_rule_excess(rule)
                : csg_blend_excess(csg_scene_blend(scene, node), node->child_count);
}

/* Without rules the largest of the leaves': no operator changes it. */
double csg_scene_lipschitz(const csgm_scene *scene)
{
    double largest = 0;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        if (node->kind == CSG_NODE_FIELD)
            largest = fmax(largest, scene->formulas[node->payload].lipschitz);
        else if (csg_node_is_primitive(node->kind))
            largest = fmax(largest, 1); /* exact distances */
    }
    if (scene->slope > 0)
        return scene->slope;
    return largest > 0 ? largest : 1;
}

bool csg_scene_has_colors(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->look_count; i++)
        if (scene->looks[i].has_color)
            return true;
    return false;
}

void csg_scene_destroy(csgm_scene *scene)
{
    if (!scene)
        return;
    csg_memory *memory = &scene->context->memory;
    for (size_t i = 0; i < scene->shape_count; i++)
        csg_shape_release(scene->shapes[i]);
    for (int i = 0; i < CSGM_MARK_COUNT; i++) /* these have none themselves */
        csg_scene_destroy(scene->marked[i]);
    csg_drawing_destroy(scene->drawing);
    csg_arena_reset(&scene->arena);
    csg_memory_release(memory, scene, sizeof *scene);
}
