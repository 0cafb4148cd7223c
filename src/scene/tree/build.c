/* SPDX-License-Identifier: MIT
 * Appends checked nodes to a growing scene. Everything that needs only a look at the children is
 * simplified here (transforms fold, colours override, empty and single operands vanish, binary
 * blends become chains); nested n-ary operators are flattened when the scene is sealed (seal.c).
 */
#include "scene/tree/build.h"
#include "scene/formula/formula.h"
#include "scene/operators/rule.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"
#include "scene/tree/figures.h"

#include <float.h>
#include <string.h>

csg_node_id csg_build_no_memory(csg_scene_builder *builder)
{
    csg_check_fail(builder, CSGM_ERR_MEMORY, "%s", "");
    return CSG_NODE_NONE;
}

/* ---- appending ---------------------------------------------------------------------- */

csgm_status csg_build_begin(csg_scene_builder *builder, csgm_context *context)
{
    *builder = (csg_scene_builder){.context = context};
    builder->scene = csg_memory_alloc(&context->memory, sizeof *builder->scene);
    if (!builder->scene) {
        csg_build_no_memory(builder);
        return builder->status;
    }
    *builder->scene = (csgm_scene){.context = context, .root = CSG_NODE_NONE};
    return CSGM_OK;
}

void csg_build_abandon(csg_scene_builder *builder)
{
    csgm_scene *scene = builder->scene;
    if (!scene)
        return;
    csg_memory *memory = &builder->context->memory;
    csg_memory_release(memory, scene->nodes, builder->node_capacity * sizeof *scene->nodes);
    csg_memory_release(memory, scene->children, builder->child_capacity * sizeof *scene->children);
    csg_memory_release(memory, scene->parameters,
                       builder->parameter_capacity * sizeof *scene->parameters);
    csg_memory_release(memory, scene->transforms,
                       builder->transform_capacity * sizeof *scene->transforms);
    csg_memory_release(memory, scene->looks, builder->look_capacity * sizeof *scene->looks);
    csg_memory_release(memory, scene->formulas,
                       builder->formula_capacity * sizeof *scene->formulas);
    csg_memory_release(memory, scene->steps, builder->step_capacity * sizeof *scene->steps);
    csg_memory_release(memory, scene->warps, builder->warp_capacity * sizeof *scene->warps);
    csg_memory_release(memory, scene->rules, builder->rule_capacity * sizeof *scene->rules);
    for (size_t i = 0; i < scene->shape_count; i++)
        csg_shape_release(scene->shapes[i]);
    csg_memory_release(memory, scene->shapes, builder->shape_capacity * sizeof *scene->shapes);
    for (uint32_t i = 0; i < scene->part_count; i++)
        csg_memory_release(memory, (char *)scene->part_names[i], strlen(scene->part_names[i]) + 1);
    csg_memory_release(memory, scene->part_names,
                       builder->part_capacity * sizeof *scene->part_names);
    csg_memory_release(memory, scene, sizeof *scene);
    csg_figures_destroy(builder->figures);
    builder->scene = NULL;
    builder->figures = NULL;
    builder->shape_capacity = builder->warp_capacity = builder->rule_capacity = 0;
    builder->node_capacity = builder->child_capacity = builder->parameter_capacity = 0;
    builder->transform_capacity = builder->look_capacity = builder->part_capacity = 0;
    builder->formula_capacity = builder->step_capacity = 0;
}

bool csg_build_reserve_node(csg_scene_builder *builder)
{
    csgm_scene *scene = builder->scene;
    uint32_t limit = builder->context->limits.scene_nodes;
    if (!limit || limit >= CSG_NODE_NONE)
        limit = CSG_NODE_NONE - 1;
    if (scene->node_count >= limit) {
        csg_check_fail(builder, CSGM_ERR_LIMIT, "the scene has more than %u solids", limit);
        return false;
    }
    void *nodes = scene->nodes;
    if (!csg_memory_reserve(&builder->context->memory, &nodes, &builder->node_capacity,
                            scene->node_count + 1, sizeof *scene->nodes)) {
        csg_build_no_memory(builder);
        return false;
    }
    scene->nodes = nodes;
    return true;
}

bool csg_build_reserve_children(csg_scene_builder *builder, size_t more)
{
    csgm_scene *scene = builder->scene;
    if (more > UINT32_MAX - scene->child_count) {
        csg_check_fail(builder, CSGM_ERR_LIMIT, "the scene has too many solids");
        return false;
    }
    void *children = scene->children;
    if (!csg_memory_reserve(&builder->context->memory, &children, &builder->child_capacity,
                            scene->child_count + more, sizeof *scene->children)) {
        csg_build_no_memory(builder);
        return false;
    }
    scene->children = children;
    return true;
}

bool csg_build_reserve_parameters(csg_scene_builder *builder, size_t more)
{
    csgm_scene *scene = builder->scene;
    void *parameters = scene->parameters;
    if (!csg_memory_reserve(&builder->context->memory, &parameters, &builder->parameter_capacity,
                            scene->parameter_count + more, sizeof *scene->parameters)) {
        csg_build_no_memory(builder);
        return false;
    }
    scene->parameters = parameters;
    return true;
}

/* Soft operands stay soft below what keeps fields apart. */
static bool makes_soft(const csg_node *node, bool all_soft)
{
    if (csg_node_is_operator(node->kind))
        return csg_blend_is_sharp(node->blend) ? all_soft : csg_blend_takes_fields(node->blend);
    return node->kind == CSG_NODE_SOFT ||
           (all_soft && (node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR ||
                         node->kind == CSG_NODE_WARP));
}

/* Room was made by csg_build_reserve_node, _children and _parameters. */
csg_node_id csg_build_append(csg_scene_builder *builder, csg_node node, const csg_node_id *children,
                             size_t count)
{
    csgm_scene *scene = builder->scene;
    node.first_child = (uint32_t)scene->child_count;
    node.child_count = (uint32_t)count;
    bool flat = count > 0;
    bool soft = count > 0;
    bool some_end = false, plateau = false;
    for (size_t i = 0; i < count; i++) {
        flat &= (scene->nodes[children[i]].flags & CSG_FLAG_FLAT) != 0;
        soft &= (scene->nodes[children[i]].flags & CSG_FLAG_SOFT) != 0;
        bool has_plateau = (scene->nodes[children[i]].flags & CSG_FLAG_PLATEAU) != 0;
        plateau |= has_plateau;
        some_end |= !has_plateau;
    }
    for (size_t i = 0; i < count; i++)
        if (scene->nodes[children[i]].warps > node.warps)
            node.warps = scene->nodes[children[i]].warps;
    node.warps = (uint8_t)(node.warps + (node.kind == CSG_NODE_WARP));
    if (flat && node.kind != CSG_NODE_WARP)
        node.flags |= CSG_FLAG_FLAT;
    if (makes_soft(&node, soft))
        node.flags |= CSG_FLAG_SOFT;
    bool is_sharp = csg_blend_is_sharp(node.blend);
    bool is_ended = csg_node_is_operator(node.kind) && /* blends have ended their operands' */
                    (!is_sharp || (node.kind == CSG_NODE_INTERSECTION && some_end));
    if ((node.flags & CSG_FLAG_SOFT) || (plateau && !is_ended))
        node.flags |= CSG_FLAG_PLATEAU;
    for (size_t i = 0; i < count; i++)
        scene->children[scene->child_count++] = children[i];
    scene->nodes[scene->node_count] = node;
    return (csg_node_id)scene->node_count++;
}

bool csg_build_is_usable(csg_scene_builder *builder, csg_node_id child)
{
    if (builder->status != CSGM_OK)
        return false;
    if (child < builder->scene->node_count)
        return true;
    csg_check_fail(builder, CSGM_ERR_ARGUMENT,
                   "a solid that does not exist was used as an operand");
    return false;
}

csg_node_id csg_build_empty(csg_scene_builder *builder, csg_span where)
{
    if (builder->status != CSGM_OK || !csg_build_reserve_node(builder))
        return CSG_NODE_NONE;
    return csg_build_append(builder, (csg_node){.kind = CSG_NODE_EMPTY, .where = where}, NULL, 0);
}

/* ---- primitives ---------------------------------------------------------------------- */

csg_node_id csg_build_primitive(csg_scene_builder *builder, csg_primitive_kind kind,
                                const double *parameters, csg_span where)
{
    double values[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
    if (builder->status != CSGM_OK)
        return CSG_NODE_NONE;
    bool known = csg_node_is_named_primitive(kind);
    uint32_t count = known ? csg_primitive_parameter_count(kind) : 0;
    for (uint32_t i = 0; i < count; i++)
        values[i] = parameters[i];
    if (!csg_check_primitive(builder, kind, values) || !csg_build_reserve_node(builder) ||
        !csg_build_reserve_parameters(builder, count))
        return CSG_NODE_NONE;
    csgm_scene *scene = builder->scene;
    csg_node node = {
        .kind = (uint8_t)kind, .payload = (uint32_t)scene->parameter_count, .where = where};
    if (csg_primitive_has(kind, CSG_TRAIT_FLAT))
        node.flags = CSG_FLAG_FLAT;
    memcpy(scene->parameters + scene->parameter_count, values, count * sizeof *values);
    scene->parameter_count += count;
    return csg_build_append(builder, node, NULL, 0);
}

csg_node_id csg_build_ball(csg_scene_builder *builder, double r, csg_span where)
{
    return csg_build_primitive(builder, CSG_NODE_SPHERE, &r, where);
}

csg_node_id csg_build_block(csg_scene_builder *builder, csg_box box, csg_span where)
{
    csg_vec3 half = csg_vec3_scale(csg_box_size(box), 0.5);
    csg_affine place = csg_affine_translate(csg_box_center(box));
    csg_node_id block =
        csg_build_primitive(builder, CSG_NODE_BOX, (double[]){half.x, half.y, half.z, 0}, where);
    return block == CSG_NODE_NONE ? block : csg_build_transform(builder, &place, block, where);
}

csg_node_id csg_build_half_space(csg_scene_builder *builder, csg_vec3 normal, double distance,
                                 csg_span where)
{
    const double plane[4] = {normal.x, normal.y, normal.z, distance};
    return csg_build_primitive(builder, CSG_NODE_PLANE, plane, where);
}

csg_node_id csg_build_capsule(csg_scene_builder *builder, csg_vec3 p1, csg_vec3 p2, double r1,
                              double r2, csg_span where)
{
    if (builder->status != CSGM_OK || !csg_check_ends(builder, p1, p2, r1, r2))
        return CSG_NODE_NONE;
    csg_vec3 axis = csg_vec3_sub(p2, p1);
    double length = csg_vec3_norm(axis);
    csg_affine place = csg_affine_identity();
    csg_node_id solid;
    csg_vec3 origin = p1;
    if (length < CSG_SMALLEST_LENGTH || fabs(r1 - r2) >= length) {
        solid = csg_build_ball(builder, fmax(r1, r2), where);
        origin = r1 >= r2 ? p1 : p2;
    } else {
        solid = csg_build_primitive(builder, CSG_NODE_CAPSULE, (double[]){length, r1, r2}, where);
        if (axis.x != 0 || axis.y != 0 || axis.z < 0)
            place = csg_affine_z_to(axis);
    }
    if (solid == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    place.t[0] = origin.x;
    place.t[1] = origin.y;
    place.t[2] = origin.z;
    return csg_build_transform(builder, &place, solid, where);
}

/* ---- fields --------------------------------------------------------------------------- */

bool csg_build_append_formula(csg_scene_builder *builder, const csg_formula_step *steps,
                              const csg_formula *formula)
{
    csgm_scene *scene = builder->scene;
    csg_memory *memory = &builder->context->memory;
    void *formulas = scene->formulas, *all_steps = scene->steps;
    if (formula->count > UINT32_MAX - scene->step_count) {
        csg_check_fail(builder, CSGM_ERR_SCENE, "the scene's formulas are too long");
        return false;
    }
    bool done = csg_memory_reserve(memory, &formulas, &builder->formula_capacity,
                                   scene->formula_count + 1, sizeof *formula);
    scene->formulas = formulas;
    done = done && csg_memory_reserve(memory, &all_steps, &builder->step_capacity,
                                      scene->step_count + formula->count, sizeof *steps);
    scene->steps = all_steps;
    if (!done) {
        csg_build_no_memory(builder);
        return false;
    }
    scene->formulas[scene->formula_count] = *formula;
    scene->formulas[scene->formula_count++].first = (uint32_t)scene->step_count;
    memcpy(scene->steps + scene->step_count, steps, formula->count * sizeof *steps);
    scene->step_count += formula->count;
    return true;
}

csg_node_id csg_build_cut(csg_scene_builder *builder, csg_node_id node, csg_box box, csg_span where)
{
    if (!csg_build_is_usable(builder, node))
        return CSG_NODE_NONE;
    csg_node_id cutter = csg_build_block(builder, box, where);
    if (cutter == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    return csg_build_operator(builder, CSG_NODE_INTERSECTION, CSG_SHARP,
                              (csg_node_id[]){node, cutter}, 2, where);
}

/* Finds the constant, or tries the stated one. */
static bool settle_slope(csg_scene_builder *builder, const csg_formula_step *steps,
                         csg_formula *formula, double stated)
{
    csg_memory *memory = &builder->context->memory;
    csg_slope_trial trial = {.verdict = CSG_SLOPE_PROVEN};
    if (stated > 0)
        trial = csg_formula_try_lipschitz(memory, steps, formula->count, formula->bounds, stated);
    else
        trial.bound = csg_formula_lipschitz(memory, steps, formula->count, formula->bounds);
    return csg_check_slope(builder, stated, &trial, formula);
}

csg_node_id csg_build_field(csg_scene_builder *builder, const csg_formula_step *steps,
                            uint32_t count, const csg_field_domain *domain, csg_span where)
{
    csg_box bounds = domain->bounds;
    double stated = domain->lipschitz;
    if (builder->status != CSGM_OK || !csg_check_field(builder, steps, count, bounds, stated))
        return CSG_NODE_NONE;
    csg_formula formula = {.count = count, .bounds = bounds, .trusted = domain->trusted};
    if (!settle_slope(builder, steps, &formula, stated))
        return CSG_NODE_NONE;
    if (!csg_build_reserve_node(builder) || !csg_build_append_formula(builder, steps, &formula))
        return CSG_NODE_NONE;
    csg_node node = {.kind = CSG_NODE_FIELD,
                     .payload = (uint32_t)builder->scene->formula_count - 1,
                     .where = where};
    csg_node_id field = csg_build_append(builder, node, NULL, 0);
    bool cut = domain->cut && csg_box_is_finite(bounds);
    return cut ? csg_build_cut(builder, field, bounds, where) : field;
}

/* ---- transforms and colours ----------------------------------------------------------- */

/* To the last bits: a turn there and back is the identity too. */
static bool is_identity(const csg_affine *matrix)
{
    const csg_affine identity = csg_affine_identity();
    for (int i = 0; i < 3; i++) {
        if (matrix->t[i] != 0)
            return false;
        for (int j = 0; j < 3; j++)
            if (fabs(matrix->m[i][j] - identity.m[i][j]) > 4 * DBL_EPSILON)
                return false;
    }
    return true;
}

csg_node_id csg_build_append_transform(csg_scene_builder *builder, csg_affine matrix,
                                       csg_node_id child, csg_span where)
{
    csgm_scene *scene = builder->scene;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, 1))
        return CSG_NODE_NONE;
    void *transforms = scene->transforms;
    if (!csg_memory_reserve(&builder->context->memory, &transforms, &builder->transform_capacity,
                            scene->transform_count + 1, sizeof *scene->transforms))
        return csg_build_no_memory(builder);
    scene->transforms = transforms;
    scene->transforms[scene->transform_count] = matrix;
    csg_node node = {
        .kind = CSG_NODE_TRANSFORM, .payload = (uint32_t)scene->transform_count++, .where = where};
    return csg_build_append(builder, node, &child, 1);
}

/* What a map does to a figure of the plane: the plane part; z goes with the smallest stretch of it,
 * so that a similarity of the plane is one of space and the field stays a distance. */
static csg_affine within_plane(csg_affine map)
{
    double smallest, largest;
    map.m[0][2] = map.m[1][2] = map.m[2][0] = map.m[2][1] = map.t[2] = 0;
    map.m[2][2] = 0;
    csg_affine doubled = map; /* any stretch of z above the others */
    doubled.m[2][2] =
        2 * (fabs(map.m[0][0]) + fabs(map.m[0][1]) + fabs(map.m[1][0]) + fabs(map.m[1][1]));
    csg_affine_singular_values(&doubled, &smallest, &largest);
    map.m[2][2] = smallest;
    return map;
}

/* The child is neither a colour nor empty. */
static csg_node_id place(csg_scene_builder *builder, const csg_affine *matrix, csg_node_id child,
                         csg_span where)
{
    csgm_scene *scene = builder->scene;
    csg_node *node = &scene->nodes[child];
    bool flat = node->flags & CSG_FLAG_FLAT;
    csg_affine map = flat ? within_plane(*matrix) : *matrix;
    if (is_identity(&map))
        return child;
    if (node->kind != CSG_NODE_TRANSFORM)
        return csg_build_append_transform(builder, map, child, where);
    csg_affine both = csg_affine_multiply(map, scene->transforms[node->payload]);
    if (flat)
        both = within_plane(both);
    if (!csg_check_matrix(builder, &both))
        return CSG_NODE_NONE;
    if (is_identity(&both))
        return scene->children[node->first_child];
    scene->transforms[node->payload] = both;
    return child;
}

/* Colours move outside of transforms, so that transforms meet and fold. */
csg_node_id csg_build_transform(csg_scene_builder *builder, const csg_affine *matrix,
                                csg_node_id child, csg_span where)
{
    if (!csg_build_is_usable(builder, child))
        return CSG_NODE_NONE;
    csg_node node = builder->scene->nodes[child];
    csg_affine map = node.flags & CSG_FLAG_FLAT ? within_plane(*matrix) : *matrix;
    if (!csg_check_matrix(builder, &map))
        return CSG_NODE_NONE;
    if (node.kind == CSG_NODE_EMPTY)
        return child;
    if (node.kind != CSG_NODE_COLOR)
        return place(builder, matrix, child, where);
    csg_node_id *colored = &builder->scene->children[node.first_child];
    csg_node_id placed = place(builder, matrix, *colored, where);
    if (placed == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    builder->scene->children[node.first_child] = placed;
    return child;
}

csg_node_id csg_build_append_look(csg_scene_builder *builder, const csg_look *look,
                                  csg_node_id child, csg_span where)
{
    csgm_scene *scene = builder->scene;
    void *looks = scene->looks;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, 1))
        return CSG_NODE_NONE;
    if (!csg_memory_reserve(&builder->context->memory, &looks, &builder->look_capacity,
                            scene->look_count + 1, sizeof *scene->looks))
        return csg_build_no_memory(builder);
    scene->looks = looks;
    scene->looks[scene->look_count] = *look;
    csg_node fresh = {
        .kind = CSG_NODE_COLOR, .payload = (uint32_t)scene->look_count++, .where = where};
    return csg_build_append(builder, fresh, &child, 1);
}

csg_node_id csg_build_look(csg_scene_builder *builder, const csg_look *look, csg_node_id child,
                           csg_span where)
{
    if (!csg_build_is_usable(builder, child) || !csg_check_look(builder, look))
        return CSG_NODE_NONE;
    csgm_scene *scene = builder->scene;
    const csg_node *node = &scene->nodes[child];
    if (node->kind == CSG_NODE_EMPTY)
        return child;
    csg_look *inner = node->kind == CSG_NODE_COLOR ? &scene->looks[node->payload] : NULL;
    if (!inner || (inner->part && look->part)) /* a part in a part stays to be seen */
        return csg_build_append_look(builder, look, child, where);
    if (look->has_color)
        inner->color = look->color;
    if (look->has_material) {
        inner->metallic = look->metallic;
        inner->roughness = look->roughness;
    }
    inner->has_color |= look->has_color;
    inner->has_material |= look->has_material;
    inner->part = look->part ? look->part : inner->part;
    return child;
}

csg_node_id csg_build_color(csg_scene_builder *builder, csg_color color, csg_node_id child,
                            csg_span where)
{
    return csg_build_look(builder, &(csg_look){.color = color, .has_color = true}, child, where);
}

/* ---- operators ------------------------------------------------------------------------ */

csg_node_id csg_build_append_operator(csg_scene_builder *builder, csg_node_kind kind,
                                      csg_blend blend, double range, const csg_node_id *children,
                                      size_t count, csg_span where)
{
    csgm_scene *scene = builder->scene;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, count) ||
        !csg_build_reserve_parameters(builder, CSG_FILLET_PARAMETERS)) /* the most */
        return CSG_NODE_NONE;
    csg_node node = {.kind = (uint8_t)kind,
                     .blend = (uint8_t)blend.kind,
                     .payload = (uint32_t)scene->parameter_count,
                     .where = where};
    csg_node_id made = csg_build_append(builder, node, children, count);
    double *parameters = scene->parameters + scene->parameter_count;
    uint32_t own = csg_node_parameter_count(&scene->nodes[made]);
    parameters[CSG_OPERATOR_RULE] = blend.n;
    bool all_soft = true, some_soft = false;
    for (size_t i = 0; i < count; i++) {
        uint8_t flags = scene->nodes[children[i]].flags;
        all_soft &= (flags & CSG_FLAG_SOFT) != 0;
        some_soft |= (flags & (CSG_FLAG_SOFT | CSG_FLAG_PLATEAU)) != 0;
    }
    if (csg_blend_is_fillet(blend.kind)) { /* planes are found when the scene is sealed */
        parameters[CSG_FILLET_FIRST_NORMAL] = parameters[CSG_FILLET_FIRST_REACH] = 0;
        parameters[CSG_FILLET_PLANES] = parameters[CSG_FILLET_APART] = 0;
        parameters[CSG_FILLET_APART_BY] = 0;
    } else if (own > 1) {
        parameters[CSG_OPERATOR_RANGE] = all_soft ? 1 : range; /* nothing is converted */
        parameters[CSG_OPERATOR_LAMBDA] = 0;
    }
    scene->parameter_count += own;
    if (blend.is_number) {
        builder->has_numbers = true;
        scene->nodes[made].flags |=
            CSG_FLAG_NUMBER |
            (kind != CSG_NODE_INTERSECTION && !some_soft ? CSG_FLAG_UNGROUPED : 0);
    }
    return made;
}

/* The operand that alone decides that the result is empty, or CSG_NODE_NONE. */
static csg_node_id absorbing_operand(const csgm_scene *scene, csg_node_kind kind,
                                     const csg_node_id *children, size_t count)
{
    size_t deciding = kind == CSG_NODE_UNION ? 0 : kind == CSG_NODE_DIFFERENCE ? 1 : count;
    for (size_t i = 0; i < deciding && i < count; i++)
        if (scene->nodes[children[i]].kind == CSG_NODE_EMPTY)
            return children[i];
    return CSG_NODE_NONE;
}

/* A fillet of fillets of the same radius is one of all their operands, if it is of the same kind:
 * the union of what the others are subtracted from, too. */
static bool is_spread(const csgm_scene *scene, csg_node_kind kind, csg_blend blend, size_t index,
                      csg_node_id child)
{
    const csg_node *node = &scene->nodes[child];
    bool subtracted = kind == CSG_NODE_DIFFERENCE && index > 0;
    return csg_blend_is_fillet(blend.kind) && csg_node_is_operator(node->kind) &&
           csg_blend_is_fillet(node->blend) && csg_scene_blend(scene, node).n == blend.n &&
           node->kind == (subtracted ? CSG_NODE_UNION : kind);
}

/* Operands that are left once empty ones are gone and fillets are spread; returns their count, and
 * has room for them in `kept`, unless it is NULL. */
static size_t gather_operands(const csgm_scene *scene, csg_node_kind kind, csg_blend blend,
                              const csg_node_id *children, size_t count, csg_node_id *kept)
{
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        const csg_node *node = &scene->nodes[children[i]];
        if (is_spread(scene, kind, blend, i, children[i])) {
            const csg_node_id *inner = csg_scene_children(scene, node);
            for (uint32_t k = 0; k < node->child_count; k++, left++)
                if (kept)
                    kept[left] = inner[k];
        } else if (node->kind != CSG_NODE_EMPTY) {
            if (kept)
                kept[left] = children[i];
            left++;
        }
    }
    return left;
}

static csg_node_id join_operands(csg_scene_builder *builder, csg_node_kind kind, csg_blend blend,
                                 const csg_node_id *operands, size_t count, csg_span where)
{
    double range = 0;
    if (count == 1)
        return operands[0];
    if (csg_blend_is_rule(blend.kind) &&
        !csg_build_settle_rule(builder, kind, &blend, operands, count, &range))
        return CSG_NODE_NONE;
    if (!csg_blend_is_fold(blend.kind))
        return csg_build_append_operator(builder, kind, blend, range, operands, count, where);
    csg_node_id joined = operands[0];
    for (size_t i = 1; i < count && joined != CSG_NODE_NONE && csg_blend_is_profile(blend.kind);
         i++)
        joined = csg_build_profiled(builder, kind, blend, joined, operands[i], where);
    if (csg_blend_is_profile(blend.kind))
        return joined;
    for (size_t i = 1; i < count && joined != CSG_NODE_NONE; i++)
        joined = csg_build_append_operator(builder, kind, blend, range,
                                           (csg_node_id[]){joined, operands[i]}, 2, where);
    return joined;
}

csg_node_id csg_build_operator(csg_scene_builder *builder, csg_node_kind kind, csg_blend blend,
                               const csg_node_id *children, size_t count, csg_span where)
{
    if (builder->status != CSGM_OK || !csg_check_operator(builder, kind, &blend))
        return CSG_NODE_NONE;
    for (size_t i = 0; i < count; i++)
        if (!csg_build_is_usable(builder, children[i]))
            return CSG_NODE_NONE;
    csg_node_id empty = absorbing_operand(builder->scene, kind, children, count);
    if (empty != CSG_NODE_NONE)
        return empty;
    csg_memory *memory = &builder->context->memory;
    size_t left = gather_operands(builder->scene, kind, blend, children, count, NULL);
    csg_node_id *kept = left ? csg_memory_alloc(memory, left * sizeof *kept) : NULL;
    if (left && !kept)
        return csg_build_no_memory(builder);
    gather_operands(builder->scene, kind, blend, children, count, kept);
    double support =
        left > 1 && !csg_blend_takes_fields(blend.kind) ? csg_build_support(builder, blend) : 0;
    bool ready = csg_build_end_plateaus(builder, kind, support, kept, left);
    csg_node_id result = !ready  ? CSG_NODE_NONE
                         : left  ? join_operands(builder, kind, blend, kept, left, where)
                         : count ? children[0]
                                 : csg_build_empty(builder, where);
    csg_memory_release(memory, kept, left * sizeof *kept);
    return result;
}
