/* SPDX-License-Identifier: MIT
 * Modules that change the shape of their children: resize, offset3d, shell, repeat, twist, bend.
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "scene/warp_kinds.h"
#include "solid/measure.h"

/* ---- resize ---------------------------------------------------------------------------------- */

/* Which axes keep the proportions. */
static void read_auto(csg_module_call *call, uint32_t index, bool out[3])
{
    csg_value value = call->values[index];
    for (int i = 0; i < 3; i++) {
        bool own = value.kind == CSG_VALUE_VECTOR && (uint32_t)i < value.as.vector->count;
        out[i] = own                              ? csg_value_is_true(value.as.vector->items[i])
                 : value.kind == CSG_VALUE_VECTOR ? false
                                                  : csg_value_is_true(value);
    }
}

/* Factors that bring `size` to the new one, where that is above 0; the others follow the largest
 * factor where they are automatic (in OpenSCAD that is the one of the longest new side). */
static bool factors(csg_module_call *call, const double wanted[3], const bool automatic[3],
                    const double size[3], int count, double out[3])
{
    double largest = -1, follow = 1;
    for (int i = 0; i < count; i++)
        if (wanted[i] > largest) {
            largest = wanted[i];
            follow = wanted[i] > 0 ? wanted[i] / size[i] : 1;
        }
    for (int i = 0; i < 3; i++) {
        out[i] = i >= count ? 1 : wanted[i] > 0 ? wanted[i] / size[i] : automatic[i] ? follow : 1;
        if (!(isfinite(out[i]) && out[i] > 0)) {
            csg_argument_error(call, 0, CSG_DIAG_OUT_OF_RANGE, "the solid has no size along %c",
                               "xyz"[i]);
            return false;
        }
    }
    return true;
}

/* [x, y, z] or less of it, as in OpenSCAD: sides that are not named stay as they are. */
static csg_vec3 read_size(csg_module_call *call, uint32_t index)
{
    double x;
    csg_value value = call->values[index];
    if (csg_value_numbers(value, 1, &x) && isfinite(x))
        return csg_vec3_make(x, 0, 0);
    return csg_argument_vector(call, index, csg_vec3_make(0, 0, 0),
                               value.kind != CSG_VALUE_VECTOR || value.as.vector->count > 1);
}

csg_node_id csg_module_resize(csg_module_call *call)
{
    enum { NEW_SIZE, AUTO };
    csg_eval *e = call->e;
    csg_vec3 to = read_size(call, NEW_SIZE);
    bool automatic[3];
    csg_box box;
    double scale[3];
    read_auto(call, AUTO, automatic);
    csg_node_id node = csg_module_children(call);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node) || call->failed)
        return node;
    if (!csg_shape_box(call, node, &box))
        return csg_shape_empty(call);
    csg_vec3 size = csg_box_size(box);
    if (!factors(call, (double[]){to.x, to.y, to.z}, automatic, (double[]){size.x, size.y, size.z},
                 csg_eval_is_flat(e, node) ? 2 : 3, scale))
        return node;
    csg_affine by = csg_affine_scale(csg_vec3_make(scale[0], scale[1], scale[2]));
    return csg_shape_moved(call, node, &by);
}

/* ---- offset3d, shell ------------------------------------------------------------------------- */

static csg_node_id grown(csg_module_call *call, csg_node_id node, double by)
{
    if (node == CSG_NODE_NONE || csg_eval_is_empty(call->e, node))
        return node;
    return csg_shape_done(call,
                          csg_build_offset(&call->e->builder, by, node, call->statement->where));
}

/* Beyond this part of what was asked for there is a warning. */
#define GROWTH_TOLD 1.2

static double without_dust(double x, double size)
{
    return fabs(x) > 1e-6 * size ? x : 0;
}

/* Tells of solids that have no distance for a field: what is added to it moves the surface farther.
 * What blends and edges make of distances, a little more than sqrt(2), the manual says. */
static void tell_of_growth(csg_module_call *call, csg_node_id node, double by)
{
    csg_eval *e = call->e;
    csg_solid_job job = csg_shape_job(call);
    csg_growth growth;
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node) || csg_distances_are_joined(&job, node))
        return;
    csgm_status status = csg_sample_growth(&job, node, by, &growth);
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(e);
    if (status != CSGM_OK || growth.most <= GROWTH_TOLD * fabs(by))
        return;
    double size = csg_vec3_norm(growth.at);
    csg_eval_report(e, CSG_DIAG_NO_DISTANCE, call->statement->where,
                    by > 0 ? "minkowski() with a sphere adds the same everywhere" : NULL,
                    "%s(%g): the field is no distance here, the surface moves by %g and up to "
                    "%.3g, near [%.3g, %.3g, %.3g]",
                    call->name, fabs(by), fabs(by), growth.most, without_dust(growth.at.x, size),
                    without_dust(growth.at.y, size), without_dust(growth.at.z, size));
}

/* Of figures too: there it is what offset() does where their field is a distance. */
csg_node_id csg_module_offset3d(csg_module_call *call)
{
    double r = csg_argument_number(call, 0, 1, CSG_ANY);
    csg_node_id node = csg_module_children(call);
    if (!call->failed)
        tell_of_growth(call, node, r);
    return call->failed ? csg_shape_empty(call) : grown(call, node, r);
}

csg_node_id csg_module_shell(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_scene_builder *builder = &e->builder;
    csg_span where = call->statement->where;
    double thickness = csg_argument_number(call, 0, 1, CSG_POSITIVE);
    csg_node_id outer = csg_module_children(call);
    if (outer == CSG_NODE_NONE || csg_eval_is_empty(e, outer))
        return outer;
    if (call->failed)
        return csg_shape_empty(call);
    tell_of_growth(call, outer, -thickness);
    csg_node_id inner =
        grown(call, csg_shape_done(call, csg_build_copy(builder, outer)), -thickness);
    if (inner == CSG_NODE_NONE)
        return inner;
    return csg_shape_done(call, csg_build_operator(builder, CSG_NODE_DIFFERENCE, CSG_SHARP,
                                                   (csg_node_id[]){outer, inner}, 2, where));
}

/* ---- repeat ---------------------------------------------------------------------------------- */

/* Copies along each axis: a number counts along every axis that the cell has. */
static bool read_counts(csg_module_call *call, uint32_t index, csg_vec3 cell, uint32_t out[3])
{
    const double most = 1e6, steps[3] = {cell.x, cell.y, cell.z};
    csg_value value = call->values[index];
    double n[3] = {1, 1, 1};
    if (value.kind == CSG_VALUE_NUMBER)
        for (int i = 0; i < 3; i++)
            n[i] = steps[i] != 0 ? value.as.number : 1;
    else if (csg_has_argument(call, index) && !csg_value_numbers(value, 3, n) &&
             !csg_value_numbers(value, 2, n)) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "count must be a number or [x, y, z]");
        return false;
    }
    for (int i = 0; i < 3; i++) {
        if (!(n[i] >= 1 && n[i] <= most) || n[i] != floor(n[i])) {
            csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE, "%g copies along %c", n[i],
                               "xyz"[i]);
            return false;
        }
        out[i] = (uint32_t)n[i];
    }
    return true;
}

csg_node_id csg_module_repeat(csg_module_call *call)
{
    enum { CELL, COUNT };
    csg_eval *e = call->e;
    uint32_t counts[3];
    csg_vec3 cell = csg_argument_vector(call, CELL, csg_vec3_make(0, 0, 0), true);
    bool known = read_counts(call, COUNT, cell, counts);
    csg_node_id node = csg_module_children(call);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node))
        return node;
    if (!known || call->failed)
        return csg_shape_empty(call);
    double total = (double)counts[0] * counts[1] * counts[2];
    if (total > 1e8 || !csg_eval_charge(e, (uint64_t)total, call->statement->where)) {
        csg_argument_error(call, COUNT, CSG_DIAG_OUT_OF_RANGE, "%g copies are too many", total);
        return csg_shape_empty(call);
    }
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_repeat(&job, node, cell, counts));
}

/* ---- warps ----------------------------------------------------------------------------------- */

static csg_node_id warped(csg_module_call *call, const csg_warp *warp, csg_node_id node)
{
    return csg_shape_done(call,
                          csg_build_warp(&call->e->builder, warp, node, call->statement->where));
}

csg_node_id csg_module_twist(csg_module_call *call)
{
    enum { RATE, LOW, HIGH };
    csg_eval *e = call->e;
    double rate = csg_argument_number(call, RATE, 0, CSG_ANY), size;
    bool between = csg_has_argument(call, LOW) && csg_has_argument(call, HIGH);
    csg_node_id node = between ? csg_module_children(call) : csg_shape_children(call, false);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node))
        return node;
    if (rate == 0 || call->failed)
        return call->failed ? csg_shape_empty(call) : node;
    csg_solid_job job = csg_shape_job(call);
    bool finite = csg_finite_size(&job, node, &size);
    csg_shape_made(call, &job, node);
    if (!finite)
        return csg_shape_empty(call);
    csg_box box = csg_build_box(&e->builder, node);
    double low = csg_argument_number(call, LOW, box.min.z, CSG_ANY);
    double high = csg_argument_number(call, HIGH, box.max.z, CSG_ANY);
    if (!call->failed && !(low < high))
        csg_argument_error(call, HIGH, CSG_DIAG_OUT_OF_RANGE, "high is %g, low is %g", high, low);
    if (call->failed)
        return csg_shape_empty(call);
    const csg_warp warp = {.kind = CSG_WARP_TWIST, .parameters = {rate, low, high}};
    return warped(call, &warp, node);
}

csg_node_id csg_module_bend(csg_module_call *call)
{
    double radius = csg_argument_number(call, 0, 1, CSG_POSITIVE);
    csg_node_id node = csg_shape_children(call, false);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(call->e, node) || call->failed)
        return node;
    const csg_warp warp = {.kind = CSG_WARP_BEND, .parameters = {radius}};
    return warped(call, &warp, node);
}
