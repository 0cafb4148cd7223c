/* SPDX-License-Identifier: MIT
 * part() and material(): what meshes say of solids beside their shape and colour.
 */
#include "base/scene_codes.h"
#include "lang/modules/modules.h"
#include "lang/modules/shapes.h"
#include "scene/tree/parts.h"

csg_node_id csg_module_part(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    csg_value name = call->values[0];
    if (!csg_has_argument(call, 0) || name.kind != CSG_VALUE_STRING || !name.as.string->length)
        csg_argument_error(call, 0, CSG_DIAG_BAD_TYPE, "a part needs a name: part(\"lid\")");
    csg_node_id children = csg_module_children(call);
    if (call->failed || children == CSG_NODE_NONE || e->stop)
        return children;
    return csg_check_node(e, csg_build_part(&e->builder, name.as.string->text, children, where),
                          where);
}

/* A number from 0 to 1. */
static float share(csg_module_call *call, uint32_t index, double otherwise)
{
    double value = csg_argument_number(call, index, otherwise, CSG_NOT_NEGATIVE);
    if (value > 1)
        csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE, "%s is %g",
                           call->parameters[index].name, value);
    return (float)value;
}

csg_node_id csg_module_material(csg_module_call *call)
{
    enum { METALLIC, ROUGHNESS };
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    csg_look look = {.metallic = share(call, METALLIC, 0),
                     .roughness = share(call, ROUGHNESS, 0.6),
                     .has_material = true};
    csg_node_id children = csg_module_children(call);
    if (call->failed || children == CSG_NODE_NONE || e->stop)
        return children;
    return csg_check_node(e, csg_build_look(&e->builder, &look, children, where), where);
}

/* Names that change nothing are told, once the whole scene is known. */
csgm_status csg_warn_lost_parts(csg_eval *e, const csgm_scene *scene)
{
    csg_parts parts;
    csgm_status status = csg_parts_find(&parts, scene);
    if (status == CSGM_ERR_MEMORY)
        csg_context_no_memory(scene->context);
    for (size_t i = 0; i < parts.lost_count; i++) {
        const csg_node *node = &scene->nodes[parts.lost[i]];
        csg_eval_report(e, CSG_DIAG_PART_LOST, node->where,
                        "a part stands at the top, under unions without blend, transforms, colours "
                        "and materials alone",
                        "the part \"%.60s\" is only an operand here: it gets no mesh of its own",
                        scene->part_names[scene->looks[node->payload].part - 1]);
    }
    csg_parts_reset(&parts);
    return status;
}
