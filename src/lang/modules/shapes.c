/* SPDX-License-Identifier: MIT
 * What the modules of shapes share: from outlines and triangles to nodes, and children that are
 * figures of the plane or solids. As in OpenSCAD the first child's dimension rules among children
 * of one operation; the others are left out with a warning.
 */
#include "lang/modules/shapes.h"

#include <math.h>
#include <stdio.h>

#include "shape/plane/crossings.h"
#include "shape/plane/polygons.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

/* ---- nodes ----------------------------------------------------------------------------------- */

csg_node_id csg_shape_done(csg_module_call *call, csg_node_id node)
{
    return csg_check_node(call->e, node, call->statement->where);
}

csg_node_id csg_shape_empty(csg_module_call *call)
{
    if (call->e->stop)
        return CSG_NODE_NONE;
    return csg_shape_done(call, csg_build_empty(&call->e->builder, call->statement->where));
}

csg_node_id csg_shape_moved(csg_module_call *call, csg_node_id node, const csg_affine *by)
{
    if (node == CSG_NODE_NONE || call->e->stop)
        return CSG_NODE_NONE;
    return csg_shape_done(call,
                          csg_build_transform(&call->e->builder, by, node, call->statement->where));
}

csg_node_id csg_shape_failed(csg_module_call *call, csgm_status status, const char *what)
{
    csg_eval *e = call->e;
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(e);
    if (e->stop)
        return CSG_NODE_NONE;
    if (call->failed) /* told already */
        return csg_shape_empty(call);
    if (status == CSGM_ERR_LIMIT) {
        csg_eval_report(e, CSG_DIAG_BAD_SHAPE, call->statement->where,
                        "fewer points, or fewer parts on top of each other, are quicker",
                        "%s(): cannot %s: its outline crosses itself more than %d times, or too "
                        "many of its edges lie side by side",
                        call->name, what, CSG_MOST_CROSSINGS);
        return csg_shape_empty(call);
    }
    csg_eval_report(e, CSG_DIAG_BAD_SHAPE, call->statement->where,
                    status == CSGM_ERR_UNSUPPORTED ? "the library for it was missing when this "
                                                     "program was built: see csgmesh --version"
                                                   : NULL,
                    "%s(): cannot %s", call->name, what);
    return csg_shape_empty(call);
}

static csg_node_id nothing(csg_module_call *call, const char *what)
{
    csg_eval_report(call->e, CSG_DIAG_EMPTY_SHAPE, call->statement->where, NULL, "%s() has no %s",
                    call->name, what);
    return csg_shape_empty(call);
}

csg_node_id csg_shape_region(csg_module_call *call, csg_outline *clean)
{
    csg_eval *e = call->e;
    csg_shape *shape = NULL;
    size_t loops = clean->loop_count;
    csgm_status status = loops && csg_eval_check_time(e, call->statement->where)
                             ? csg_region_create(e->heap.memory, clean, &shape)
                             : CSGM_OK;
    csg_outline_release(clean);
    if (e->stop)
        return CSG_NODE_NONE;
    if (status != CSGM_OK)
        return csg_shape_failed(call, status, "make a region of this outline");
    if (!shape)
        return nothing(call, "area");
    return csg_shape_done(call, csg_build_shape(&e->builder, shape, call->statement->where));
}

csg_node_id csg_shape_area(csg_module_call *call, csg_outline *outline, bool even_odd)
{
    csg_outline clean;
    csgm_status status =
        csg_polygons_clean(outline, even_odd ? CSG_FILL_EVEN_ODD : CSG_FILL_NONZERO, &clean);
    csg_outline_release(outline);
    if (status != CSGM_OK)
        return csg_shape_failed(call, status, "make a clean figure of this outline");
    return csg_shape_region(call, &clean);
}

/* "3 holes filled, 2 triangles turned over". */
static void describe(const csg_repairs *repairs, char *text, size_t size)
{
    const struct {
        size_t count;
        const char *one, *many;
    } rows[] = {
        {repairs->holes, "hole filled", "holes filled"},
        {repairs->flipped, "triangle turned over", "triangles turned over"},
        {repairs->nonmanifold, "edge of more than two triangles",
         "edges of more than two triangles"},
        {repairs->duplicate, "triangle twice", "triangles twice"},
        {repairs->degenerate, "triangle without area left out", "triangles without area left out"},
    };
    size_t at = 0;
    text[0] = '\0';
    for (size_t i = 0; i < sizeof rows / sizeof *rows && at < size; i++)
        if (rows[i].count)
            at += (size_t)snprintf(text + at, size - at, "%s%zu %s", at ? ", " : "", rows[i].count,
                                   rows[i].count == 1 ? rows[i].one : rows[i].many);
    if (repairs->overlapping && at < size)
        snprintf(text + at, size - at, "%s",
                 at ? ", and it overlaps itself" : "it overlaps itself");
}

static bool is_mended(const csg_repairs *repairs)
{
    return repairs->holes || repairs->flipped || repairs->nonmanifold || repairs->duplicate ||
           repairs->overlapping;
}

csg_node_id csg_shape_solid(csg_module_call *call, csg_triangles *triangles, bool told)
{
    csg_eval *e = call->e;
    csg_shape *shape = NULL;
    csg_repairs repairs = {0};
    char text[256];
    csgm_status status = !csg_eval_check_time(e, call->statement->where)
                             ? CSGM_OK
                             : csg_polyhedron_create(e->heap.memory, triangles, &repairs, &shape);
    csg_triangles_release(triangles);
    if (e->stop)
        return CSG_NODE_NONE;
    if (status == CSGM_ERR_SCENE)
        return nothing(call, "triangles that enclose anything");
    if (status != CSGM_OK)
        return csg_shape_failed(call, status, "make a solid of these triangles");
    if (told && is_mended(&repairs)) {
        describe(&repairs, text, sizeof text);
        csg_eval_report(e, CSG_DIAG_MENDED, call->statement->where, NULL,
                        "%s(): the surface was mended: %s", call->name, text);
    }
    return csg_shape_done(call, csg_build_shape(&e->builder, shape, call->statement->where));
}

/* ---- arguments ------------------------------------------------------------------------------- */

double csg_argument_radius(csg_module_call *call, uint32_t r, uint32_t d, double otherwise,
                           csg_range_kind range)
{
    if (!csg_has_argument(call, d))
        return csg_argument_number(call, r, otherwise, range);
    if (csg_has_argument(call, r))
        csg_eval_report(call->e, CSG_DIAG_CONFLICT, call->spans[r], NULL,
                        "%s() gets a radius and a diameter, the diameter holds", call->name);
    return csg_argument_number(call, d, 2 * otherwise, range) / 2;
}

bool csg_argument_pair(csg_module_call *call, uint32_t index, double out[2])
{
    csg_value value = call->values[index];
    if (!csg_has_argument(call, index))
        return true;
    if (value.kind == CSG_VALUE_NUMBER)
        out[0] = out[1] = value.as.number;
    else if (!csg_value_numbers(value, 2, out)) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "%s must be a number or [x, y]",
                           call->parameters[index].name);
        return false;
    }
    if (isfinite(out[0]) && isfinite(out[1]))
        return true;
    csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE, "%s is not finite",
                       call->parameters[index].name);
    return false;
}

/* ---- children -------------------------------------------------------------------------------- */

bool csg_shape_is_empty(const csg_eval *e, csg_node_id node)
{
    return e->builder.scene->nodes[node].kind == CSG_NODE_EMPTY;
}

bool csg_shape_is_flat(const csg_eval *e, csg_node_id node)
{
    return !csg_shape_is_empty(e, node) && csg_build_is_flat(&e->builder, node);
}

/* Takes the parts of the other dimension off; how many. Empty solids go with either. */
static size_t drop_unlike(csg_eval *e, size_t first, bool flat)
{
    size_t kept = first, count = e->part_count;
    for (size_t i = first; i < count; i++)
        if (csg_shape_is_empty(e, e->parts[i].node) ||
            csg_shape_is_flat(e, e->parts[i].node) == flat)
            e->parts[kept++] = e->parts[i];
    e->part_count = kept;
    return count - kept;
}

void csg_shape_keep_alike(csg_eval *e, size_t first, csg_span where)
{
    size_t i = first;
    while (i < e->part_count && csg_shape_is_empty(e, e->parts[i].node))
        i++;
    if (e->stop || i == e->part_count)
        return;
    bool flat = csg_shape_is_flat(e, e->parts[i].node);
    size_t dropped = drop_unlike(e, first, flat);
    if (dropped)
        csg_eval_report(e, CSG_DIAG_MIXED_DIMENSIONS, where,
                        flat ? "linear_extrude makes a solid of a figure"
                             : "projection makes a figure of a solid",
                        "%s and %s side by side: the first rules, %zu %s left out",
                        flat ? "a flat figure" : "a solid", flat ? "solids" : "flat figures",
                        dropped, dropped == 1 ? "operand is" : "operands are");
}

static void tell_of_unlike(csg_module_call *call, bool flat, size_t dropped, size_t left)
{
    const char *hint = flat ? "projection() makes a figure of a solid"
                            : "linear_extrude() makes a solid of a figure";
    csg_span where = call->statement->where;
    if (left == 0)
        csg_eval_report(call->e, CSG_DIAG_WRONG_DIMENSION, where, hint, "%s() needs %s, not %s",
                        call->name, flat ? "flat figures" : "solids",
                        flat ? "solids" : "flat figures");
    else
        csg_eval_report(call->e, CSG_DIAG_MIXED_DIMENSIONS, where, hint,
                        "%s() takes %s: %zu of its children %s left out", call->name,
                        flat ? "flat figures" : "solids", dropped, dropped == 1 ? "is" : "are");
}

size_t csg_shape_operands(csg_module_call *call, bool flat, bool each)
{
    csg_eval *e = call->e;
    size_t first = e->part_count;
    csg_run_scope(e, call->statement->children, call->frame, !each);
    if (e->stop)
        return first;
    size_t dropped = drop_unlike(e, first, flat);
    if (dropped)
        tell_of_unlike(call, flat, dropped, e->part_count - first);
    return first;
}

csg_node_id csg_shape_children(csg_module_call *call, bool flat)
{
    size_t first = csg_shape_operands(call, flat, false);
    return csg_join_parts(call->e, first, CSG_NODE_UNION, (csg_blend){CSG_BLEND_SHARP, 0},
                          call->statement->where);
}

csg_node_id csg_shape_of_scene(csg_eval *e, csg_node_id node, csg_span where)
{
    if (node == CSG_NODE_NONE || e->stop || !csg_shape_is_flat(e, node))
        return node;
    csg_eval_report(e, CSG_DIAG_FLAT_SCENE, where, "linear_extrude(height) gives it one",
                    "the scene is a flat figure: it gets a thickness of 1");
    return csg_check_node(e, csg_build_extrude(&e->builder, node, -0.5, 0.5, where), where);
}
