/* SPDX-License-Identifier: MIT
 * The hull of a node, by what it is made of (pieces.h):
 *   balls, capsules, rounded boxes, corners, all rounded by one radius: the polyhedron around their
 *   centres, grown by it: exact;
 *   prisms along z over the same heights: the flat hull, extruded: exact where that is;
 *   else a polyhedron whose corners lie on the true hull, within 1e-4 of its size.
 * Pieces that can only be sampled (differences, intersections, blends) give the vertices of their
 * tessellation, which cuts their edges by up to a cell.
 */
#include <math.h>

#include "solid/measure.h"
#include "solid/operations.h"
#include "solid/pieces.h"

static const double tolerance = 1e-4, flat_tolerance = 1e-5; /* of the size */

/* The hull of prisms that begin and end at the same heights; *done tells whether they do. */
static csg_node_id hull_of_prisms(csg_solid_job *job, const csg_solid_pieces *pieces, double size,
                                  bool *done)
{
    csg_solid_pieces figures;
    csg_cloud cloud;
    double heights[2], first[2] = {0, 0}, slack = 1e-9 * size;
    csgm_status status = CSGM_OK;
    csg_node_id node = CSG_NODE_NONE;
    csg_pieces_init(&figures, job->memory);
    csg_cloud_init(&cloud, job->memory);
    *done = pieces->count > 0;
    for (size_t i = 0; i < pieces->count && *done; i++) {
        *done = csg_piece_prism(job, &pieces->items[i], &figures, heights);
        if (i == 0) {
            first[0] = heights[0];
            first[1] = heights[1];
        }
        *done =
            *done && fabs(heights[0] - first[0]) <= slack && fabs(heights[1] - first[1]) <= slack;
    }
    for (size_t i = 0; i < figures.count && *done && status == CSGM_OK; i++)
        status = csg_piece_cloud(job, &figures.items[i], flat_tolerance * size, &cloud);
    if (*done && status == CSGM_OK && !job->stop)
        node = csg_cloud_hull_flat(job, &cloud, flat_tolerance * size);
    else if (*done && !job->stop)
        node = csg_solid_failed(job, status, "make this hull");
    if (*done && node != CSG_NODE_NONE)
        node = csg_solid_done(
            job, csg_build_extrude(job->builder, node, first[0], first[1], job->where));
    csg_pieces_release(&figures);
    csg_cloud_release(&cloud);
    return node;
}

static csg_node_id hull_of_pieces(csg_solid_job *job, const csg_solid_pieces *pieces, double size,
                                  bool flat)
{
    bool done = false;
    csg_node_id node = flat ? CSG_NODE_NONE : hull_of_prisms(job, pieces, size, &done);
    if (done || job->stop)
        return node;
    csg_cloud cloud;
    csgm_status status = CSGM_OK;
    double within = size * (flat ? flat_tolerance : tolerance);
    csg_cloud_init(&cloud, job->memory);
    for (size_t i = 0; i < pieces->count && status == CSGM_OK; i++)
        status = csg_piece_cloud(job, &pieces->items[i], within, &cloud);
    if (status != CSGM_OK)
        node = csg_solid_failed(job, status, "make this hull");
    else
        node =
            flat ? csg_cloud_hull_flat(job, &cloud, within) : csg_cloud_hull(job, &cloud, within);
    csg_cloud_release(&cloud);
    return node;
}

csg_node_id csg_solid_hull(csg_solid_job *job, csg_node_id all)
{
    double size;
    if (csg_solid_is_empty(job, all))
        return all;
    if (!csg_finite_size(job, all, &size))
        return csg_solid_empty(job);
    csg_solid_pieces pieces;
    csg_node_id node = CSG_NODE_NONE;
    if (!csg_solid_is_flat(job, all) &&
        csg_solid_sketch(job, csg_build_box(job->builder, all), &node))
        return node;
    csg_pieces_init(&pieces, job->memory);
    if (csg_pieces_collect(job->builder->scene, all, &pieces))
        node = hull_of_pieces(job, &pieces, size, csg_solid_is_flat(job, all));
    else
        csg_solid_no_memory(job);
    csg_pieces_release(&pieces);
    return node;
}
