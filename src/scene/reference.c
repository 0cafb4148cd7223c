/* SPDX-License-Identifier: MIT
 * Value and gradient of a whole scene at one point: points go down the tree (a loop from the root
 * to the leaves), samples come up (a loop back). Small scenes work on the stack.
 */
#include "scene/reference.h"

#include "scene/operators/fillet.h"

#include "scene/operators/choice.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"

typedef struct workspace {
    csg_vec3 *points; /* per node, in its own frame */
    csg_sample *samples;
    csg_fillet_room fillets;
    csg_reference_work node;
    void *heap;
    size_t heap_bytes;
} workspace;

enum { STACK_BYTES = 16384 };

static bool workspace_begin(workspace *w, const csgm_scene *scene, void *stack)
{
    size_t nodes = scene->node_count, steps = 0;
    for (size_t i = 0; i < scene->formula_count; i++)
        steps = scene->formulas[i].count > steps ? scene->formulas[i].count : steps;
    size_t of_fillets = 0;
    for (size_t i = 0; i < nodes && !of_fillets; i++)
        if (csg_node_is_fillet(&scene->nodes[i]))
            of_fillets = CSG_FILLET_ROOM_BYTES;
    size_t bytes =
        nodes * (sizeof *w->points + sizeof *w->samples + 2 * sizeof(double) + of_fillets) +
        steps * sizeof *w->node.steps;
    *w = (workspace){0};
    if (bytes > STACK_BYTES) {
        w->heap = stack = csg_memory_alloc(&scene->context->memory, bytes);
        w->heap_bytes = bytes;
        if (!stack)
            return false;
    }
    w->samples = stack;
    w->points = (csg_vec3 *)(w->samples + nodes);
    w->node.values = (double *)(w->points + nodes); /* no operator has as many children as nodes */
    w->node.partials = w->node.values + nodes;
    w->node.steps = (csg_formula_dual *)(w->node.partials + nodes);
    if (of_fillets) {
        w->fillets.terms = (csg_fillet_term *)(w->node.steps + steps);
        w->fillets.pieces = (csg_fillet_piece *)(w->fillets.terms + nodes);
        w->fillets.bounds = (double(*)[2])(w->fillets.pieces + nodes);
        w->fillets.nodes = (csg_fillet_node *)(w->fillets.bounds + nodes);
    }
    return true;
}

static void workspace_end(workspace *w, const csgm_scene *scene)
{
    csg_memory_release(&scene->context->memory, w->heap, w->heap_bytes);
}

csg_vec3 csg_reference_inner_point(const csgm_scene *scene, const csg_node *node, csg_vec3 p)
{
    if (node->kind == CSG_NODE_TRANSFORM)
        return csg_affine_point(&scene->inverses[node->payload], p);
    return node->kind == CSG_NODE_WARP ? csg_warp_at(&scene->warps[node->payload], p).at : p;
}

static void place_points(workspace *w, const csgm_scene *scene, csg_node_id first, csg_node_id root,
                         csg_vec3 p)
{
    w->points[root] = p;
    for (size_t i = (size_t)root + 1; i-- > first;) {
        const csg_node *node = &scene->nodes[i];
        csg_vec3 inner = csg_reference_inner_point(scene, node, w->points[i]);
        for (uint32_t k = 0; k < node->child_count; k++)
            w->points[csg_scene_children(scene, node)[k]] = inner;
    }
}

/* An operator is the union of its children with these signs, times the first sign: intersection
 * -G(-f), difference -G(-f1, f2, ...). */
static double operand_sign(csg_node_kind kind, uint32_t index)
{
    return kind == CSG_NODE_INTERSECTION || (kind == CSG_NODE_DIFFERENCE && index == 0) ? -1 : 1;
}

static csg_sample combine(const csg_reference_work *w, const csgm_scene *scene,
                          const csg_node *node, const csg_sample *samples, const csg_node_id *at)
{
    csg_node_kind kind = node->kind;
    for (uint32_t k = 0; k < node->child_count; k++)
        w->values[k] = operand_sign(kind, k) * samples[at[k]].value;
    double outer = operand_sign(kind, 0);
    const csg_rule *rule = csg_scene_rule(scene, node);
    csg_blend blend = csg_scene_blend(scene, node);
    if (csg_blend_is_fillet(blend.kind)) /* a held one: what it is made of is asked above it */
        blend = (csg_blend){CSG_BLEND_SHARP, 0};
    double value =
        outer * (rule ? csg_rule_apply(rule, true, w->values, node->child_count, 0, w->partials)
                      : csg_reference_union(blend, w->values, node->child_count, w->partials));
    csg_vec3 gradient = {0, 0, 0};
    for (uint32_t k = 0; k < node->child_count; k++) {
        double weight = outer * operand_sign(kind, k) * w->partials[k];
        if (weight != 0)
            gradient = csg_vec3_add(gradient, csg_vec3_scale(samples[at[k]].gradient, weight));
    }
    return (csg_sample){value, gradient};
}

/* The cosine of the angle between two gradients; 0 where one is none. */
static double cosine_of(csg_vec3 a, csg_vec3 b)
{
    double lengths = csg_vec3_norm(a) * csg_vec3_norm(b);
    return lengths > 0 ? fmin(fmax(csg_vec3_dot(a, b) / lengths, -1), 1) : 0;
}

/* The operands' fields; each one's gradient is `slopes` times that of its sample. */
static double field_cosine(const csg_reference_work *w, const csgm_scene *scene,
                           const csg_node *node, const csg_sample *samples, const csg_node_id *at)
{
    csg_vec3 gradients[2] = {{0, 0, 0}, {0, 0, 0}};
    for (uint32_t k = 0; k < node->child_count; k++) {
        double slope, field = csg_operand_field(csg_scene_operand(scene, node, k),
                                                samples[at[k]].value, &slope);
        bool subtracted = node->kind == CSG_NODE_DIFFERENCE && k > 0;
        w->values[k] = subtracted ? 1 - field : field;
        if (k < 2)
            gradients[k] = csg_vec3_scale(samples[at[k]].gradient, subtracted ? -slope : slope);
    }
    return cosine_of(gradients[0], gradients[1]);
}

static csg_sample combine_fields(const csg_reference_work *w, const csgm_scene *scene,
                                 const csg_node *node, const csg_sample *samples,
                                 const csg_node_id *at)
{
    double lambda = csg_scene_parameters(scene, node)[CSG_OPERATOR_LAMBDA];
    double cosine = field_cosine(w, scene, node, samples, at);
    double value = csg_rule_apply(csg_scene_rule(scene, node), node->kind == CSG_NODE_UNION,
                                  w->values, node->child_count, cosine, w->partials);
    csg_sample out = {(value - 0.5) / lambda, {0, 0, 0}};
    for (uint32_t k = 0; k < node->child_count; k++) {
        double slope;
        csg_operand_field(csg_scene_operand(scene, node, k), samples[at[k]].value, &slope);
        bool subtracted = node->kind == CSG_NODE_DIFFERENCE && k > 0;
        double weight = w->partials[k] * (subtracted ? -slope : slope) / lambda;
        if (weight != 0)
            out.gradient =
                csg_vec3_add(out.gradient, csg_vec3_scale(samples[at[k]].gradient, weight));
    }
    return out;
}

static csg_sample soften(const csgm_scene *scene, const csg_node *node, csg_sample inner)
{
    double slope, field = csg_soft_at(csg_scene_soft(scene, node), inner.value, &slope);
    double lambda = csg_scene_parameters(scene, node)[CSG_SOFT_LAMBDA];
    return (csg_sample){(field - 0.5) / lambda, csg_vec3_scale(inner.gradient, slope / lambda)};
}

static csg_sample transform(const csgm_scene *scene, const csg_node *node, csg_sample inner)
{
    double scale = scene->scales[node->payload];
    csg_vec3 gradient = csg_affine_covector(&scene->inverses[node->payload], inner.gradient);
    return (csg_sample){scale * inner.value, csg_vec3_scale(gradient, scale)};
}

static csg_sample warp(const csgm_scene *scene, const csg_node *node, csg_vec3 p, csg_sample inner)
{
    const csg_warp *map = &scene->warps[node->payload];
    csg_warped warped = csg_warp_at(map, p);
    double scale = csg_warp_scale(map), gradient[3];
    for (int i = 0; i < 3; i++)
        gradient[i] = csg_vec3_dot(warped.column[i], inner.gradient);
    return (csg_sample){scale * inner.value,
                        {scale * gradient[0], scale * gradient[1], scale * gradient[2]}};
}

static csg_sample offset(const csgm_scene *scene, const csg_node *node, csg_sample inner)
{
    inner.value += csg_scene_parameters(scene, node)[0];
    return inner;
}

static csg_sample combine_by_formula(const csg_reference_work *w, const csgm_scene *scene,
                                     const csg_node *node, const csg_sample *samples,
                                     const csg_node_id *at)
{
    const csg_formula *formula = &scene->formulas[node->payload];
    double values[3] = {0};
    for (uint32_t k = 0; k < node->child_count; k++)
        values[k] = samples[at[k]].value;
    csg_formula_dual dual = csg_formula_evaluate(
        scene->steps, formula, csg_vec3_make(values[0], values[1], values[2]), w->steps);
    const double partials[3] = {dual.gradient.x, dual.gradient.y, dual.gradient.z};
    csg_sample out = {dual.value / formula->lipschitz, {0, 0, 0}};
    for (uint32_t k = 0; k < node->child_count; k++)
        out.gradient = csg_vec3_add(out.gradient, csg_vec3_scale(samples[at[k]].gradient,
                                                                 partials[k] / formula->lipschitz));
    return out;
}

static csg_sample sample_leaf(const csg_reference_work *w, const csgm_scene *scene,
                              const csg_node *node, csg_vec3 p)
{
    if (node->kind == CSG_NODE_SHAPE) {
        csg_sample sample;
        sample.value = csg_shape_sample(scene->shapes[node->payload], p, &sample.gradient);
        return sample;
    }
    if (node->kind != CSG_NODE_FIELD)
        return csg_reference_primitive(node->kind, csg_scene_parameters(scene, node), p);
    csg_formula_dual dual =
        csg_formula_evaluate(scene->steps, &scene->formulas[node->payload], p, w->steps);
    return (csg_sample){dual.value, dual.gradient};
}

csg_sample csg_reference_node(const csgm_scene *scene, const csg_node *node, csg_vec3 p,
                              const csg_sample *samples, const csg_node_id *at,
                              const csg_reference_work *work)
{
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_TRANSFORM:
        return transform(scene, node, samples[at[0]]);
    case CSG_NODE_COLOR:
        return samples[at[0]];
    case CSG_NODE_OFFSET:
        return offset(scene, node, samples[at[0]]);
    case CSG_NODE_WARP:
        return warp(scene, node, p, samples[at[0]]);
    case CSG_NODE_COMBINE:
        return combine_by_formula(work, scene, node, samples, at);
    case CSG_NODE_SOFT:
        return soften(scene, node, samples[at[0]]);
    default:
        if (!csg_node_is_operator(node->kind))
            return sample_leaf(work, scene, node, p);
        return csg_blend_takes_fields(node->blend) ? combine_fields(work, scene, node, samples, at)
                                                   : combine(work, scene, node, samples, at);
    }
}

csg_sample csg_reference_wrap(const csgm_scene *scene, const csg_node *node, csg_vec3 p,
                              csg_sample inner)
{
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_TRANSFORM:
        return transform(scene, node, inner);
    case CSG_NODE_OFFSET:
        return offset(scene, node, inner);
    case CSG_NODE_WARP:
        return warp(scene, node, p, inner);
    default:
        return inner;
    }
}

static void evaluate(workspace *w, const csgm_scene *scene, csg_node_id first, csg_node_id last)
{
    for (size_t i = first; i <= last; i++) {
        const csg_node *node = &scene->nodes[i];
        if (csg_fillet_is_outermost(node))
            w->samples[i] =
                csg_reference_fillet(scene, (csg_node_id)i, w->points, w->samples, &w->fillets);
        else
            w->samples[i] = csg_reference_node(scene, node, w->points[i], w->samples,
                                               csg_scene_children(scene, node), &w->node);
    }
}

csg_node_id csg_scene_first_below(const csgm_scene *scene, csg_node_id id)
{
    while (scene->nodes[id].child_count)
        id = csg_scene_children(scene, &scene->nodes[id])[0];
    return id;
}

csg_sample csg_reference_eval(const csgm_scene *scene, csg_vec3 p, csgm_status *status)
{
    double stack[STACK_BYTES / sizeof(double)];
    workspace w;
    if (!workspace_begin(&w, scene, stack)) {
        *status = CSGM_ERR_MEMORY;
        return (csg_sample){NAN, {0, 0, 0}};
    }
    place_points(&w, scene, 0, scene->root, p);
    evaluate(&w, scene, 0, scene->root);
    csg_sample root = w.samples[scene->root];
    workspace_end(&w, scene);
    return root;
}

csg_sample csg_reference_eval_below(const csgm_scene *scene, csg_node_id root, csg_vec3 p)
{
    double stack[STACK_BYTES / sizeof(double)];
    workspace w;
    csg_node_id first = csg_scene_first_below(scene, root);
    if (!workspace_begin(&w, scene, stack))
        return (csg_sample){NAN, {0, 0, 0}};
    place_points(&w, scene, first, root, p);
    evaluate(&w, scene, first, root);
    csg_sample out = w.samples[root];
    workspace_end(&w, scene);
    return out;
}

/* Marks the node's children that can change its value by setting points[child].x to 1. */
static void mark_active(workspace *w, const csgm_scene *scene, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(scene, node);
    if (!csg_node_is_operator(node->kind)) {
        for (uint32_t k = 0; k < node->child_count; k++)
            w->points[children[k]].x = 1;
        return;
    }
    double support = csg_scene_support(scene, node);
    uint32_t top = 0;
    for (uint32_t k = 0; k < node->child_count; k++) {
        w->node.values[k] = operand_sign(node->kind, k) * w->samples[children[k]].value;
        if (w->node.values[k] >= w->node.values[top])
            top = k;
    }
    for (uint32_t k = 0; k < node->child_count; k++)
        if (k == top || w->node.values[top] - w->node.values[k] < support)
            w->points[children[k]].x = 1;
}

uint32_t csg_reference_active_primitives(const csgm_scene *scene, csg_vec3 p, csgm_status *status)
{
    double stack[STACK_BYTES / sizeof(double)];
    workspace w;
    if (!workspace_begin(&w, scene, stack)) {
        *status = CSGM_ERR_MEMORY;
        return 0;
    }
    place_points(&w, scene, 0, scene->root, p);
    evaluate(&w, scene, 0, scene->root);
    for (size_t i = 0; i < scene->node_count; i++)
        w.points[i].x = i == scene->root; /* the points have done their work: marks instead */
    uint32_t active = 0;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        if (w.points[i].x == 0)
            continue;
        active += csg_node_is_primitive(node->kind);
        mark_active(&w, scene, node);
    }
    workspace_end(&w, scene);
    return active;
}

static uint32_t deciding_child(const workspace *w, const csgm_scene *scene, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(scene, node);
    uint32_t best = 0;
    double most = -INFINITY;
    for (uint32_t k = 0; k < node->child_count; k++) {
        double value = w->samples[children[k]].value;
        value = csg_node_is_operator((csg_node_kind)node->kind)
                    ? operand_sign((csg_node_kind)node->kind, k) * value
                    : -fabs(value);
        if (value > most) {
            most = value;
            best = k;
        }
    }
    return best;
}

csg_node_id csg_reference_deciding_leaf(const csgm_scene *scene, csg_vec3 p, csgm_status *status)
{
    double stack[STACK_BYTES / sizeof(double)];
    workspace w;
    if (!workspace_begin(&w, scene, stack)) {
        *status = CSGM_ERR_MEMORY;
        return CSG_NODE_NONE;
    }
    place_points(&w, scene, 0, scene->root, p);
    evaluate(&w, scene, 0, scene->root);
    csg_node_id id = scene->root;
    while (scene->nodes[id].child_count)
        id = csg_scene_children(scene,
                                &scene->nodes[id])[deciding_child(&w, scene, &scene->nodes[id])];
    workspace_end(&w, scene);
    return id;
}
