/* SPDX-License-Identifier: MIT
 * hull, minkowski, projection and the periodic surfaces: what they act on, and their few arguments
 * (solid/ has the rest).
 */
#include "lang/modules/shapes.h"
#include "scene/warp_kinds.h"
#include "solid/operations.h"

/* Children of the first one's dimension, united. */
csg_node_id csg_module_hull(csg_module_call *call)
{
    csg_node_id all = csg_module_children(call);
    if (all == CSG_NODE_NONE || call->e->stop)
        return all;
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_hull(&job, all));
}

csg_node_id csg_module_minkowski(csg_module_call *call)
{
    csg_eval *e = call->e;
    size_t first = e->part_count;
    csg_run_scope(e, call->statement->children, call->frame, false);
    if (e->stop)
        return CSG_NODE_NONE;
    csg_parts_drop_regions(e, first, "minkowski()");
    csg_parts_keep_alike(e, first, call->statement->where);
    if (e->part_count == first)
        return csg_shape_empty(call);
    csg_solid_job job = csg_shape_job(call);
    csg_node_id node = e->parts[first].node;
    for (size_t i = first + 1; i < e->part_count && node != CSG_NODE_NONE && !job.stop; i++)
        node = csg_solid_minkowski(&job, node, e->parts[i].node);
    e->part_count = first;
    return csg_shape_made(call, &job, node);
}

/* The cut of solids with the plane z = 0 is a warp. */
csg_node_id csg_module_projection(csg_module_call *call)
{
    enum { CUT };
    csg_eval *e = call->e;
    const csg_warp slice = {.kind = CSG_WARP_SLICE};
    csg_node_id solid = csg_shape_children(call, false);
    if (solid == CSG_NODE_NONE || e->stop || csg_eval_is_empty(e, solid))
        return solid;
    if (csg_argument_boolean(call, CUT))
        return csg_shape_done(call,
                              csg_build_warp(&e->builder, &slice, solid, call->statement->where));
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_shadow(&job, solid));
}

static csg_node_id periodic_wall(csg_module_call *call, csg_periodic_kind kind)
{
    enum { CELL, THICKNESS };
    double cell = csg_argument_number(call, CELL, 1, CSG_POSITIVE);
    double thickness = csg_argument_number(call, THICKNESS, cell / 10, CSG_NOT_NEGATIVE);
    if (call->failed)
        return csg_shape_empty(call);
    csg_solid_job job = csg_shape_job(call);
    return csg_shape_made(call, &job, csg_solid_periodic(&job, kind, cell, thickness));
}

csg_node_id csg_module_gyroid(csg_module_call *call)
{
    return periodic_wall(call, CSG_PERIODIC_GYROID);
}

csg_node_id csg_module_schwarz_p(csg_module_call *call)
{
    return periodic_wall(call, CSG_PERIODIC_SCHWARZ_P);
}

csg_node_id csg_module_diamond(csg_module_call *call)
{
    return periodic_wall(call, CSG_PERIODIC_DIAMOND);
}
