/* SPDX-License-Identifier: MIT
 * linear_extrude and rotate_extrude: their arguments (solid/extrude.c has the rest).
 */
#include <math.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/modules/imports.h"
#include "solid/operations.h"

/* ---- linear_extrude -------------------------------------------------------------------------- */

enum { HEIGHT, DIRECTION, CENTER, TWIST, SCALE, SLICES, CONVEXITY, FILE_NAME, LAYER, ORIGIN };

typedef struct straight { /* a linear extrusion */
    csg_extrusion of;
    csg_vec3 direction;
    bool center;
} straight;

static straight read_straight(csg_module_call *call)
{
    straight s = {.of = {.height = 100, .scale = {1, 1}}, .direction = {0, 0, 1}};
    double slices = csg_argument_number(call, SLICES, 0, CSG_ANY);
    if (csg_has_argument(call, DIRECTION)) {
        s.direction = csg_argument_vector(call, DIRECTION, s.direction, false);
        s.of.height = csg_vec3_norm(s.direction);
        if (!call->failed && s.direction.z == 0)
            csg_argument_error(call, DIRECTION, CSG_DIAG_OUT_OF_RANGE,
                               "v lies in the plane of the figure");
    }
    if (call->values[HEIGHT].kind != CSG_VALUE_STRING)
        s.of.height = csg_argument_number(call, HEIGHT, s.of.height, CSG_SIZE);
    s.of.twist = csg_argument_number(call, TWIST, 0, CSG_ANY);
    csg_argument_pair(call, SCALE, s.of.scale);
    s.of.scale[0] = fmax(s.of.scale[0], 0);
    s.of.scale[1] = fmax(s.of.scale[1], 0);
    s.of.slices = slices >= 1 ? (uint32_t)fmin(slices, 1e6) : 0;
    s.center = csg_argument_boolean(call, CENTER);
    s.direction = csg_vec3_normalize(s.direction);
    s.of.height *= fabs(s.direction.z);
    return s;
}

/* The children, or the file that OpenSCAD's old form names. */
static csg_node_id figure(csg_module_call *call, uint32_t file, uint32_t layer, uint32_t origin)
{
    if (csg_has_argument(call, file))
        return csg_import_figure(call, file, layer, origin);
    return csg_shape_children(call, true);
}

csg_node_id csg_module_linear_extrude(csg_module_call *call)
{
    csg_eval *e = call->e;
    straight s = read_straight(call);
    bool old = call->values[HEIGHT].kind == CSG_VALUE_STRING;
    csg_node_id flat = figure(call, old ? HEIGHT : FILE_NAME, LAYER, ORIGIN);
    if (flat == CSG_NODE_NONE || e->stop || csg_eval_is_empty(e, flat))
        return flat;
    if (call->failed)
        return csg_shape_empty(call);
    const csg_facet_rule rule = csg_facet_rule_now(e);
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = csg_shape_made(call, &job, csg_solid_extrude(&job, &rule, flat, &s.of));
    csg_affine by = csg_affine_identity();
    if (s.center)
        by.t[2] = -s.of.height / 2;
    if (s.direction.z != 0) {
        csg_affine lean = csg_affine_identity();
        lean.m[0][2] = s.direction.x / fabs(s.direction.z);
        lean.m[1][2] = s.direction.y / fabs(s.direction.z);
        lean.m[2][2] = s.direction.z > 0 ? 1 : -1;
        by = csg_affine_multiply(lean, by);
    }
    return csg_shape_moved(call, node, &by);
}

/* ---- roof ------------------------------------------------------------------------------------ */

csg_node_id csg_module_roof(csg_module_call *call)
{
    enum { METHOD };
    csg_value method = call->values[METHOD];
    bool is_straight = false;
    if (csg_has_argument(call, METHOD)) {
        const char *name = method.kind == CSG_VALUE_STRING ? method.as.string->text : "";
        is_straight = strcmp(name, "straight") == 0;
        if (!is_straight && strcmp(name, "voronoi") != 0)
            csg_argument_error(call, METHOD, CSG_DIAG_BAD_TYPE,
                               "method must be \"voronoi\" or \"straight\"");
    }
    csg_node_id flat = csg_shape_children(call, true);
    if (flat == CSG_NODE_NONE || csg_eval_is_empty(call->e, flat))
        return flat;
    if (call->failed)
        return csg_shape_empty(call);
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_roof(&job, flat, is_straight));
}

/* ---- rotate_extrude -------------------------------------------------------------------------- */

csg_node_id csg_module_rotate_extrude(csg_module_call *call)
{
    enum { ANGLE, START, FILE_OF_FIGURE = 3, ITS_LAYER, ITS_ORIGIN, SYMMETRIC };
    csg_eval *e = call->e;
    double angle = csg_argument_number(call, ANGLE, 360, CSG_ANY);
    if (angle <= -360 || angle > 360)
        angle = 360;
    double start = csg_argument_number(call, START, angle == 360 ? 180 : 0, CSG_ANY);
    csg_node_id flat = figure(call, FILE_OF_FIGURE, ITS_LAYER, ITS_ORIGIN);
    if (flat == CSG_NODE_NONE || e->stop || csg_eval_is_empty(e, flat))
        return flat;
    if (!call->failed && angle == 0)
        csg_eval_report(e, CSG_DIAG_EMPTY_SHAPE, call->statement->where, NULL,
                        "rotate_extrude() by an angle of 0 makes nothing");
    if (call->failed || angle == 0)
        return csg_shape_empty(call);
    const csg_facet_rule rule = csg_facet_rule_now(e);
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = csg_argument_boolean(call, SYMMETRIC)
                           ? csg_solid_turn(&job, flat, angle, start)
                           : csg_solid_revolve(&job, &rule, flat, angle, start);
    return csg_shape_made(call, &job, node);
}
