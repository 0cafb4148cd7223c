/* SPDX-License-Identifier: MIT
 * Numbers as blends, put into the tree; see numbers.h.
 */
#include "scene/tree/numbers.h"

#include <math.h>

#include "scene/operators/apart.h"
#include "scene/operators/union_ends.h"
#include "scene/primitives/kinds.h"
#include "scene/tree/build_private.h"

typedef struct search {
    csg_scene_builder *builder;
    const csgm_scene *scene;
    const csg_node_id *origins;
    /* of the operator at hand, room for all its operands: another one of each one's group, or
     * itself; the next and the last one of its group */
    uint32_t *groups, *nexts, *lasts;
    csg_node_id *members, *made;
} search;

static bool is_ungrouped(const csg_node *node)
{
    return node->flags & CSG_FLAG_UNGROUPED;
}

bool csg_numbers_are_pending(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++)
        if (is_ungrouped(&scene->nodes[i]))
            return true;
    return false;
}

void csg_numbers_count(const csgm_scene *scene, uint32_t *primitives, uint32_t *operators)
{
    *primitives = *operators = 0;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        bool is_ended = node->flags & CSG_FLAG_ENDED;
        *primitives += csg_node_is_primitive((csg_node_kind)node->kind);
        *primitives -= is_ended ? node->child_count - 1 : 0;
        *operators += csg_node_is_operator((csg_node_kind)node->kind) && !is_ended;
    }
}

/* ---- groups ------------------------------------------------------------------------------------ */

/* The first operand of the group. */
static uint32_t first_of(const search *s, uint32_t k)
{
    while (s->groups[k] != k) {
        s->groups[k] = s->groups[s->groups[k]];
        k = s->groups[k];
    }
    return k;
}

static void find_groups(const search *s, const csg_apart *found, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++)
        s->groups[k] = s->lasts[k] = s->nexts[k] = k;
    for (size_t i = found->apart; i < found->count; i++) {
        uint32_t a = first_of(s, found->pairs[i].a), b = first_of(s, found->pairs[i].b);
        s->groups[a > b ? a : b] = a > b ? b : a;
    }
    for (uint32_t k = 0; k < count; k++) {
        uint32_t first = first_of(s, k);
        s->nexts[s->lasts[first]] = k;
        s->nexts[k] = s->lasts[first] = k;
    }
}

/* A group blended; that of a difference's first operand is a difference. */
static csg_node_id blend_group(const search *s, const csg_node *node, uint32_t first)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    bool cuts = node->kind == CSG_NODE_DIFFERENCE && first == 0;
    size_t count = 1;
    s->members[0] = s->origins[children[first]];
    for (uint32_t k = first; s->nexts[k] != k;) {
        k = s->nexts[k];
        s->members[count++] = s->origins[children[k]];
    }
    if (count == 1)
        return s->members[0];
    csg_node_id made = csg_build_append_operator(
        s->builder, cuts ? CSG_NODE_DIFFERENCE : CSG_NODE_UNION,
        csg_blend_round(csg_scene_blend(s->scene, node).n), 0, s->members, count, node->where);
    if (made != CSG_NODE_NONE)
        s->builder->scene->nodes[made].flags |= CSG_FLAG_NUMBER | (cuts ? 0 : CSG_FLAG_UNENDED);
    return made;
}

/* An operator that blends nothing, which is to be told of. */
static void mark_idle(const search *s, double radius, csg_node_id made)
{
    csgm_scene *built = s->builder->scene;
    csg_node *node = &built->nodes[made];
    node->flags |= CSG_FLAG_NUMBER;
    built->parameters[node->payload] = radius;
}

/* The builder's node becomes what joins the groups. */
static bool take_groups(void *user, const csg_apart *found)
{
    const search *s = user;
    const csg_node *node = &s->scene->nodes[found->id];
    csgm_scene *built = s->builder->scene;
    size_t count = 0;
    find_groups(s, found, node->child_count);
    for (uint32_t k = 0; k < node->child_count; k++) {
        if (s->groups[k] != k)
            continue;
        s->made[count] = blend_group(s, node, k);
        if (s->made[count++] == CSG_NODE_NONE)
            return false;
    }
    csg_node_id made = s->made[0];
    if (count > 1)
        made = csg_build_append_operator(s->builder, (csg_node_kind)node->kind, CSG_SHARP, 0,
                                         s->made, count, node->where);
    if (made == CSG_NODE_NONE)
        return false;
    if (count == node->child_count)
        mark_idle(s, csg_scene_blend(s->scene, node).n, made);
    built->nodes[s->origins[found->id]] = built->nodes[made];
    return true;
}

/* ---- ends -------------------------------------------------------------------------------------- */

static bool is_unended(const csg_node *node)
{
    return node->flags & CSG_FLAG_UNENDED;
}

/* As good as an infinite cylinder: one that is longer than all operands. */
static csg_node_id build_cylinder(const search *s, const csg_node *node, const csg_fillet_end *end,
                                  double radius)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    csg_box hull = csg_box_empty();
    for (uint32_t k = 0; k < node->child_count; k++)
        hull = csg_box_hull(hull, s->scene->bounds[children[k]]);
    double half = csg_vec3_norm(csg_box_size(hull)) +
                  csg_vec3_norm(csg_vec3_sub(csg_box_center(hull), end->foot)) + radius;
    csg_affine place = csg_affine_z_to(end->normal);
    place.t[0] = end->foot.x;
    place.t[1] = end->foot.y;
    place.t[2] = end->foot.z;
    csg_node_id made = csg_build_primitive(s->builder, CSG_NODE_FRUSTUM,
                                           (double[]){radius, radius, half, 0}, node->where);
    return made == CSG_NODE_NONE ? made
                                 : csg_build_transform(s->builder, &place, made, node->where);
}

static csg_node_id build_end(const search *s, const csg_node *node, const csg_fillet_end *end,
                             double reach)
{
    if (!end->is_round)
        return csg_build_half_space(s->builder, end->normal, reach, node->where);
    if (!(node->flags & CSG_FLAG_FLAT))
        return build_cylinder(s, node, end, reach);
    csg_affine place = csg_affine_translate(end->foot);
    csg_node_id made = csg_build_primitive(s->builder, CSG_NODE_CIRCLE, &reach, node->where);
    return made == CSG_NODE_NONE ? made
                                 : csg_build_transform(s->builder, &place, made, node->where);
}

/* The builder's node becomes the union within its ends. A fillet ends there by itself: only who
 * stands above it asks for them. */
static bool take_ends(void *user, csg_node_id id, const csg_union_ends *ends)
{
    const search *s = user;
    const csg_node *node = &s->scene->nodes[id];
    if (!is_unended(node))
        return true;
    csgm_scene *built = s->builder->scene;
    csg_memory *memory = &s->builder->context->memory;
    csg_node_id origin = s->origins[id];
    size_t count = 1, most = ends->count + 1;
    csg_node_id *operands = csg_memory_alloc(memory, most * sizeof *operands);
    bool done = operands && csg_build_reserve_node(s->builder);
    built->nodes[origin].flags &= (uint8_t)~CSG_FLAG_UNENDED;
    if (done) { /* the union moves, as what is above it knows it by its number */
        operands[0] = (csg_node_id)built->node_count;
        built->nodes[built->node_count++] = built->nodes[origin];
    }
    for (size_t i = 0; i < ends->count && done; i++) {
        if (!isfinite(ends->flush[i]))
            continue;
        operands[count] = build_end(s, node, &ends->ends[i], ends->flush[i]);
        done = operands[count++] != CSG_NODE_NONE;
    }
    if (done && count > 1) {
        csg_node_id made = csg_build_append_operator(s->builder, CSG_NODE_INTERSECTION, CSG_SHARP,
                                                     0, operands, count, node->where);
        done = made != CSG_NODE_NONE;
        if (done) {
            built->nodes[made].flags = CSG_FLAG_ENDED | (node->flags & CSG_FLAG_FLAT);
            built->nodes[origin] = built->nodes[made];
        }
    }
    csg_memory_release(memory, operands, most * sizeof *operands);
    return done;
}

/* ---- both -------------------------------------------------------------------------------------- */

csgm_status csg_numbers_group(csg_scene_builder *builder, const csgm_scene *scene,
                              const csg_node_id *origins)
{
    csg_memory *memory = &builder->context->memory;
    search s = {.builder = builder, .scene = scene, .origins = origins};
    size_t most = 0;
    for (size_t i = 0; i < scene->node_count; i++)
        most = scene->nodes[i].child_count > most ? scene->nodes[i].child_count : most;
    s.groups = csg_memory_alloc(memory, most * sizeof *s.groups);
    s.nexts = csg_memory_alloc(memory, most * sizeof *s.nexts);
    s.lasts = csg_memory_alloc(memory, most * sizeof *s.lasts);
    s.members = csg_memory_alloc(memory, most * sizeof *s.members);
    s.made = csg_memory_alloc(memory, most * sizeof *s.made);
    csgm_status status = CSGM_ERR_MEMORY;
    if (s.groups && s.nexts && s.lasts && s.members && s.made)
        status = csg_apart_find(scene, is_ungrouped, take_groups, &s);
    csg_memory_release(memory, s.groups, most * sizeof *s.groups);
    csg_memory_release(memory, s.nexts, most * sizeof *s.nexts);
    csg_memory_release(memory, s.lasts, most * sizeof *s.lasts);
    csg_memory_release(memory, s.members, most * sizeof *s.members);
    csg_memory_release(memory, s.made, most * sizeof *s.made);
    return builder->status != CSGM_OK ? builder->status : status;
}

csgm_status csg_numbers_end(csg_scene_builder *builder, const csgm_scene *scene,
                            const csg_node_id *origins)
{
    search s = {.builder = builder, .scene = scene, .origins = origins};
    csgm_status status = csg_union_ends_find(scene, csg_node_ends_flush, take_ends, &s);
    return builder->status != CSGM_OK ? builder->status : status;
}

csgm_status csg_numbers_remember(const csg_scene_builder *builder, const csgm_scene *scene,
                                 const csg_node_id *origins, csg_arena *scratch,
                                 csg_numbers_before *before)
{
    const csgm_scene *built = builder->scene;
    size_t count = 0;
    for (size_t i = 0; i < scene->node_count; i++)
        count += is_ungrouped(&scene->nodes[i]);
    *before = (csg_numbers_before){.node_count = built->node_count,
                                   .child_count = built->child_count,
                                   .parameter_count = built->parameter_count,
                                   .transform_count = built->transform_count};
    before->ids = csg_arena_calloc(scratch, count, sizeof *before->ids);
    before->nodes = csg_arena_calloc(scratch, count, sizeof *before->nodes);
    if (!before->ids || !before->nodes)
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < scene->node_count; i++)
        if (is_ungrouped(&scene->nodes[i])) {
            before->ids[before->count] = origins[i];
            before->nodes[before->count++] = built->nodes[origins[i]];
        }
    return CSGM_OK;
}

void csg_numbers_undo(csg_scene_builder *builder, const csg_numbers_before *before)
{
    csgm_scene *built = builder->scene;
    for (size_t i = 0; i < before->count; i++)
        built->nodes[before->ids[i]] = before->nodes[i];
    built->node_count = before->node_count;
    built->child_count = before->child_count;
    built->parameter_count = before->parameter_count;
    built->transform_count = before->transform_count;
}
