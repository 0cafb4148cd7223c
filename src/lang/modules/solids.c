/* SPDX-License-Identifier: MIT
 * The built-in solids: arguments in the words of the language become parameters of primitives in
 * their own frame (scene/primitives/primitives.def) and a place for it.
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "scene/primitives/kinds.h"

static csg_node_id primitive(csg_module_call *call, csg_primitive_kind kind,
                             const double *parameters)
{
    return csg_build_primitive(&call->e->builder, kind, parameters, call->statement->where);
}

static csg_node_id moved(csg_module_call *call, csg_node_id node, double x, double y, double z)
{
    csg_affine by = csg_affine_translate(csg_vec3_make(x, y, z));
    return csg_shape_moved(call, csg_shape_done(call, node), &by);
}

csg_node_id csg_module_sphere(csg_module_call *call)
{
    enum { R, D };
    double r = csg_argument_radius(call, R, D, 1, CSG_SIZE);
    if (call->failed)
        return csg_shape_empty(call);
    const csg_facet_rule rule = csg_facet_rule_now(call->e);
    uint32_t facets = csg_facets(&rule, r);
    if (!facets)
        return csg_shape_done(call, primitive(call, CSG_NODE_SPHERE, &r));
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_faceted_sphere(&job, r, facets));
}

csg_node_id csg_module_cube(csg_module_call *call)
{
    enum { SIZE, CENTER, ROUND };
    csg_vec3 size = csg_argument_vector(call, SIZE, csg_vec3_make(1, 1, 1), true);
    double smallest = fmin(size.x, fmin(size.y, size.z));
    if (!call->failed && call->values[SIZE].kind == CSG_VALUE_VECTOR &&
        call->values[SIZE].as.vector->count != 3 &&
        csg_argument_mishap(call, SIZE, CSG_DIAG_BAD_TYPE, "the default is taken",
                            "size must be a number or [x, y, z]")) {
        size = csg_vec3_make(1, 1, 1);
        smallest = 1;
    }
    if (!call->failed && !(smallest > 0))
        csg_argument_error(call, SIZE, CSG_DIAG_EMPTY_SHAPE,
                           "an edge of length %g makes no solid, it must be above 0", smallest);
    double round = csg_argument_rounding(call, ROUND, smallest);
    if (call->failed)
        return csg_shape_empty(call);
    const double half[4] = {size.x / 2, size.y / 2, size.z / 2, round};
    csg_node_id node = primitive(call, CSG_NODE_BOX, half);
    return csg_argument_boolean(call, CENTER) ? csg_shape_done(call, node)
                                              : moved(call, node, half[0], half[1], half[2]);
}

/* ---- cylinder
 * -------------------------------------------------------------------------------------- */

enum { H, R1, R2, CENTER, R, D, D1, D2, ROUND, CORE };

static void cylinder_radii(csg_module_call *call, double out[2])
{
    double both = csg_argument_radius(call, R, D, 1, CSG_SIZE);
    out[0] = csg_argument_radius(call, R1, D1, both, CSG_SIZE_OR_POINT);
    out[1] = csg_argument_radius(call, R2, D2, both, CSG_SIZE_OR_POINT);
    bool ends = csg_has_argument(call, R1) || csg_has_argument(call, R2) ||
                csg_has_argument(call, D1) || csg_has_argument(call, D2);
    bool one = (csg_has_argument(call, R1) || csg_has_argument(call, D1)) &&
               (csg_has_argument(call, R2) || csg_has_argument(call, D2));
    if (one && (csg_has_argument(call, R) || csg_has_argument(call, D)))
        csg_eval_report(call->e, CSG_DIAG_CONFLICT, call->spans[csg_has_argument(call, R) ? R : D],
                        NULL, "cylinder() gets a radius for each end, this one is ignored");
    if (ends && !call->failed && out[0] == 0 && out[1] == 0)
        csg_argument_error(call,
                           csg_has_argument(call, R2)   ? R2
                           : csg_has_argument(call, R1) ? R1
                                                        : D1,
                           CSG_DIAG_EMPTY_SHAPE, "the radii at both ends are 0");
}

/* The frustum that grows to this one by `round`: its sides move inwards by round along their
 * normal, so at slope s the radius shrinks by round sqrt(1 + s^2). False when nothing is left. */
static bool shrink(double radii[2], double *half, double round)
{
    double slope = (radii[1] - radii[0]) / (2 * *half), side = round * sqrt(1 + slope * slope);
    double bottom = radii[0] + slope * round - side, top = radii[1] - slope * round - side;
    double slack = 1e-12 * (radii[0] + radii[1]);
    *half -= round;
    radii[0] = bottom < 0 && bottom > -slack ? 0 : bottom;
    radii[1] = top < 0 && top > -slack ? 0 : top;
    return *half > 0 && radii[0] >= 0 && radii[1] >= 0;
}

static csg_node_id frustum(csg_module_call *call, const double radii[2], double half, double round)
{
    const double parameters[4] = {radii[0], radii[1], half, round};
    if (radii[0] > 0 || radii[1] > 0)
        return primitive(call, CSG_NODE_FRUSTUM, parameters);
    csg_vec3 end = csg_vec3_make(0, 0, half); /* nothing but rounding is left: a capsule */
    return csg_build_capsule(&call->e->builder, csg_vec3_scale(end, -1), end, round, round,
                             call->statement->where);
}

/* A prism or pyramid, its edges rounded. */
static csg_node_id faceted(csg_module_call *call, double radii[2], double half, double round,
                           uint32_t facets)
{
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = csg_faceted_frustum(&job, radii, half, facets);
    return csg_shape_made(call, &job, csg_solid_grown(&job, node, round));
}

csg_node_id csg_module_cylinder(csg_module_call *call)
{
    double radii[2], h = csg_argument_number(call, H, 1, CSG_SIZE);
    cylinder_radii(call, radii);
    double round = csg_argument_number(call, ROUND, 0, CSG_NOT_NEGATIVE), half = h / 2;
    bool grows = csg_argument_boolean(call, CORE);
    const csg_facet_rule rule = csg_facet_rule_now(call->e);
    uint32_t facets = grows ? 0 : csg_facets(&rule, fmax(radii[0], radii[1]));
    double inner = facets ? csg_cosine_deg(180.0 / facets) : 1;
    radii[0] *= inner; /* rounding moves the faces, which are nearer to the axis than the edges */
    radii[1] *= inner;
    if (!call->failed && round > 0 && !grows && !shrink(radii, &half, round))
        csg_argument_error(call, ROUND, CSG_DIAG_OUT_OF_RANGE, "round is %g, that does not fit",
                           round);
    radii[0] /= inner;
    radii[1] /= inner;
    if (call->failed)
        return csg_shape_empty(call);
    bool pointed = radii[0] > 0 || radii[1] > 0;
    csg_node_id node = facets && pointed ? faceted(call, radii, half, round, facets)
                                         : frustum(call, radii, half, round);
    return csg_argument_boolean(call, CENTER)
               ? csg_shape_done(call, node)
               : moved(call, node, 0, 0, grows ? h / 2 + round : h / 2);
}

/* ---- the others
 * --------------------------------------------------------------------------------------- */

csg_node_id csg_module_capsule(csg_module_call *call)
{
    enum { P1, P2, RADIUS1, RADIUS2, RADIUS };
    csg_vec3 p1 = csg_argument_vector(call, P1, csg_vec3_make(0, 0, 0), false);
    csg_vec3 p2 = csg_argument_vector(call, P2, csg_vec3_make(0, 0, 1), false);
    double r = csg_argument_number(call, RADIUS, 1, CSG_POSITIVE);
    double r1 = csg_argument_number(call, RADIUS1, r, CSG_NOT_NEGATIVE);
    double r2 = csg_argument_number(call, RADIUS2, csg_has_argument(call, RADIUS) ? r : r1,
                                    CSG_NOT_NEGATIVE);
    if (!call->failed && r1 == 0 && r2 == 0)
        csg_argument_error(call, csg_has_argument(call, RADIUS2) ? RADIUS2 : RADIUS1,
                           CSG_DIAG_OUT_OF_RANGE, "the radii at both ends are 0");
    if (call->failed)
        return csg_shape_empty(call);
    return csg_shape_done(
        call, csg_build_capsule(&call->e->builder, p1, p2, r1, r2, call->statement->where));
}

/* The primitive's arc lies on both sides of +x; the language's begins there. */
csg_node_id csg_module_torus(csg_module_call *call)
{
    enum { RING, TUBE, ANGLE, MIDDLE };
    double r = csg_argument_number(call, RING, 1, CSG_POSITIVE);
    double tube = csg_argument_number(call, TUBE, 0.25, CSG_POSITIVE);
    double angle = csg_argument_number(call, ANGLE, 360, CSG_ANY);
    if (!call->failed && (angle == 0 || fabs(angle) > 360))
        csg_argument_error(call, ANGLE, CSG_DIAG_OUT_OF_RANGE, "angle is %g", angle);
    if (call->failed)
        return csg_shape_empty(call);
    const double parameters[3] = {r, tube, fabs(angle) / 2};
    csg_node_id node = csg_shape_done(call, primitive(call, CSG_NODE_TORUS, parameters));
    if (fabs(angle) == 360 || csg_argument_boolean(call, MIDDLE) || node == CSG_NODE_NONE)
        return node;
    csg_affine turn = csg_affine_rotate(angle / 2, csg_vec3_make(0, 0, 1));
    return csg_shape_done(
        call, csg_build_transform(&call->e->builder, &turn, node, call->statement->where));
}

csg_node_id csg_module_ellipsoid(csg_module_call *call)
{
    enum { AXES };
    csg_vec3 r = csg_argument_vector(call, AXES, csg_vec3_make(1, 1, 1), true);
    double smallest = fmin(r.x, fmin(r.y, r.z));
    if (!call->failed && call->values[AXES].kind == CSG_VALUE_VECTOR &&
        call->values[AXES].as.vector->count != 3)
        csg_argument_error(call, AXES, CSG_DIAG_BAD_TYPE, "r must be a number or [a, b, c]");
    if (!call->failed && !(smallest > 0))
        csg_argument_error(call, AXES, CSG_DIAG_OUT_OF_RANGE,
                           "a semi-axis is %g, it must be above 0", smallest);
    if (call->failed)
        return csg_shape_empty(call);
    const double axes[3] = {r.x, r.y, r.z};
    return csg_shape_done(call, primitive(call, CSG_NODE_ELLIPSOID, axes));
}

csg_node_id csg_module_plane(csg_module_call *call)
{
    enum { NORMAL, DISTANCE };
    csg_vec3 n = csg_argument_vector(call, NORMAL, csg_vec3_make(0, 0, 1), false);
    double d = csg_argument_number(call, DISTANCE, 0, CSG_ANY);
    if (!call->failed && n.x == 0 && n.y == 0 && n.z == 0)
        csg_argument_error(call, NORMAL, CSG_DIAG_OUT_OF_RANGE, "the normal has no direction");
    if (call->failed)
        return csg_shape_empty(call);
    const double parameters[4] = {n.x, n.y, n.z, d};
    return csg_shape_done(call, primitive(call, CSG_NODE_PLANE, parameters));
}
