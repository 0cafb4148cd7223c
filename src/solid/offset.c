/* SPDX-License-Identifier: MIT
 * Offsets of flat figures, and their holes filled. Where the field of a figure is no exact distance
 * on the side that an offset needs (inside a union, outside an intersection, or an offset of an
 * offset), the figure is made polygons first.
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

/* Twice the area that a loop encloses; of a hole it is below 0. */
static double area_of(const csg_outline *outline, size_t loop)
{
    size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
    const csg_vec2 *p = outline->points;
    double sum = 0;
    for (size_t i = first; i < end; i++) {
        size_t next = i + 1 < end ? i + 1 : first;
        sum += (p[i].x - p[first].x) * (p[next].y - p[first].y) -
               (p[i].y - p[first].y) * (p[next].x - p[first].x);
    }
    return sum;
}

csg_node_id csg_solid_fill(csg_solid_job *job, csg_node_id child)
{
    csg_outline outline, outer;
    bool ok = true;
    csgm_status status = csg_flat_outline(job, child, &outline);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make polygons of this figure");
    csg_outline_init(&outer, job->memory);
    for (size_t loop = 0; loop < outline.loop_count && ok; loop++) {
        if (!(area_of(&outline, loop) > 0))
            continue;
        for (size_t i = csg_outline_first(&outline, loop); i < outline.ends[loop] && ok; i++)
            ok = csg_outline_add(&outer, outline.points[i]);
        ok = ok && csg_outline_close(&outer);
    }
    csg_outline_release(&outline);
    if (ok)
        return csg_solid_area(job, &outer, false);
    csg_outline_release(&outer);
    csg_solid_no_memory(job);
    return CSG_NODE_NONE;
}
