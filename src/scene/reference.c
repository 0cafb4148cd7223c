/* SPDX-License-Identifier: MIT
 * Value and gradient of a whole scene at one point: points go down the tree (a loop from the root
 * to the leaves), samples come up (a loop back). Small scenes work on the stack.
 */
#include "scene/reference.h"

#include "scene/formula/formula.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/choice.h"
#include "scene/operators/combine.h"
#include "scene/operators/fillet.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"

typedef csg_reference_room workspace;

enum { STACK_BYTES = 16384 };

/* stack: for small scenes, or NULL. */
static bool begin_room(workspace *w, const csgm_scene *scene, void *stack)
{
    size_t nodes = scene->node_count, steps = 0;
    for (size_t i = 0; i < scene->formula_count; i++)
        steps = scene->formulas[i].count > steps ? scene->formulas[i].count : steps;
    size_t bytes = nodes * (sizeof *w->points + sizeof *w->samples + 2 * sizeof(double)) +
                   steps * sizeof *w->node.steps;
    *w = (workspace){0};
    if (!stack || bytes > STACK_BYTES) {
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
    return true;
}

bool csg_reference_room_begin(csg_reference_room *room, const csgm_scene *scene)
{
    return begin_room(room, scene, NULL);
}

void csg_reference_room_end(csg_reference_room *w, const csgm_scene *scene)
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

typedef struct fillet_end {
    csg_fillet_planes planes;
    csg_vec3 p;
} fillet_end;

static double fillet_inside(const void *user, const csg_fillet_operand *operands,
                            const csg_fillet_choice *subset, uint32_t *plane)
{
    const fillet_end *end = user;
    double least = INFINITY;
    for (size_t i = 0; i < end->planes.count; i++) {
        double reach = -INFINITY;
        for (uint32_t k = 0; k < subset->count; k++)
            reach = fmax(
                reach, end->planes.reaches[operands[subset->at[k]].index * end->planes.count + i]);
        csg_vec3 away;
        double inside = reach - csg_fillet_towards(&end->planes.ends[i], end->p, &away);
        if (inside < least)
            *plane = (uint32_t)i;
        least = fmin(least, inside);
    }
    return least;
}

static bool fillet_apart(const void *user, const csg_fillet_operand *a, const csg_fillet_operand *b)
{
    const fillet_end *end = user;
    return csg_fillet_planes_are_apart(&end->planes, a->index, b->index);
}

/* Of operands whose values are in w->values, with their signs; p: the point, in the node's own
 * frame. */
static csg_sample unite_fillet(const csg_reference_work *w, const csgm_scene *scene,
                               const csg_node *node, csg_vec3 p, const csg_sample *samples,
                               const csg_node_id *at)
{
    csg_fillet_operand reach[CSG_FILLET_MOST];
    fillet_end end = {csg_scene_fillet_planes(scene, node), p};
    csg_fillet_ends ends = {.inside = end.planes.count ? fillet_inside : NULL,
                            .user = &end,
                            .apart = end.planes.apart ? fillet_apart : NULL};
    uint32_t count = 0;
    double r = csg_scene_parameters(scene, node)[CSG_FILLET_N];
    size_t top = csg_largest_of(w->values, node->child_count);
    double most = csg_choose(w->values, node->child_count, top, w->partials);
    for (uint32_t k = 0; k < node->child_count && isfinite(most); k++) {
        csg_vec3 g = samples[at[k]].gradient;
        double sign = operand_sign((csg_node_kind)node->kind, k);
        csg_fillet_operand made = {.index = k};
        if (most - w->values[k] < 2 * r &&
            csg_fillet_set(&made, w->values[k], sign * g.x, sign * g.y, sign * g.z))
            count = csg_fillet_insert(reach, count, &made);
    }
    csg_sample out = {most, csg_vec3_scale(samples[at[top]].gradient,
                                           operand_sign((csg_node_kind)node->kind, (uint32_t)top))};
    if (count < 2)
        return out;
    csg_fillet_choice best = csg_fillet_solve(r, reach, count, &ends);
    if (!(reach[0].f + best.excess > most))
        return out;
    out = (csg_sample){reach[0].f + best.excess, {0, 0, 0}};
    if (best.is_ended) {
        csg_fillet_towards(&end.planes.ends[best.plane], p, &out.gradient);
        out.gradient = csg_vec3_scale(out.gradient, -1);
    }
    for (uint32_t i = 0; i < best.count && !best.is_ended; i++) {
        uint32_t k = reach[best.at[i]].index;
        double weight = operand_sign((csg_node_kind)node->kind, k) * best.share[i];
        out.gradient = csg_vec3_add(out.gradient, csg_vec3_scale(samples[at[k]].gradient, weight));
    }
    return out;
}

static csg_sample combine(const csg_reference_work *w, const csgm_scene *scene,
                          const csg_node *node, csg_vec3 p, const csg_sample *samples,
                          const csg_node_id *at)
{
    csg_node_kind kind = node->kind;
    for (uint32_t k = 0; k < node->child_count; k++)
        w->values[k] = operand_sign(kind, k) * samples[at[k]].value;
    double outer = operand_sign(kind, 0);
    if (csg_blend_is_fillet(node->blend)) {
        csg_sample made = unite_fillet(w, scene, node, p, samples, at);
        return (csg_sample){outer * made.value, csg_vec3_scale(made.gradient, outer)};
    }
    const csg_rule *rule = csg_scene_rule(scene, node);
    double value =
        outer * (rule ? csg_rule_apply(rule, true, w->values, node->child_count, 0, w->partials)
                      : csg_reference_union(csg_scene_blend(scene, node), w->values,
                                            node->child_count, w->partials));
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
    double values[CSG_COMBINE_MOST] = {0};
    csg_sample out = {0, {0, 0, 0}};
    for (uint32_t k = 0; k < node->child_count; k++)
        values[k] = samples[at[k]].value;
    for (uint32_t first = 0; first < node->child_count; first += 3) {
        csg_formula_dual dual =
            csg_formula_evaluate_group(scene->steps, formula, values, first / 3, w->steps);
        const double partials[3] = {dual.gradient.x, dual.gradient.y, dual.gradient.z};
        out.value = dual.value / formula->lipschitz;
        for (uint32_t k = 0; k < 3 && first + k < node->child_count; k++)
            out.gradient =
                csg_vec3_add(out.gradient, csg_vec3_scale(samples[at[first + k]].gradient,
                                                          partials[k] / formula->lipschitz));
    }
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
    case CSG_NODE_UNION:
    case CSG_NODE_INTERSECTION:
    case CSG_NODE_DIFFERENCE:
        return csg_blend_takes_fields(node->blend) ? combine_fields(work, scene, node, samples, at)
                                                   : combine(work, scene, node, p, samples, at);
    case CSG_NODE_EMPTY:
    case CSG_NODE_FIELD:
    case CSG_NODE_SHAPE:
    case CSG_NODE_FIRST_PRIMITIVE:
        break;
    }
    return sample_leaf(work, scene, node, p);
}

static void evaluate(workspace *w, const csgm_scene *scene, csg_node_id first, csg_node_id root)
{
    for (size_t i = first; i <= root; i++)
        w->samples[i] = csg_reference_node(scene, &scene->nodes[i], w->points[i], w->samples,
                                           csg_scene_children(scene, &scene->nodes[i]), &w->node);
}

csg_sample csg_reference_below(csg_reference_room *room, const csgm_scene *scene, csg_node_id first,
                               csg_node_id node, csg_vec3 p)
{
    place_points(room, scene, first, node, p);
    evaluate(room, scene, first, node);
    return room->samples[node];
}

uint64_t csg_reference_cost(const csgm_scene *scene, const csg_node *node)
{
    enum { SHAPE = 16 };
    if (node->kind == CSG_NODE_FIELD || node->kind == CSG_NODE_COMBINE)
        return 1 + scene->formulas[node->payload].count / 4;
    return node->kind == CSG_NODE_SHAPE ? SHAPE : 1;
}

bool csg_reference_turns(const csgm_scene *scene, const csg_node *node)
{
    const csg_rule *rule =
        csg_node_is_operator((csg_node_kind)node->kind) ? csg_scene_rule(scene, node) : NULL;
    return csg_node_is_fillet(node) ||
           (rule && rule->kind == CSG_BLEND_SCALE_SET && rule->parameters[3] > 0);
}

static bool turns(const csgm_scene *scene)
{
    bool any = false;
    for (size_t i = 0; i < scene->node_count && !any; i++)
        any = csg_reference_turns(scene, &scene->nodes[i]);
    return any;
}

/* A length that is small beside the node's solid, or beside where p is. */
static double step_of(const csgm_scene *scene, csg_node_id node, csg_vec3 p)
{
    static const double STEP = 0x1p-20;
    csg_vec3 size = csg_box_size(scene->bounds[node]);
    double far = fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
    double most = fmax(size.x, fmax(size.y, size.z));
    double length = most > 0 && most < INFINITY ? fmax(most, far) : far;
    return STEP * (length > 0 ? length : 1);
}

csg_vec3 csg_reference_true_gradient(csg_reference_room *room, const csgm_scene *scene,
                                     csg_node_id first, csg_node_id node, csg_vec3 p,
                                     csg_sample here)
{
    static const double JUMP = 1e-2; /* of slopes before and behind: a crease is between */
    double h = step_of(scene, node, p), slope[3];
    if (!turns(scene))
        return here.gradient;
    for (int axis = 0; axis < 3; axis++) {
        csg_vec3 step = {axis == 0 ? h : 0, axis == 1 ? h : 0, axis == 2 ? h : 0};
        double above = csg_reference_below(room, scene, first, node, csg_vec3_add(p, step)).value;
        double below = csg_reference_below(room, scene, first, node, csg_vec3_sub(p, step)).value;
        slope[axis] = (above - below) / (2 * h);
        if (!(fabs(above - 2 * here.value + below) <= JUMP * h))
            return here.gradient;
    }
    return csg_vec3_make(slope[0], slope[1], slope[2]);
}

static csg_sample evaluate_once(const csgm_scene *scene, csg_vec3 p, bool is_true,
                                csgm_status *status)
{
    double stack[STACK_BYTES / sizeof(double)];
    workspace w;
    if (!begin_room(&w, scene, stack)) {
        *status = CSGM_ERR_MEMORY;
        return (csg_sample){NAN, {0, 0, 0}};
    }
    csg_sample root = csg_reference_below(&w, scene, 0, scene->root, p);
    if (is_true)
        root.gradient = csg_reference_true_gradient(&w, scene, 0, scene->root, p, root);
    csg_reference_room_end(&w, scene);
    return root;
}

csg_sample csg_reference_eval(const csgm_scene *scene, csg_vec3 p, csgm_status *status)
{
    return evaluate_once(scene, p, false, status);
}

csg_sample csg_reference_look(const csgm_scene *scene, csg_vec3 p, csgm_status *status)
{
    return evaluate_once(scene, p, true, status);
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
    if (!begin_room(&w, scene, stack)) {
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
    csg_reference_room_end(&w, scene);
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
    if (!begin_room(&w, scene, stack)) {
        *status = CSGM_ERR_MEMORY;
        return CSG_NODE_NONE;
    }
    place_points(&w, scene, 0, scene->root, p);
    evaluate(&w, scene, 0, scene->root);
    csg_node_id id = scene->root;
    while (scene->nodes[id].child_count)
        id = csg_scene_children(scene,
                                &scene->nodes[id])[deciding_child(&w, scene, &scene->nodes[id])];
    csg_reference_room_end(&w, scene);
    return id;
}
