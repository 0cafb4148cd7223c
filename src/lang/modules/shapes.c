/* SPDX-License-Identifier: MIT
 * What the modules of shapes share: from outlines and triangles to nodes, and children that are
 * figures of the plane or solids. As in OpenSCAD the first child's dimension rules among children
 * of one operation; the others are left out with a warning.
 */
#include "lang/modules/shapes.h"

#include <math.h>
#include <stdio.h>

#include "base/scene_codes.h"
#include "lang/services.h"
#include "shape/plane/crossings.h"
#include "solid/measure.h"

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

/* ---- jobs ------------------------------------------------------------------------------------ */

csg_facet_rule csg_facet_rule_now(const csg_eval *e)
{
    const csg_symbol names[3] = {e->symbol_fn, e->symbol_fa, e->symbol_fs};
    double numbers[3] = {0, 12, 2};
    for (int i = 0; i < 3; i++) {
        csg_value value = csg_eval_dynamic(e, names[i]);
        if (value.kind == CSG_VALUE_NUMBER && isfinite(value.as.number))
            numbers[i] = value.as.number;
    }
    return (csg_facet_rule){numbers[0], numbers[1], numbers[2], e->program->exact_facets};
}

csg_solid_job csg_shape_job(csg_module_call *call)
{
    csg_eval *e = call->e;
    uint64_t most = e->context->limits.eval_steps;
    const csg_symbol_entry *blend = &e->program->symbols.entries[e->symbol_blend];
    /* what is found out about blends depends on all solids around them */
    bool sees_all = blend->variable || blend->called || e->asking > 0;
    return (csg_solid_job){
        .builder = &e->builder,
        .memory = e->heap.memory,
        .where = call->statement->where,
        .tessellate = e->program->services ? e->program->services->tessellate : NULL,
        .sketches = e->program->options && e->program->options->only_check && !sees_all,
        .most_steps = most > e->steps ? most - e->steps : 0,
        .deadline_s = e->program->deadline_s,
        .stop = e->stop,
        .failed = call->failed};
}

static void tell_of_failure(csg_module_call *call, const csg_solid_reason *reason)
{
    if (reason->status == CSGM_ERR_LIMIT)
        csg_eval_report(call->e, CSG_DIAG_BAD_SHAPE, call->statement->where,
                        "fewer points, or fewer parts on top of each other, are quicker",
                        "%s(): cannot %s: its outline crosses itself more than %d times, or too "
                        "many of its edges lie side by side",
                        call->name, reason->what, CSG_MOST_CROSSINGS);
    else
        csg_eval_report(call->e, CSG_DIAG_BAD_SHAPE, call->statement->where,
                        reason->status == CSGM_ERR_UNSUPPORTED
                            ? "the library for it was missing when this "
                              "program was built: see csgmesh --version"
                            : NULL,
                        "%s(): cannot %s", call->name, reason->what);
}

static void tell_reason(csg_module_call *call, const csg_solid_reason *reason)
{
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    switch (reason->fault) {
    case CSG_SOLID_FAILED:
        tell_of_failure(call, reason);
        break;
    case CSG_SOLID_UNBOUNDED:
        csg_eval_report(e, CSG_DIAG_NOT_EXACT, where, "cut it first, by an intersection with a box",
                        "%s() of a solid without bounds", call->name);
        break;
    case CSG_SOLID_NO_SURFACE:
        csg_eval_report(e, CSG_DIAG_EMPTY_SHAPE, where, NULL,
                        "%s() of a solid without a surface is nothing", call->name);
        break;
    case CSG_SOLID_NO_AREA:
        csg_eval_report(e, CSG_DIAG_EMPTY_SHAPE, where, NULL, "%s() has no area", call->name);
        break;
    case CSG_SOLID_NO_TRIANGLES:
        csg_eval_report(e, CSG_DIAG_EMPTY_SHAPE, where, NULL, "%s() has no triangles", call->name);
        break;
    case CSG_SOLID_NO_VOLUME:
        csg_eval_report(e, CSG_DIAG_NOTHING_ENCLOSED, where, NULL,
                        "the triangles of %s() enclose nothing: it is left out", call->name);
        break;
    case CSG_SOLID_NO_SUM:
        csg_eval_report(e, CSG_DIAG_NOT_EXACT, where, reason->hint,
                        "%s(): the sum of %s cannot be computed", call->name, reason->what);
        break;
    case CSG_SOLID_CROSSES_AXIS:
        csg_eval_report(
            e, CSG_DIAG_CROSSES_AXIS, where, "move it to one side: translate([r, 0])",
            "%s(): the figure reaches from x = %g to x = %g, over the axis it turns about%s",
            call->name, reason->range[0], reason->range[1],
            csg_eval_is_lenient(e, CSG_DIAG_CROSSES_AXIS, where) ? "; it is left out" : "");
        break;
    case CSG_SOLID_BAD_NODE:
        csg_eval_report(e, CSG_DIAG_BAD_SOLID, where, NULL, "%s", reason->problem);
        break;
    case CSG_SOLID_FAULT_COUNT:
        break;
    }
}

csg_node_id csg_shape_made(csg_module_call *call, const csg_solid_job *job, csg_node_id node)
{
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    for (uint32_t i = 0; i < job->reason_count; i++)
        tell_reason(call, &job->reasons[i]);
    call->failed = call->failed || job->failed;
    csg_eval_charge(e, job->steps, where); /* tells what limit the job came to, if one */
    if (job->stop && job->status == CSGM_ERR_MEMORY)
        csg_eval_no_memory_at(e, where);
    if (job->stop && !e->stop && e->builder.status != CSGM_OK)
        csg_check_node(e, CSG_NODE_NONE, where);
    if (job->stop && !e->stop)
        csg_eval_check_time(e, where);
    return e->stop ? CSG_NODE_NONE : node;
}

/* ---- outlines and triangles ------------------------------------------------------------------ */

csg_node_id csg_shape_region(csg_module_call *call, csg_outline *clean)
{
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = csg_solid_region(&job, clean);
    return csg_shape_made(call, &job, node);
}

csg_node_id csg_shape_area(csg_module_call *call, csg_outline *outline, bool even_odd)
{
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = csg_solid_area(&job, outline, even_odd);
    return csg_shape_made(call, &job, node);
}

csg_node_id csg_shape_solid(csg_module_call *call, csg_triangles *triangles, bool told)
{
    csg_solid_job job = csg_shape_job(call);
    csg_repairs repairs = {0};
    char text[256];
    csg_node_id node = csg_solid_of_triangles(&job, triangles, &repairs);
    node = csg_shape_made(call, &job, node);
    if (told && !job.reason_count && node != CSG_NODE_NONE && csg_repairs_are_any(&repairs)) {
        csg_repairs_describe(&repairs, text, sizeof text);
        csg_eval_report(call->e, CSG_DIAG_MENDED, call->statement->where, NULL,
                        "%s(): the surface was mended: %s", call->name, text);
    }
    return node;
}

bool csg_shape_box(csg_module_call *call, csg_node_id node, csg_box *out)
{
    csg_solid_job job = csg_shape_job(call);
    csgm_status status = csg_tight_box(&job, node, out);
    if (status != CSGM_OK)
        csg_solid_failed(&job, status, "measure this solid");
    csg_shape_made(call, &job, node);
    return status == CSGM_OK && !call->e->stop;
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
    double pair[2];
    if (!csg_has_argument(call, index))
        return true;
    if (value.kind == CSG_VALUE_NUMBER) {
        out[0] = out[1] = value.as.number;
    } else if (csg_value_numbers(value, 2, pair)) {
        out[0] = pair[0];
        out[1] = pair[1];
    } else {
        return csg_argument_mishap(call, index, CSG_DIAG_BAD_TYPE, "the default is taken",
                                   "%s must be a number or [x, y]", call->parameters[index].name);
    }
    if (isfinite(out[0]) && isfinite(out[1]))
        return true;
    csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE, "%s is not finite",
                       call->parameters[index].name);
    return false;
}

/* ---- children -------------------------------------------------------------------------------- */

static void tell_of_unlike(csg_module_call *call, bool flat, size_t dropped, size_t left)
{
    const char *hint = flat ? "projection() makes a figure of a solid"
                            : "linear_extrude() makes a solid of a figure";
    csg_span where = call->statement->where;
    if (left == 0)
        csg_eval_report(
            call->e, CSG_DIAG_WRONG_DIMENSION, where, hint, "%s() needs %s, not %s%s", call->name,
            flat ? "flat figures" : "solids", flat ? "solids" : "flat figures",
            csg_eval_is_lenient(call->e, CSG_DIAG_WRONG_DIMENSION, where) ? "; they are left out"
                                                                          : "");
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
    size_t dropped = csg_parts_drop_unlike(e, first, flat);
    if (dropped)
        tell_of_unlike(call, flat, dropped, e->part_count - first);
    return first;
}

csg_node_id csg_shape_children(csg_module_call *call, bool flat)
{
    size_t first = csg_shape_operands(call, flat, false);
    return csg_join_parts(call->e, first, CSG_NODE_UNION, CSG_SHARP, call->statement->where);
}
