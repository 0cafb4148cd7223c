/* SPDX-License-Identifier: MIT
 * hull(). By what the children are made of (pieces.h):
 *   balls, capsules, rounded boxes, corners, all rounded by one radius: the polyhedron around their
 *   centres, grown by it: exact;
 *   prisms along z over the same heights: the flat hull, extruded: exact where that is;
 *   else a polyhedron whose corners lie on the true hull, within 1e-4 of its size.
 * Pieces that can only be sampled (differences, intersections, blends) give the vertices of their
 * tessellation, which cuts their edges by up to a cell.
 */
#include <math.h>

#include "lang/modules/pieces.h"

static const double tolerance = 1e-4, flat_tolerance = 1e-5; /* of the size */

/* The hull of prisms that begin and end at the same heights; *done tells whether they do. */
static csg_node_id hull_of_prisms(csg_module_call *call, const csg_pieces *pieces, double size,
                                  bool *done)
{
    csg_eval *e = call->e;
    csg_pieces figures;
    csg_cloud cloud;
    double heights[2], first[2] = {0, 0}, slack = 1e-9 * size;
    csgm_status status = CSGM_OK;
    csg_node_id node = CSG_NODE_NONE;
    csg_pieces_init(&figures, e->heap.memory);
    csg_cloud_init(&cloud, e->heap.memory);
    *done = pieces->count > 0;
    for (size_t i = 0; i < pieces->count && *done; i++) {
        *done = csg_piece_prism(e, &pieces->items[i], &figures, heights);
        if (i == 0) {
            first[0] = heights[0];
            first[1] = heights[1];
        }
        *done =
            *done && fabs(heights[0] - first[0]) <= slack && fabs(heights[1] - first[1]) <= slack;
    }
    for (size_t i = 0; i < figures.count && *done && status == CSGM_OK; i++)
        status = csg_piece_cloud(call, &figures.items[i], flat_tolerance * size, &cloud);
    if (*done && status == CSGM_OK && !e->stop)
        node = csg_cloud_hull_flat(call, &cloud, flat_tolerance * size);
    else if (*done && !e->stop)
        node = csg_shape_failed(call, status, "make this hull");
    if (*done && node != CSG_NODE_NONE)
        node = csg_shape_done(
            call, csg_build_extrude(&e->builder, node, first[0], first[1], call->statement->where));
    csg_pieces_release(&figures);
    csg_cloud_release(&cloud);
    return node;
}

static csg_node_id hull_of_pieces(csg_module_call *call, const csg_pieces *pieces, double size,
                                  bool flat)
{
    csg_eval *e = call->e;
    bool done = false;
    csg_node_id node = flat ? CSG_NODE_NONE : hull_of_prisms(call, pieces, size, &done);
    if (done || e->stop)
        return node;
    csg_cloud cloud;
    csgm_status status = CSGM_OK;
    double within = size * (flat ? flat_tolerance : tolerance);
    csg_cloud_init(&cloud, e->heap.memory);
    for (size_t i = 0; i < pieces->count && status == CSGM_OK; i++)
        status = csg_piece_cloud(call, &pieces->items[i], within, &cloud);
    if (status != CSGM_OK)
        node = csg_shape_failed(call, status, "make this hull");
    else
        node =
            flat ? csg_cloud_hull_flat(call, &cloud, within) : csg_cloud_hull(call, &cloud, within);
    csg_cloud_release(&cloud);
    return node;
}

/* Children of the first one's dimension, united. */
csg_node_id csg_module_hull(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_node_id all = csg_module_children(call);
    double size;
    if (all == CSG_NODE_NONE || e->stop || csg_shape_is_empty(e, all))
        return all;
    if (!csg_finite_size(call, all, &size))
        return csg_shape_empty(call);
    csg_pieces pieces;
    csg_node_id node = CSG_NODE_NONE;
    csg_pieces_init(&pieces, e->heap.memory);
    if (csg_pieces_collect(e, all, &pieces))
        node = hull_of_pieces(call, &pieces, size, csg_shape_is_flat(e, all));
    else
        csg_eval_no_memory(e);
    csg_pieces_release(&pieces);
    return node;
}
