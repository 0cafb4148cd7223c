/* SPDX-License-Identifier: MIT
 * Offsets of flat figures. Where the field of a figure is no exact distance on the side that an
 * offset needs (inside a union, outside an intersection, or an offset of an offset), the figure is
 * made polygons first.
 */
#include <math.h>

#include "shape/plane/polygons.h"
#include "solid/measure.h"
#include "solid/operations.h"

csg_node_id csg_solid_offset_sharp(csg_solid_job *job, csg_node_id child, double by,
                                   csg_corner corner, double tolerance)
{
    csg_outline outline, grown;
    csgm_status status = csg_flat_outline(job, child, &outline);
    if (status == CSGM_OK) {
        status = csg_polygons_offset(&outline, by, corner, tolerance, &grown);
        csg_outline_release(&outline);
    }
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "offset this figure");
    return csg_solid_region(job, &grown);
}

csg_node_id csg_solid_offset_round(csg_solid_job *job, const csg_facet_rule *rule,
                                   csg_node_id child, double r)
{
    uint32_t facets = csg_facets(rule, r);
    if (facets)
        return csg_solid_offset_sharp(job, child, r, CSG_CORNER_ROUND,
                                      fabs(r) * (1 - csg_cosine_deg(180.0 / facets)));
    if (!csg_distance_is_exact(job, child, r > 0)) {
        csg_outline outline;
        csgm_status status = csg_flat_outline(job, child, &outline);
        if (status != CSGM_OK)
            return csg_solid_failed(job, status, "make polygons of this figure");
        child = csg_solid_region(job, &outline);
    }
    if (child == CSG_NODE_NONE || csg_solid_is_empty(job, child))
        return child;
    return csg_solid_done(job, csg_build_offset(job->builder, r, child, job->where));
}
