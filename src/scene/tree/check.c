/* SPDX-License-Identifier: MIT
 * What a scene's numbers may be; see check.h. NaN fails every comparison, so ranges are written
 * such that it is refused.
 */
#include "scene/tree/check.h"
#include "scene/operators/blend_kinds.h"

#include <stdarg.h>
#include <stdio.h>

#include "scene/formula/formula.h"
#include "scene/operators/rule.h"
#include "scene/primitives/primitive.h"
#include "scene/warp_kinds.h"

/* A map whose smallest stretch is below this part of its largest is as good as singular. */
#define SMALLEST_STRETCH 1e-13

void csg_check_fail(csg_scene_builder *builder, csgm_status status, const char *format, ...)
{
    if (builder->status != CSGM_OK)
        return;
    builder->status = status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(builder->problem, sizeof builder->problem, format, arguments);
    va_end(arguments);
}

/* Hands on what has been refused. */
static bool is_fine(csg_scene_builder *builder, bool fine, const csg_refusal *refusal)
{
    if (!fine)
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s", refusal->text);
    return builder->status == CSGM_OK;
}

static bool check_range(csg_scene_builder *builder, double value, const char *what)
{
    csg_refusal refusal = {0};
    return is_fine(builder, csg_check_range(&refusal, value, what), &refusal);
}

static bool check_not_negative(csg_scene_builder *builder, double value, const char *what)
{
    csg_refusal refusal = {0};
    return is_fine(builder, csg_check_not_negative(&refusal, value, what), &refusal);
}

static bool check_radii(csg_scene_builder *builder, double r1, double r2)
{
    csg_refusal refusal = {0};
    return is_fine(builder, csg_check_radii(&refusal, r1, r2), &refusal);
}

bool csg_check_primitive(csg_scene_builder *builder, csg_primitive_kind kind, double *v)
{
    csg_refusal refusal = {0};
    if (!csg_node_is_named_primitive(kind))
        csg_check_fail(builder, CSGM_ERR_ARGUMENT, "there is no such primitive");
    else if (!csg_primitive_of(kind)->check(&refusal, v))
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s", refusal.text);
    return builder->status == CSGM_OK;
}

/* Operands come first, constants are finite. */
static bool is_sound_step(const csg_formula_step *steps, uint32_t index)
{
    const csg_formula_step *step = &steps[index];
    if (step->op >= CSG_FORMULA_OP_COUNT)
        return false;
    uint32_t arity = csg_formula_op_arity(step->op);
    return (arity < 1 || step->a < index) && (arity < 2 || step->b < index) &&
           (step->op != CSG_FORMULA_CONSTANT || isfinite(step->constant));
}

/* Angles in radians take a slot or two more on a tape. */
static void check_width(csg_scene_builder *builder, const csg_formula_step *steps, uint32_t count)
{
    uint32_t width = 0;
    if (!csg_formula_width(&builder->context->memory, steps, count, &width))
        csg_check_fail(builder, CSGM_ERR_MEMORY, "%s", "");
    else if (width + 4 > CSG_FORMULA_SLOTS)
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the formula needs %u intermediate values at once, at most %d can be", width,
                       CSG_FORMULA_SLOTS - 4);
}

bool csg_check_field(csg_scene_builder *builder, const csg_formula_step *steps, uint32_t count,
                     csg_box bounds, double lipschitz)
{
    if (count == 0 || count > CSG_LONGEST_FORMULA)
        csg_check_fail(builder, CSGM_ERR_SCENE, "the formula has more than %d operations",
                       CSG_LONGEST_FORMULA);
    for (uint32_t i = 0; i < count && builder->status == CSGM_OK; i++)
        if (!is_sound_step(steps, i))
            csg_check_fail(builder, CSGM_ERR_SCENE, "the formula has a number that is not finite");
    const double sides[6] = {bounds.min.x, bounds.min.y, bounds.min.z,
                             bounds.max.x, bounds.max.y, bounds.max.z};
    bool unbounded = !csg_box_is_finite(bounds) && !csg_box_is_empty(bounds);
    for (int i = 0; i < 6 && builder->status == CSGM_OK; i++)
        if (unbounded ? isfinite(sides[i])
                      : !check_range(builder, sides[i], "a side of the bounds"))
            csg_check_fail(builder, CSGM_ERR_SCENE, "the bounds are not finite");
    if (builder->status == CSGM_OK && !unbounded &&
        !(bounds.min.x < bounds.max.x && bounds.min.y < bounds.max.y &&
          bounds.min.z < bounds.max.z))
        csg_check_fail(builder, CSGM_ERR_SCENE, "the bounds are empty");
    if (!(lipschitz >= 0 && isfinite(lipschitz)))
        csg_check_fail(builder, CSGM_ERR_SCENE, "lipschitz must be a positive number");
    if (builder->status == CSGM_OK)
        check_width(builder, steps, count);
    return builder->status == CSGM_OK;
}

static void refuse_slope(csg_scene_builder *builder, double stated, const csg_slope_trial *trial)
{
    csg_check_fail(builder, CSGM_ERR_SCENE,
                   "lipschitz = %.9g is too small: at [%.6g, %.6g, %.6g] the function changes by "
                   "%.6g along one unit of length",
                   stated, trial->place.x, trial->place.y, trial->place.z, trial->slope);
}

bool csg_check_slope(csg_scene_builder *builder, double stated, const csg_slope_trial *trial,
                     csg_formula *formula)
{
    const double smallest = 1e-6, largest = 1e12;
    bool settled = trial->verdict == CSG_SLOPE_PROVEN || !(trial->bound <= largest);
    if (isnan(trial->bound)) {
        csg_check_fail(builder, CSGM_ERR_MEMORY, "%s", "");
    } else if (stated > 0 && trial->verdict == CSG_SLOPE_REFUTED) {
        refuse_slope(builder, stated, trial);
    } else if (stated > 0) {
        formula->lipschitz = settled || formula->trusted ? stated : fmax(stated, trial->bound);
        formula->trusted &= !settled;
    } else {
        formula->lipschitz = trial->bound;
        formula->trusted = false;
    }
    if (builder->status == CSGM_OK && !(formula->lipschitz <= largest))
        csg_check_fail(builder, CSGM_ERR_SCENE, "how steep the formula gets cannot be told%s",
                       csg_box_is_finite(formula->bounds)
                           ? "; give lipschitz ="
                           : "; give bounds = [[x, y, z], [x, y, z]], or lipschitz =");
    formula->lipschitz = fmax(formula->lipschitz, smallest);
    return builder->status == CSGM_OK;
}

bool csg_check_ends(csg_scene_builder *builder, csg_vec3 p1, csg_vec3 p2, double r1, double r2)
{
    const double ends[6] = {p1.x, p1.y, p1.z, p2.x, p2.y, p2.z};
    for (int i = 0; i < 6; i++)
        if (!check_range(builder, ends[i], "the end of the capsule"))
            return false;
    return check_radii(builder, r1, r2);
}

bool csg_check_matrix(csg_scene_builder *builder, const csg_affine *matrix)
{
    double smallest, largest;
    csg_affine inverse;
    for (int i = 0; i < 3; i++) {
        if (!check_range(builder, matrix->t[i], "a number of the transform"))
            return false;
        for (int j = 0; j < 3; j++)
            if (!check_range(builder, matrix->m[i][j], "a number of the transform"))
                return false;
    }
    csg_affine_singular_values(matrix, &smallest, &largest);
    if (!csg_affine_invert(*matrix, &inverse) || !(smallest > SMALLEST_STRETCH * largest))
        csg_check_fail(builder, CSGM_ERR_SCENE, "the transform flattens the solid");
    else if (smallest < CSG_SMALLEST_LENGTH)
        csg_check_fail(builder, CSGM_ERR_SCENE, "the transform shrinks the solid to nothing");
    return builder->status == CSGM_OK;
}

bool csg_check_operator(csg_scene_builder *builder, csg_node_kind kind, csg_blend *blend)
{
    if (!csg_node_is_operator(kind) || (unsigned)blend->kind >= CSG_BLEND_END ||
        csg_blend_is_orthogonal(blend->kind)) {
        csg_check_fail(builder, CSGM_ERR_ARGUMENT, "there is no such operator");
        return false;
    }
    if (csg_blend_is_rule(blend->kind)) {
        const csgm_scene *scene = builder->scene;
        if (!(blend->n >= 0 && blend->n < (double)scene->rule_count) ||
            scene->rules[(size_t)blend->n].kind != blend->kind)
            csg_check_fail(builder, CSGM_ERR_ARGUMENT, "there is no such rule");
        return builder->status == CSGM_OK;
    }
    if (csg_blend_is_sharp(blend->kind) || blend->n == 0) {
        *blend = CSG_SHARP;
        return true;
    }
    if (!check_not_negative(builder, blend->n, "the blend's width"))
        return false;
    if (blend->n < CSG_SMALLEST_LENGTH) /* below what any coordinate can show */
        *blend = CSG_SHARP;
    return true;
}

bool csg_check_look(csg_scene_builder *builder, const csg_look *look)
{
    const float channels[4] = {look->color.r, look->color.g, look->color.b, look->color.a};
    for (int i = 0; i < 4; i++)
        if (!(channels[i] >= 0 && channels[i] <= 1))
            csg_check_fail(builder, CSGM_ERR_SCENE, "a colour's numbers must lie between 0 and 1");
    if (!(look->metallic >= 0 && look->metallic <= 1 && look->roughness >= 0 &&
          look->roughness <= 1))
        csg_check_fail(builder, CSGM_ERR_SCENE, "a material's numbers must lie between 0 and 1");
    return builder->status == CSGM_OK;
}

bool csg_check_offset(csg_scene_builder *builder, double r)
{
    return check_range(builder, r, "the distance");
}

bool csg_check_warp(csg_scene_builder *builder, const csg_warp *warp, csg_node_id child)
{
    const double *v = warp->parameters;
    if ((unsigned)warp->kind >= CSG_WARP_COUNT) {
        csg_check_fail(builder, CSGM_ERR_ARGUMENT, "there is no such warp");
        return false;
    }
    for (uint32_t i = 0; i < csg_warp_given(warp->kind); i++)
        if (!check_range(builder, v[i], "a number of the deformation"))
            return false;
    csg_refusal refusal = {0};
    if (!is_fine(builder, csg_warp_check(warp, &refusal), &refusal))
        return false;
    if (builder->scene->nodes[child].warps >= CSG_MOST_WARPS)
        csg_check_fail(builder, CSGM_ERR_SCENE, "more than %d deformations one inside the other",
                       CSG_MOST_WARPS);
    return builder->status == CSGM_OK;
}
