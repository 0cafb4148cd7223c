/* SPDX-License-Identifier: MIT
 * Flat figures: circle, square, polygon; offset and fill of what is flat.
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "scene/primitives/kinds.h"
#include "shape/plane/polygons.h"

csg_node_id csg_module_circle(csg_module_call *call)
{
    enum { R, D };
    csg_eval *e = call->e;
    double r = csg_argument_radius(call, R, D, 1, CSG_SIZE);
    if (call->failed)
        return csg_shape_empty(call);
    const csg_facet_rule rule = csg_facet_rule_now(e);
    uint32_t facets = csg_facets(&rule, r);
    if (facets) {
        csg_solid_job job = csg_shape_job(call);
        return csg_shape_made(call, &job, csg_faceted_circle(&job, r, facets));
    }
    return csg_shape_done(
        call, csg_build_primitive(&e->builder, CSG_NODE_CIRCLE, &r, call->statement->where));
}

csg_node_id csg_module_square(csg_module_call *call)
{
    enum { SIZE, CENTER, ROUND };
    csg_eval *e = call->e;
    double size[2] = {1, 1};
    bool known = csg_argument_pair(call, SIZE, size);
    double smallest = fmin(size[0], size[1]);
    if (known && !(smallest > 0))
        csg_argument_error(call, SIZE, CSG_DIAG_EMPTY_SHAPE,
                           "an edge of length %g makes no figure, it must be above 0", smallest);
    double round = csg_argument_rounding(call, ROUND, smallest);
    if (call->failed)
        return csg_shape_empty(call);
    const double half[3] = {size[0] / 2, size[1] / 2, round};
    csg_node_id node = csg_shape_done(
        call, csg_build_primitive(&e->builder, CSG_NODE_RECTANGLE, half, call->statement->where));
    if (csg_argument_boolean(call, CENTER))
        return node;
    csg_affine by = csg_affine_translate(csg_vec3_make(half[0], half[1], 0));
    return csg_shape_moved(call, node, &by);
}

/* ---- polygon --------------------------------------------------------------------------------- */

static bool read_point(csg_module_call *call, uint32_t index, csg_value value, uint32_t number,
                       csg_vec2 *out)
{
    double v[3];
    bool known = csg_value_numbers(value, 2, v) || csg_value_numbers(value, 3, v);
    if (known && isfinite(v[0]) && isfinite(v[1])) {
        *out = (csg_vec2){v[0], v[1]};
        return true;
    }
    csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "%s[%u] is not [x, y]",
                       call->parameters[index].name, number);
    return false;
}

/* One loop: the points with these indices, or all of them. */
static bool add_path(csg_module_call *call, uint32_t index, csg_vector *points, csg_value path,
                     bool all, csg_outline *out)
{
    uint32_t count = all ? points->count : path.as.vector->count;
    for (uint32_t i = 0; i < count; i++) {
        double at = i;
        csg_vec2 point;
        if (!all && path.as.vector->items[i].kind == CSG_VALUE_NUMBER)
            at = trunc(path.as.vector->items[i].as.number);
        else if (!all)
            at = NAN;
        if (!(at >= 0 && at < points->count)) {
            if (csg_argument_mishap(
                    call, index, CSG_DIAG_BAD_POINTS, "such corners of the paths are left out",
                    "a path names point %g, there are points 0 to %d", at, (int)points->count - 1))
                continue;
            return false;
        }
        if (!read_point(call, 0, points->items[(uint32_t)at], (uint32_t)at, &point))
            return false;
        if (!csg_outline_add(out, point)) {
            csg_eval_no_memory(call->e);
            return false;
        }
    }
    if (!csg_outline_close(out))
        csg_eval_no_memory(call->e);
    return true;
}

static bool add_paths(csg_module_call *call, uint32_t index, csg_vector *points, csg_outline *out)
{
    csg_value paths = call->values[index];
    if (!csg_has_argument(call, index))
        return add_path(call, index, points, paths, true, out);
    if (paths.kind != CSG_VALUE_VECTOR)
        return csg_argument_mishap(call, index, CSG_DIAG_BAD_TYPE, "all points are one path",
                                   "paths must be lists of indices") &&
               add_path(call, index, points, paths, true, out);
    const csg_vector *list = paths.as.vector;
    if (list->count && list->items[0].kind == CSG_VALUE_NUMBER)
        return add_path(call, index, points, paths, false, out);
    for (uint32_t i = 0; i < list->count; i++) {
        if (list->items[i].kind != CSG_VALUE_VECTOR) {
            if (csg_argument_mishap(call, index, CSG_DIAG_BAD_TYPE, "such paths are left out",
                                    "paths[%u] is no list of indices", i))
                continue;
            return false;
        }
        if (!add_path(call, index, points, list->items[i], false, out))
            return false;
    }
    return true;
}

/* As the scene says it is clean; a search in what is not at all would be too slow. */
static csg_node_id clean_region(csg_module_call *call, csg_outline *outline)
{
    csgm_status status = csg_polygons_check(outline);
    if (status == CSGM_OK)
        return csg_shape_region(call, outline);
    csg_outline_release(outline);
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job,
                          csg_solid_failed(&job, status, "make a figure of this outline"));
}

csg_node_id csg_module_polygon(csg_module_call *call)
{
    enum { POINTS, PATHS, CONVEXITY, CLEAN };
    csg_outline outline;
    csg_outline_init(&outline, call->e->heap.memory);
    if (call->values[POINTS].kind != CSG_VALUE_VECTOR)
        csg_argument_error(call, POINTS, CSG_DIAG_BAD_TYPE, "points must be a list of [x, y]");
    else
        add_paths(call, PATHS, call->values[POINTS].as.vector, &outline);
    bool clean = csg_argument_boolean(call, CLEAN);
    if (!call->failed && !call->e->stop)
        return clean ? clean_region(call, &outline) : csg_shape_area(call, &outline, true);
    csg_outline_release(&outline);
    return csg_shape_empty(call);
}

/* ---- offset ---------------------------------------------------------------------------------- */

csg_node_id csg_module_offset(csg_module_call *call)
{
    enum { R, DELTA, CHAMFER };
    bool sharp = csg_has_argument(call, DELTA) && !csg_has_argument(call, R);
    double by = csg_argument_number(call, sharp ? DELTA : R, 1, CSG_ANY);
    csg_node_id child = csg_shape_children(call, true);
    if (call->failed || child == CSG_NODE_NONE || csg_eval_is_empty(call->e, child) || by == 0)
        return child;
    csg_corner corner = csg_argument_boolean(call, CHAMFER) ? CSG_CORNER_CHAMFER : CSG_CORNER_MITER;
    const csg_facet_rule rule = csg_facet_rule_now(call->e);
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = sharp ? csg_solid_offset_sharp(&job, child, by, corner, 0)
                             : csg_solid_offset_round(&job, &rule, child, by);
    return csg_shape_made(call, &job, node);
}

csg_node_id csg_module_fill(csg_module_call *call)
{
    csg_node_id child = csg_shape_children(call, true);
    if (child == CSG_NODE_NONE || csg_eval_is_empty(call->e, child))
        return child;
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_fill(&job, child));
}
