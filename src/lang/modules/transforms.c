/* SPDX-License-Identifier: MIT
 * Transforms, colours, operators and blends: modules that act on their children.
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/evaluate/marks.h"
#include "lang/modules/formula_call.h"
#include "lang/modules/shapes.h"

/* A figure of the plane stays in it, as in OpenSCAD: what turns out of it is told and left out. The
 * map becomes its plane part; false: nothing of the figure is left. */
static bool keep_plane(csg_module_call *call, csg_affine *by)
{
    const double slack = 1e-12;
    csg_span where = call->statement->where;
    double size = fabs(by->m[0][0]) + fabs(by->m[0][1]) + fabs(by->m[1][0]) + fabs(by->m[1][1]);
    double out = fabs(by->m[0][2]) + fabs(by->m[1][2]) + fabs(by->m[2][0]) + fabs(by->m[2][1]);
    double area = by->m[0][0] * by->m[1][1] - by->m[0][1] * by->m[1][0];
    if (fabs(area) <= slack * fmax(size * size, 1)) {
        csg_eval_report(call->e, CSG_DIAG_LEAVES_PLANE, where,
                        "linear_extrude makes a solid of a figure",
                        "%s() leaves nothing of this flat figure", call->name);
        return false;
    }
    if (out > slack * size)
        csg_eval_report(call->e, CSG_DIAG_LEAVES_PLANE, where,
                        "linear_extrude makes a solid of a figure",
                        "%s() takes a flat figure out of its plane: it stays there", call->name);
    *by = csg_affine_of_plane(*by);
    return true;
}

static csg_node_id transformed(csg_module_call *call, const csg_affine *by)
{
    csg_eval *e = call->e;
    csg_affine map = *by;
    size_t first_mark = e->mark_count;
    csg_node_id children = csg_module_children(call);
    csg_marks_move(e, first_mark, by, call->statement->where);
    if (call->failed || children == CSG_NODE_NONE || e->stop)
        return children;
    bool flat = csg_eval_is_flat(e, children);
    if (flat && !keep_plane(call, &map))
        return csg_shape_empty(call);
    if (!flat && csg_affine_determinant(map) == 0 && !csg_eval_is_empty(e, children)) {
        csg_argument_error(call, 0, CSG_DIAG_SINGULAR, "%s, nothing is left",
                           call->name[0] == 's' ? "a factor of 0 flattens the solid"
                                                : "this matrix flattens the solid");
        return csg_shape_empty(call);
    }
    return csg_shape_moved(call, children, &map);
}

csg_node_id csg_module_translate(csg_module_call *call)
{
    csg_affine by =
        csg_affine_translate(csg_argument_vector(call, 0, csg_vec3_make(0, 0, 0), false));
    return transformed(call, &by);
}

csg_node_id csg_module_rotate(csg_module_call *call)
{
    enum { ANGLE, AXIS };
    csg_affine by = csg_affine_identity();
    if (call->values[ANGLE].kind == CSG_VALUE_VECTOR) {
        csg_vec3 a = csg_argument_vector(call, ANGLE, csg_vec3_make(0, 0, 0), false);
        by = csg_affine_multiply(csg_affine_rotate(a.y, csg_vec3_make(0, 1, 0)),
                                 csg_affine_rotate(a.x, csg_vec3_make(1, 0, 0)));
        by = csg_affine_multiply(csg_affine_rotate(a.z, csg_vec3_make(0, 0, 1)), by);
        if (csg_has_argument(call, AXIS))
            csg_eval_report(call->e, CSG_DIAG_CONFLICT, call->spans[AXIS], NULL,
                            "rotate() gets an angle for each axis, this axis is ignored");
    } else {
        double angle = csg_argument_number(call, ANGLE, 0, CSG_ANY);
        csg_vec3 axis = csg_argument_vector(call, AXIS, csg_vec3_make(0, 0, 1), false);
        if (axis.x != 0 || axis.y != 0 || axis.z != 0) /* else OpenSCAD leaves it as it is */
            by = csg_affine_rotate(angle, csg_vec3_normalize(axis));
    }
    return transformed(call, &by);
}

csg_node_id csg_module_scale(csg_module_call *call)
{
    csg_vec3 v = csg_argument_vector(call, 0, csg_vec3_make(1, 1, 1), true);
    csg_affine by = csg_affine_scale(v);
    return transformed(call, &by);
}

csg_node_id csg_module_mirror(csg_module_call *call)
{
    csg_vec3 v = csg_argument_vector(call, 0, csg_vec3_make(1, 0, 0), false);
    bool none = v.x == 0 && v.y == 0 && v.z == 0; /* OpenSCAD leaves the solid as it is */
    csg_affine by = none ? csg_affine_identity() : csg_affine_mirror(v);
    return transformed(call, &by);
}

/* ---- multmatrix
 * ------------------------------------------------------------------------------------- */

static bool read_row(csg_value row, double out[4])
{
    if (row.kind != CSG_VALUE_VECTOR || row.as.vector->count > 4)
        return false;
    for (uint32_t i = 0; i < row.as.vector->count; i++) {
        if (row.as.vector->items[i].kind != CSG_VALUE_NUMBER ||
            !isfinite(row.as.vector->items[i].as.number))
            return false;
        out[i] = row.as.vector->items[i].as.number;
    }
    return true;
}

static bool read_matrix(csg_value value, double m[4][4])
{
    if (value.kind != CSG_VALUE_VECTOR || value.as.vector->count > 4)
        return false;
    for (uint32_t i = 0; i < value.as.vector->count; i++)
        if (!read_row(value.as.vector->items[i], m[i]))
            return false;
    return true;
}

csg_node_id csg_module_multmatrix(csg_module_call *call)
{
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    csg_affine by = csg_affine_identity();
    if (csg_has_argument(call, 0) && !read_matrix(call->values[0], m))
        csg_argument_error(call, 0, CSG_DIAG_BAD_TYPE,
                           "m must be 3 or 4 rows of up to 4 finite numbers");
    else if (m[3][3] == 0)
        csg_argument_error(call, 0, CSG_DIAG_OUT_OF_RANGE, "the fourth row makes a perspective");
    else if (fmax(fabs(m[3][0]), fmax(fabs(m[3][1]), fabs(m[3][2]))) > 1e-9)
        csg_eval_report(call->e, CSG_DIAG_CONFLICT, call->spans[0], NULL,
                        "multmatrix() makes no perspective: its fourth row is ignored");
    for (int i = 0; i < 3 && !call->failed; i++) {
        for (int j = 0; j < 3; j++)
            by.m[i][j] = m[i][j] / m[3][3];
        by.t[i] = m[i][3] / m[3][3];
    }
    return transformed(call, &by);
}

/* ---- colour
 * -------------------------------------------------------------------------------------------- */

/* A look that cannot be is no reason to refuse the solid: the nearest is taken. */
static double component(csg_module_call *call, uint32_t index, const char *what, double value)
{
    if (!(value >= 0 && value <= 1))
        csg_eval_report(call->e, CSG_DIAG_UNKNOWN_COLOR, call->spans[index], NULL,
                        "color(): %s %g, it is from 0 to 1%s", what, value,
                        value > 1 ? " (of 255? divide by it)" : "");
    return fmin(fmax(value, 0), 1);
}

static bool read_color(csg_module_call *call, csg_color *out)
{
    csg_value value = call->values[0];
    double v[4] = {0, 0, 0, 1};
    if (value.kind == CSG_VALUE_STRING) {
        if (csg_color_parse(value.as.string->text, value.as.string->length, out))
            return true;
        csg_eval_report(call->e, CSG_DIAG_UNKNOWN_COLOR, call->spans[0],
                        "names are those of CSS; or \"#rrggbb\", or [r, g, b] from 0 to 1",
                        "there is no colour \"%.60s\"", value.as.string->text);
        return false;
    }
    if (!csg_value_numbers(value, 4, v) && !csg_value_numbers(value, 3, v)) {
        csg_argument_error(call, 0, CSG_DIAG_BAD_TYPE, "c must be a name or [r, g, b, a]");
        return false;
    }
    for (int i = 0; i < 4; i++)
        v[i] = component(call, 0, "the colour has a component of", v[i]);
    *out = (csg_color){(float)v[0], (float)v[1], (float)v[2], (float)v[3]};
    return true;
}

csg_node_id csg_module_color(csg_module_call *call)
{
    enum { COLOR, ALPHA };
    csg_eval *e = call->e;
    csg_color color = {0, 0, 0, 1};
    bool colored = csg_has_argument(call, COLOR) && read_color(call, &color);
    double alpha = csg_argument_number(call, ALPHA, color.a, CSG_ANY);
    color.a = (float)component(call, ALPHA, "alpha is", alpha);
    csg_node_id children = csg_module_children(call);
    if (!colored || call->failed || children == CSG_NODE_NONE)
        return children;
    return csg_check_node(e, csg_build_color(&e->builder, color, children, call->statement->where),
                          call->statement->where);
}

/* ---- operators
 * -------------------------------------------------------------------------------------------- */

static csg_node_id joined_children(csg_module_call *call, csg_node_kind kind)
{
    enum { BLEND, MIXED };
    csg_eval *e = call->e;
    bool varies = csg_argument_is_function(call, BLEND, 1);
    csg_joining by = {.blend = varies ? CSG_SHARP : csg_argument_blend(call, BLEND)};
    csg_formula_step *radius = NULL;
    size_t first = e->part_count, bytes = 0;
    if (varies)
        radius = csg_formula_of_function(call, BLEND, 0, &by.radius_count, &bytes);
    by.radius = call->failed ? NULL : radius;
    /* Only a union may take what a for loop or children() makes one by one: the others would
     * mean something else than in OpenSCAD. */
    csg_run_scope(e, call->statement->children, call->frame, kind == CSG_NODE_UNION);
    if ((varies || !csg_blend_is_sharp(by.blend.kind)) && e->part_count - first < 2)
        csg_eval_report(e, CSG_DIAG_UNUSED_BLEND, call->spans[BLEND], NULL,
                        "this %s has %s, its blend is not used", call->name,
                        e->part_count == first ? "no children" : "only one child");
    if (!e->stop && !csg_argument_boolean(call, MIXED))
        csg_parts_keep_alike(e, first, call->statement->where);
    csg_node_id node = csg_join_parts_by(e, first, kind, by, call->statement->where);
    csg_memory_release(e->heap.memory, radius, bytes);
    return node;
}

csg_node_id csg_module_union(csg_module_call *call)
{
    return joined_children(call, CSG_NODE_UNION);
}

csg_node_id csg_module_intersection(csg_module_call *call)
{
    return joined_children(call, CSG_NODE_INTERSECTION);
}

csg_node_id csg_module_difference(csg_module_call *call)
{
    return joined_children(call, CSG_NODE_DIFFERENCE);
}

csg_node_id csg_module_blend(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_eval_part part = {.wrapped = true, .where = call->statement->where};
    part.blend = csg_argument_blend(call, 0);
    part.node = csg_module_children(call);
    if (part.node != CSG_NODE_NONE)
        csg_push_part(e, part);
    return CSG_NODE_NONE;
}

csg_node_id csg_module_blend_within(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_eval_part part = {.is_region = true, .where = call->statement->where};
    double border = csg_argument_number(call, 0, 0, CSG_NOT_NEGATIVE);
    part.blend = border > 0 ? csg_blend_round(border) : CSG_SHARP;
    part.node = csg_module_children(call);
    if (part.node != CSG_NODE_NONE)
        csg_push_part(e, part);
    return CSG_NODE_NONE;
}

csg_node_id csg_module_group(csg_module_call *call)
{
    return csg_module_children(call);
}
