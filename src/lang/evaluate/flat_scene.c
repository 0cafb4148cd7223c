/* SPDX-License-Identifier: MIT
 * A scene that is a figure of the plane: a plate, a drawing, or both (csgm_flat).
 */
#include <math.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "lang/evaluate/evaluator.h"
#include "scene/outlines/draw_layers.h"
#include "scene/outlines/unite.h"

static csgm_flat flat_of(const csg_eval *e)
{
    return e->program->options ? e->program->options->flat : CSGM_FLAT_PLATE;
}

void csg_eval_keep_drawn(csg_eval *e, csg_span where)
{
    bool has_flat = false;
    for (size_t i = 0; i < e->part_count; i++)
        has_flat = has_flat || csg_eval_is_flat(e, e->parts[i].node);
    if (e->stop || !has_flat || e->root != CSG_NODE_NONE || flat_of(e) != CSGM_FLAT_DRAWING)
        return;
    size_t dropped = csg_parts_drop_unlike(e, 0, true);
    if (dropped)
        csg_eval_report(e, CSG_DIAG_MIXED_DIMENSIONS, where, "projection makes a figure of a solid",
                        "only flat figures are drawn: %zu %s left out", dropped,
                        dropped == 1 ? "solid is" : "solids are");
}

static void draw(csg_eval *e, csg_node_id node, csg_span where)
{
    const double fine = 1e-5;
    csg_vec3 size = csg_box_size(csg_build_box(&e->builder, node));
    csgm_status status = CSGM_ERR_SCENE;
    if (isfinite(size.x) && isfinite(size.y))
        status = csg_draw_layers(&e->builder, node, fine * fmax(size.x, size.y), &e->drawing);
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory_at(e, where);
    else if (status == CSGM_ERR_SCENE)
        csg_eval_report(e, CSG_DIAG_NOT_EXACT, where, "cut it first, by an intersection",
                        "the figure has no bounds: it cannot be drawn");
    else if (status != CSGM_OK)
        csg_eval_report(e, CSG_DIAG_BAD_SHAPE, where,
                        status == CSGM_ERR_UNSUPPORTED ? "this program was built without Clipper"
                                                       : NULL,
                        "the figure's outlines cannot be made");
}

csg_node_id csg_eval_plate(csg_eval *e, csg_node_id flat, csg_span where)
{
    csg_node_id node = csg_check_node(e, csg_unite(&e->builder, flat), where);
    if (node == CSG_NODE_NONE)
        return node;
    return csg_check_node(e, csg_build_extrude(&e->builder, node, -0.5, 0.5, where), where);
}

csg_node_id csg_eval_finish_flat(csg_eval *e, csg_node_id node, csg_span where)
{
    csgm_flat flat = flat_of(e);
    if (node == CSG_NODE_NONE || e->stop || csg_eval_is_empty(e, node) || flat == CSGM_FLAT_KEPT)
        return node;
    if (!csg_eval_is_flat(e, node)) {
        if (flat != CSGM_FLAT_PLATE)
            csg_eval_report(e, CSG_DIAG_NOT_FLAT, where, "projection() makes a figure of a solid",
                            "the scene is a solid: only flat figures can be drawn");
        return node;
    }
    if (flat != CSGM_FLAT_PLATE)
        draw(e, node, where);
    if (flat != CSGM_FLAT_DRAWING)
        csg_eval_report(e, CSG_DIAG_FLAT_SCENE, where,
                        "linear_extrude(height) gives it one; -o x.svg, x.dxf or x.pdf draws it",
                        "the scene is a flat figure: it gets a thickness of 1");
    if (e->stop)
        return CSG_NODE_NONE;
    return csg_eval_plate(e, node, where);
}
