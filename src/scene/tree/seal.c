/* SPDX-License-Identifier: MIT
 * Sealing a scene: walks the builder's nodes from the root with an explicit stack, inlines nested
 * sharp unions and intersections, and copies what is left into one arena, children before parents,
 * left before right. The inverse and the smallest singular value of each transform and the bounds
 * of each node are computed once, here.
 */
#include "scene/boxes/bounds.h"
#include "scene/operators/apart.h"
#include "scene/operators/rule.h"
#include "scene/operators/union_ends.h"
#include "scene/tree/build.h"
#include "scene/tree/numbers.h"
#include "scene/tree/softness.h"

#include <string.h>

/* A reachable node: which one of the builder's, and its parent's place in the same list. */
typedef struct visit {
    csg_node_id node;
    uint32_t parent;
} visit;

/* Reachable nodes, parents before children, right before left. */
typedef struct walk {
    visit *stack, *order;
    uint8_t *seen;      /* per node of the builder, from `lowest` on */
    csg_node_id lowest; /* the smallest of the reachable nodes */
    uint32_t stacked, count;
} walk;

/* The smallest and the largest index of a node below root: parts of large scenes are sealed by
 * themselves, and what was built before them should not cost. Root need not be the largest: a
 * transform goes below the colour that it is put on. */
static csgm_status find_range(csg_memory *memory, const csgm_scene *scene, csg_node_id root,
                              csg_node_id *lowest, csg_node_id *highest)
{
    void *data = NULL;
    size_t capacity = 0, stacked = 0, visited = 0;
    csgm_status status = CSGM_OK;
    csg_node_id at = root;
    *lowest = *highest = root;
    for (;;) {
        const csg_node *node = &scene->nodes[at];
        *lowest = at < *lowest ? at : *lowest;
        *highest = at > *highest ? at : *highest;
        if (++visited > scene->node_count) /* a node was used twice */
            status = CSGM_ERR_INTERNAL;
        else if (!csg_memory_reserve(memory, &data, &capacity, stacked + node->child_count,
                                     sizeof(csg_node_id)))
            status = CSGM_ERR_MEMORY;
        if (status != CSGM_OK)
            break;
        csg_node_id *stack = data;
        for (uint32_t i = 0; i < node->child_count; i++)
            stack[stacked++] = csg_scene_children(scene, node)[i];
        if (!stacked)
            break;
        at = stack[--stacked];
    }
    csg_memory_release(memory, data, capacity * sizeof(csg_node_id));
    return status;
}

static csgm_status walk_begin(walk *w, csg_arena *scratch, const csgm_scene *scene,
                              csg_node_id root)
{
    *w = (walk){0};
    csg_node_id highest = root;
    csgm_status status = find_range(scratch->memory, scene, root, &w->lowest, &highest);
    size_t most = highest - w->lowest + 1;
    if (status != CSGM_OK)
        return status;
    w->stack = csg_arena_calloc(scratch, most, sizeof *w->stack);
    w->order = csg_arena_calloc(scratch, most, sizeof *w->order);
    w->seen = csg_arena_calloc(scratch, most, sizeof *w->seen);
    return w->stack && w->order && w->seen ? CSGM_OK : CSGM_ERR_MEMORY;
}

static bool push_node(walk *w, csg_node_id node, uint32_t parent)
{
    if (w->seen[node - w->lowest])
        return false;
    w->seen[node - w->lowest] = 1;
    w->stack[w->stacked++] = (visit){node, parent};
    return true;
}

static bool is_flattened(const csgm_scene *scene, csg_node_id inner, csg_node_id outer)
{
    const csg_node *a = &scene->nodes[inner], *b = &scene->nodes[outer];
    return !((a->flags | b->flags) & (CSG_FLAG_NUMBER | CSG_FLAG_ENDED)) && a->kind == b->kind &&
           (a->kind == CSG_NODE_UNION || a->kind == CSG_NODE_INTERSECTION) &&
           csg_blend_is_sharp(a->blend) && csg_blend_is_sharp(b->blend);
}

/* False when a node is reached twice. */
static bool walk_from(walk *w, const csgm_scene *scene, csg_node_id root)
{
    push_node(w, root, UINT32_MAX);
    while (w->stacked) {
        visit v = w->stack[--w->stacked];
        const csg_node *node = &scene->nodes[v.node];
        if (v.parent == UINT32_MAX || !is_flattened(scene, v.node, w->order[v.parent].node)) {
            w->order[w->count] = v;
            v.parent = w->count++;
        }
        for (uint32_t i = 0; i < node->child_count; i++)
            if (!push_node(w, csg_scene_children(scene, node)[i], v.parent))
                return false;
    }
    return true;
}

/* ---- copying -------------------------------------------------------------------------- */

static bool has_formula(const csg_node *node)
{
    return node->kind == CSG_NODE_FIELD || node->kind == CSG_NODE_COMBINE;
}

/* A profile stands behind the formula that is made of it. */
static uint32_t formula_count(const csg_node *node)
{
    return node->kind == CSG_NODE_COMBINE && csg_blend_is_profile(node->blend) ? 2 : 1;
}

static bool reserve_sealed(csgm_scene *out, const csgm_scene *from, const walk *w)
{
    for (uint32_t i = 0; i < w->count; i++) {
        const csg_node *node = &from->nodes[w->order[i].node];
        out->parameter_count += csg_node_parameter_count(node);
        out->shape_count += node->kind == CSG_NODE_SHAPE;
        out->warp_count += node->kind == CSG_NODE_WARP;
        out->transform_count += node->kind == CSG_NODE_TRANSFORM;
        out->look_count += node->kind == CSG_NODE_COLOR;
        if (has_formula(node)) {
            out->formula_count += formula_count(node);
            for (uint32_t k = 0; k < formula_count(node); k++)
                out->step_count += from->formulas[node->payload + k].count;
        }
    }
    out->node_count = w->count;
    out->child_count = w->count - 1; /* a tree */
    csg_arena *arena = &out->arena;
    out->nodes = csg_arena_calloc(arena, out->node_count, sizeof *out->nodes);
    out->bounds = csg_arena_calloc(arena, out->node_count, sizeof *out->bounds);
    out->children = csg_arena_calloc(arena, out->child_count, sizeof *out->children);
    out->parameters = csg_arena_calloc(arena, out->parameter_count, sizeof *out->parameters);
    out->transforms = csg_arena_calloc(arena, out->transform_count, sizeof *out->transforms);
    out->inverses = csg_arena_calloc(arena, out->transform_count, sizeof *out->inverses);
    out->scales = csg_arena_calloc(arena, out->transform_count, sizeof *out->scales);
    out->looks = csg_arena_calloc(arena, out->look_count, sizeof *out->looks);
    out->formulas = csg_arena_calloc(arena, out->formula_count, sizeof *out->formulas);
    out->steps = csg_arena_calloc(arena, out->step_count, sizeof *out->steps);
    out->shapes = csg_arena_calloc(arena, out->shape_count, sizeof *out->shapes);
    out->warps = csg_arena_calloc(arena, out->warp_count, sizeof *out->warps);
    return out->shapes && out->warps && out->formulas && out->steps && out->nodes && out->bounds &&
           out->children && out->parameters && out->transforms && out->inverses && out->scales &&
           out->looks;
}

static void copy_transform(csgm_scene *out, csg_affine matrix)
{
    size_t i = out->transform_count++;
    double largest;
    out->transforms[i] = matrix;
    csg_affine_invert(matrix, &out->inverses[i]); /* the builder checked that it can be */
    csg_affine_singular_values(&matrix, &out->scales[i], &largest);
}

static void copy_formula(csgm_scene *out, const csgm_scene *from, csg_formula formula)
{
    memcpy(out->steps + out->step_count, from->steps + formula.first,
           formula.count * sizeof *out->steps);
    formula.first = (uint32_t)out->step_count;
    out->step_count += formula.count;
    out->formulas[out->formula_count++] = formula;
}

static void copy_payload(csgm_scene *out, const csgm_scene *from, csg_node *node)
{
    uint32_t old = node->payload;
    if (node->kind == CSG_NODE_TRANSFORM) {
        node->payload = (uint32_t)out->transform_count;
        copy_transform(out, from->transforms[old]);
    } else if (node->kind == CSG_NODE_COLOR) {
        node->payload = (uint32_t)out->look_count;
        out->looks[out->look_count++] = from->looks[old];
    } else if (has_formula(node)) {
        node->payload = (uint32_t)out->formula_count;
        for (uint32_t k = 0; k < formula_count(node); k++)
            copy_formula(out, from, from->formulas[old + k]);
    } else if (node->kind == CSG_NODE_SHAPE) {
        node->payload = (uint32_t)out->shape_count;
        csg_shape_retain(from->shapes[old]);
        out->shapes[out->shape_count++] = from->shapes[old];
    } else if (node->kind == CSG_NODE_WARP) {
        node->payload = (uint32_t)out->warp_count;
        out->warps[out->warp_count++] = from->warps[old];
    } else {
        uint32_t count = csg_node_parameter_count(node);
        node->payload = (uint32_t)out->parameter_count;
        for (uint32_t i = 0; i < count; i++)
            out->parameters[out->parameter_count++] = from->parameters[old + i];
    }
}

/* The list backwards is the sealed order: children first, left before right. */
static void copy_nodes(csgm_scene *out, const csgm_scene *from, const walk *w)
{
    out->parameter_count = out->transform_count = out->look_count = 0;
    out->formula_count = out->step_count = out->shape_count = out->warp_count = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        uint32_t place = w->count - 1 - i;
        csg_node node = from->nodes[w->order[place].node];
        copy_payload(out, from, &node);
        node.child_count = 0;
        out->nodes[i] = node;
    }
    for (uint32_t place = 1; place < w->count; place++)
        out->nodes[w->count - 1 - w->order[place].parent].child_count++;
    uint32_t first = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        out->nodes[i].first_child = first;
        first += out->nodes[i].child_count;
        out->nodes[i].child_count = 0;
    }
    for (uint32_t i = 0; i + 1 < w->count; i++) {
        csg_node *parent = &out->nodes[w->count - 1 - w->order[w->count - 1 - i].parent];
        out->children[parent->first_child + parent->child_count++] = i;
    }
    out->root = w->count - 1;
}

static const csg_node_id *find_origins(const walk *w, csg_arena *scratch)
{
    csg_node_id *origins = csg_arena_calloc(scratch, w->count, sizeof *origins);
    for (uint32_t i = 0; i < w->count && origins; i++)
        origins[i] = w->order[w->count - 1 - i].node;
    return origins;
}

static bool copy_dependencies(csgm_scene *out, const char *const *names, size_t count)
{
    out->dependencies = csg_arena_calloc(&out->arena, count, sizeof *out->dependencies);
    if (!out->dependencies)
        return false;
    for (size_t i = 0; i < count; i++) {
        out->dependencies[i] = csg_arena_strndup(&out->arena, names[i], strlen(names[i]));
        if (!out->dependencies[i])
            return false;
    }
    out->dependency_count = count;
    return true;
}

static bool copy_part_names(csgm_scene *out, const csgm_scene *from)
{
    if (!from->part_count)
        return true;
    out->part_names = csg_arena_calloc(&out->arena, from->part_count, sizeof *out->part_names);
    for (uint32_t i = 0; out->part_names && i < from->part_count; i++) {
        const char *name = from->part_names[i];
        out->part_names[i] = csg_arena_strndup(&out->arena, name, strlen(name));
        if (!out->part_names[i])
            return false;
    }
    out->part_count = from->part_count;
    return out->part_names;
}

static bool has_soft_nodes(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++)
        if (scene->nodes[i].flags & CSG_FLAG_SOFT)
            return true;
    return false;
}

/* The place of one like it among the latest of those used; `count` where there is none. */
static uint32_t equal_rule(const csg_rule *rules, const uint32_t *used, size_t count, size_t wanted)
{
    const size_t searched = 64;
    for (size_t i = count; i-- > (count > searched ? count - searched : 0);)
        if (csg_rule_is_same(&rules[used[i]], &rules[wanted]))
            return (uint32_t)i;
    return (uint32_t)count;
}

/* Those that are used, in the order of their first use, and FIELD_SHARP behind them. */
static bool copy_rules(csgm_scene *out, const csgm_scene *from, csg_arena *scratch)
{
    if (!from->rule_count)
        return true;
    uint32_t *places = csg_arena_calloc(scratch, from->rule_count, sizeof *places);
    uint32_t *used = csg_arena_calloc(scratch, from->rule_count, sizeof *used);
    if (!places || !used)
        return false;
    for (size_t i = 0; i < out->node_count; i++) {
        const csg_node *node = &out->nodes[i];
        if (!csg_node_is_operator(node->kind) || !csg_blend_is_rule(node->blend))
            continue;
        double *index = &out->parameters[node->payload];
        uint32_t *place = &places[(size_t)*index];
        if (!*place)
            *place = equal_rule(from->rules, used, out->rule_count, (size_t)*index) + 1;
        if (*place > out->rule_count)
            used[out->rule_count++] = (uint32_t)*index;
        *index = *place - 1;
    }
    if (!out->rule_count)
        return true;
    out->rules = csg_arena_calloc(&out->arena, ++out->rule_count, sizeof *out->rules);
    for (size_t i = 0; out->rules && i + 1 < out->rule_count; i++) {
        out->rules[i] = from->rules[used[i]];
        out->rules[i].range = 0; /* among the parameters of each node */
    }
    if (out->rules)
        out->rules[out->rule_count - 1] = csg_rule_of_fields();
    return out->rules;
}

/* origins: NULL, or where an array of the scratch goes: the builder's node of each sealed one. */
static csgm_status seal(csg_scene_builder *builder, csg_node_id root, csg_arena *scratch,
                        const csg_node_id **origins, csgm_scene *out)
{
    walk w;
    csgm_status status = walk_begin(&w, scratch, builder->scene, root);
    if (status != CSGM_OK)
        return status;
    if (!walk_from(&w, builder->scene, root))
        return CSGM_ERR_INTERNAL;
    if (!reserve_sealed(out, builder->scene, &w)) {
        out->shape_count = 0; /* none was taken over */
        return CSGM_ERR_MEMORY;
    }
    copy_nodes(out, builder->scene, &w);
    if (origins && !(*origins = find_origins(&w, scratch)))
        return CSGM_ERR_MEMORY;
    bool done = copy_part_names(out, builder->scene) && copy_rules(out, builder->scene, scratch);
    if (done && (out->rule_count || has_soft_nodes(out)))
        done = csg_softness_settle(out, scratch);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* A sealed copy of what stands below root, without bounds; origins as for seal. */
static csgm_status copy_sealed(csg_scene_builder *builder, csg_node_id root, csg_arena *scratch,
                               const csg_node_id **origins, csgm_scene **out)
{
    csg_memory *memory = &builder->context->memory;
    csgm_scene *scene = csg_memory_alloc(memory, sizeof *scene);
    if (!scene)
        return CSGM_ERR_MEMORY;
    *scene = (csgm_scene){.context = builder->context};
    csg_arena_init(&scene->arena, memory);
    csgm_status status = seal(builder, root, scratch, origins, scene);
    if (status == CSGM_OK)
        *out = scene;
    else
        csg_scene_destroy(scene);
    return status;
}

/* What numbers mean as blends is put into the builder's tree by what sealed copies of it tell. */
static csgm_status settle_numbers(csg_scene_builder *builder, csg_node_id root, csg_arena *scratch,
                                  csg_numbers_before *before)
{
    csgm_status status = CSGM_OK;
    for (int step = 0; step < 2 && status == CSGM_OK; step++) {
        csgm_scene *scene;
        const csg_node_id *origins;
        status = copy_sealed(builder, root, scratch, &origins, &scene);
        if (status != CSGM_OK)
            return status;
        if (step == 0 && !csg_numbers_are_pending(scene)) {
            csg_scene_destroy(scene);
            return CSGM_OK;
        }
        status = csg_bounds_fill(scene);
        if (status == CSGM_OK && step == 0)
            status = csg_numbers_remember(builder, scene, origins, scratch, before);
        if (status == CSGM_OK)
            status = (step == 0 ? csg_numbers_group : csg_numbers_end)(builder, scene, origins);
        csg_scene_destroy(scene);
    }
    return status;
}

static csgm_status seal_copy(csg_scene_builder *builder, csg_node_id root, csgm_scene **out)
{
    csg_arena scratch;
    csg_arena_init(&scratch, &builder->context->memory);
    csgm_status status = CSGM_OK;
    csg_numbers_before before = {.node_count = 0};
    if (builder->has_numbers)
        status = settle_numbers(builder, root, &scratch, &before);
    if (status == CSGM_OK)
        status = copy_sealed(builder, root, &scratch, NULL, out);
    if (before.node_count)
        csg_numbers_undo(builder, &before);
    csg_arena_reset(&scratch);
    return status;
}

static csgm_status measure(csgm_scene *scene)
{
    csgm_status status = csg_bounds_fill(scene);
    status = status == CSGM_OK ? csg_fillet_planes_find(scene) : status;
    return status == CSGM_OK ? csg_fillet_apart_find(scene) : status;
}

csgm_status csg_build_snapshot(csg_scene_builder *builder, csg_node_id node, csgm_scene **out)
{
    if (builder->status != CSGM_OK)
        return builder->status;
    if (node >= builder->scene->node_count)
        return CSGM_ERR_ARGUMENT;
    csgm_scene *scene;
    csgm_status status = seal_copy(builder, node, &scene);
    if (status != CSGM_OK)
        return status;
    status = measure(scene);
    if (status == CSGM_OK)
        *out = scene;
    else
        csg_scene_destroy(scene);
    return status;
}

csgm_status csg_build_finish(csg_scene_builder *builder, csg_node_id root,
                             const char *const *dependencies, size_t dependency_count,
                             csgm_scene **out)
{
    if (builder->status != CSGM_OK)
        return builder->status;
    if (root == CSG_NODE_NONE)
        root = csg_build_empty(builder, (csg_span){.source = UINT32_MAX});
    if (builder->status != CSGM_OK)
        return builder->status;
    if (root >= builder->scene->node_count)
        return builder->status = CSGM_ERR_ARGUMENT;
    csgm_scene *scene;
    csgm_status status = seal_copy(builder, root, &scene);
    if (status != CSGM_OK)
        return builder->status = status;
    csg_build_abandon(builder); /* bounds need room too */
    status = measure(scene);
    if (status == CSGM_OK && !copy_dependencies(scene, dependencies, dependency_count))
        status = CSGM_ERR_MEMORY;
    if (status != CSGM_OK) {
        csg_scene_destroy(scene);
        return builder->status = status;
    }
    *out = scene;
    return CSGM_OK;
}
