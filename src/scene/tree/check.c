/* SPDX-License-Identifier: MIT
 * What a scene's numbers may be; see check.h. NaN fails every comparison, so ranges are written
 * such that it is refused.
 */
#include "scene/tree/check.h"

#include <stdarg.h>
#include <stdio.h>

#include "scene/primitives/curve.h"

/* Larger lengths leave no room for the squares and ratios that the formulas need. */
#define LARGEST_LENGTH 1e15
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

static bool check_range(csg_scene_builder *builder, double value, const char *what)
{
    if (!isfinite(value))
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s is not a finite number", what);
    else if (fabs(value) > LARGEST_LENGTH)
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s is larger than %g", what, LARGEST_LENGTH);
    return builder->status == CSGM_OK;
}

static bool check_positive(csg_scene_builder *builder, double value, const char *what)
{
    if (!check_range(builder, value, what))
        return false;
    if (value <= 0)
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s must be positive", what);
    else if (value < CSG_SMALLEST_LENGTH)
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s is smaller than %g", what, CSG_SMALLEST_LENGTH);
    return builder->status == CSGM_OK;
}

static bool check_not_negative(csg_scene_builder *builder, double value, const char *what)
{
    if (!check_range(builder, value, what))
        return false;
    if (value < 0)
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s must not be negative", what);
    return builder->status == CSGM_OK;
}

static bool check_radii(csg_scene_builder *builder, double r1, double r2)
{
    if (!check_not_negative(builder, r1, "the radius") ||
        !check_not_negative(builder, r2, "the radius"))
        return false;
    if (fmax(r1, r2) < CSG_SMALLEST_LENGTH)
        csg_check_fail(builder, CSGM_ERR_SCENE, "one of the two radii must be positive");
    return builder->status == CSGM_OK;
}

static bool check_box(csg_scene_builder *builder, const double *v)
{
    if (!check_positive(builder, v[0], "the size") || !check_positive(builder, v[1], "the size") ||
        !check_positive(builder, v[2], "the size") ||
        !check_not_negative(builder, v[3], "the rounding radius"))
        return false;
    if (v[3] > fmin(v[0], fmin(v[1], v[2])))
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the rounding radius is more than half the smallest side");
    return builder->status == CSGM_OK;
}

static bool check_capsule(csg_scene_builder *builder, const double *v)
{
    if (!check_positive(builder, v[0], "the length") || !check_radii(builder, v[1], v[2]))
        return false;
    if (fabs(v[1] - v[2]) >= v[0])
        csg_check_fail(builder, CSGM_ERR_SCENE, "one end of the capsule swallows the other");
    return builder->status == CSGM_OK;
}

static bool check_torus(csg_scene_builder *builder, const double *v)
{
    if (!check_positive(builder, v[0], "the radius") ||
        !check_positive(builder, v[1], "the tube radius"))
        return false;
    if (!(v[2] > 0 && v[2] <= 180))
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the angle must be above 0 and at most 360 degrees");
    return builder->status == CSGM_OK;
}

static bool check_rectangle(csg_scene_builder *builder, const double *v)
{
    if (!check_positive(builder, v[0], "the size") || !check_positive(builder, v[1], "the size") ||
        !check_not_negative(builder, v[2], "the rounding radius"))
        return false;
    if (v[2] > fmin(v[0], v[1]))
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the rounding radius is more than half the smallest side");
    return builder->status == CSGM_OK;
}

/* A normal that is of unit length already, to the last bits, is left alone: printing and parsing
 * a scene again must not move its planes. */
static bool check_plane(csg_scene_builder *builder, double *v)
{
    for (int i = 0; i < 3; i++)
        if (!check_range(builder, v[i], "the normal"))
            return false;
    if (!check_range(builder, v[3], "the distance"))
        return false;
    double length = csg_vec3_norm(csg_vec3_make(v[0], v[1], v[2]));
    if (length < CSG_SMALLEST_LENGTH) {
        csg_check_fail(builder, CSGM_ERR_SCENE, "the normal must not be zero");
        return false;
    }
    if (fabs(length - 1) > 1e-15)
        for (int i = 0; i < 3; i++)
            v[i] /= length;
    return true;
}

static bool check_superellipsoid(csg_scene_builder *builder, double *v)
{
    const double most = 64;
    for (int i = 0; i < 3; i++)
        if (!check_positive(builder, v[i], "the semi-axis"))
            return false;
    for (int i = 3; i < 5; i++)
        if (!(v[i] >= 1 && v[i] <= most)) {
            csg_check_fail(builder, CSGM_ERR_SCENE, "an exponent must be 1 to %g, not %g", most,
                           v[i]);
            return false;
        }
    v[5] = csg_gauge_slope(v);
    return true;
}

static bool check_tube(csg_scene_builder *builder, csg_node_kind kind, const double *v)
{
    double most = 0;
    for (uint32_t i = 0; i < csg_primitive_parameter_count(kind); i++) {
        bool is_radius = i % CSG_CURVE_AXES == CSG_CURVE_RADIUS;
        if (!(is_radius ? check_not_negative(builder, v[i], "the radius")
                        : check_range(builder, v[i], "a control point")))
            return false;
        most = is_radius ? fmax(most, v[i]) : most;
    }
    if (most < CSG_SMALLEST_LENGTH)
        csg_check_fail(builder, CSGM_ERR_SCENE, "one of the radii must be positive");
    return builder->status == CSGM_OK;
}

bool csg_check_primitive(csg_scene_builder *builder, csg_node_kind kind, double *v)
{
    switch (kind) {
    case CSG_NODE_SPHERE:
        return check_positive(builder, v[0], "the radius");
    case CSG_NODE_BOX:
        return check_box(builder, v);
    case CSG_NODE_FRUSTUM:
        return check_radii(builder, v[0], v[1]) && check_positive(builder, v[2], "the height") &&
               check_not_negative(builder, v[3], "the rounding radius");
    case CSG_NODE_CAPSULE:
        return check_capsule(builder, v);
    case CSG_NODE_TORUS:
        return check_torus(builder, v);
    case CSG_NODE_ELLIPSOID:
        return check_positive(builder, v[0], "the semi-axis") &&
               check_positive(builder, v[1], "the semi-axis") &&
               check_positive(builder, v[2], "the semi-axis");
    case CSG_NODE_PLANE:
        return check_plane(builder, v);
    case CSG_NODE_CIRCLE:
        return check_positive(builder, v[0], "the radius");
    case CSG_NODE_RECTANGLE:
        return check_rectangle(builder, v);
    case CSG_NODE_SLAB:
        return check_positive(builder, v[0], "the height");
    case CSG_NODE_SUPERELLIPSOID:
        return check_superellipsoid(builder, v);
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        return check_tube(builder, kind, v);
    default:
        csg_check_fail(builder, CSGM_ERR_ARGUMENT, "there is no such primitive");
        return false;
    }
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

bool csg_check_slope(csg_scene_builder *builder, csg_formula *formula)
{
    const double smallest = 1e-6, largest = 1e12;
    if (!(formula->lipschitz <= largest))
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
        blend->kind == CSG_BLEND_ORTHOGONAL) {
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
    if (blend->kind == CSG_BLEND_SHARP || blend->n == 0) {
        *blend = (csg_blend){CSG_BLEND_SHARP, 0};
        return true;
    }
    if (!check_not_negative(builder, blend->n, "the blend's width"))
        return false;
    if (blend->n < CSG_SMALLEST_LENGTH) /* below what any coordinate can show */
        *blend = (csg_blend){CSG_BLEND_SHARP, 0};
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
    if (warp->kind == CSG_WARP_BEND && !check_positive(builder, v[CSG_BEND_RADIUS], "the radius"))
        return false;
    if (warp->kind == CSG_WARP_TWIST && !(v[CSG_TWIST_LOW] <= v[CSG_TWIST_HIGH]))
        csg_check_fail(builder, CSGM_ERR_SCENE, "the twist ends below its beginning");
    if (builder->scene->nodes[child].warps >= CSG_MOST_WARPS)
        csg_check_fail(builder, CSGM_ERR_SCENE, "more than %d deformations one inside the other",
                       CSG_MOST_WARPS);
    return builder->status == CSGM_OK;
}
