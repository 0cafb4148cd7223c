/* SPDX-License-Identifier: MIT
 * Modules that make one node each, so that every tree that csgmesh dump prints parses back: slab,
 * extrude, warp.
 */
#include <math.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "scene/primitives/kinds.h"
#include "scene/warp_kinds.h"

csg_node_id csg_module_slab(csg_module_call *call)
{
    double half = csg_argument_number(call, 0, 1, CSG_POSITIVE);
    if (call->failed)
        return csg_shape_empty(call);
    return csg_shape_done(
        call, csg_build_primitive(&call->e->builder, CSG_NODE_SLAB, &half, call->statement->where));
}

csg_node_id csg_module_extrude(csg_module_call *call)
{
    enum { HALF, MIDDLE };
    csg_eval *e = call->e;
    double half = csg_argument_number(call, HALF, 1, CSG_POSITIVE);
    double middle = csg_argument_number(call, MIDDLE, 0, CSG_ANY);
    csg_node_id node = csg_shape_children(call, true);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node))
        return node;
    if (call->failed)
        return csg_shape_empty(call);
    return csg_shape_done(call,
                          csg_build_plate(&e->builder, node, half, middle, call->statement->where));
}

/* The kind that the argument names; COUNT after a report. */
static csg_warp_kind warp_kind(csg_module_call *call, uint32_t index)
{
    csg_value name = call->values[index];
    csg_warp_kind kind = CSG_WARP_COUNT;
    if (name.kind == CSG_VALUE_STRING)
        for (kind = 0; kind < CSG_WARP_COUNT; kind++)
            if (strcmp(name.as.string->text, csg_warp_name(kind)) == 0)
                break;
    if (kind == CSG_WARP_COUNT)
        csg_argument_error(
            call, index, CSG_DIAG_BAD_TYPE,
            "kind must be \"revolve\", \"slice\", \"twist\", \"taper\", \"bend\" or \"elbow\"");
    return kind;
}

csg_node_id csg_module_warp(csg_module_call *call)
{
    enum { KIND, PARAMETERS };
    csg_eval *e = call->e;
    csg_warp_kind kind = warp_kind(call, KIND);
    csg_warp warp = {.kind = (uint8_t)kind};
    uint32_t given = kind < CSG_WARP_COUNT ? csg_warp_given(kind) : 0;
    if (given && !csg_value_numbers(call->values[PARAMETERS], given, warp.parameters))
        csg_argument_error(call, PARAMETERS, CSG_DIAG_BAD_TYPE, "a %s has %u numbers",
                           csg_warp_name(kind), given);
    csg_node_id node = csg_module_children(call);
    if (node == CSG_NODE_NONE || csg_eval_is_empty(e, node))
        return node;
    if (call->failed)
        return csg_shape_empty(call);
    return csg_shape_done(call,
                          csg_build_bare_warp(&e->builder, &warp, node, call->statement->where));
}
