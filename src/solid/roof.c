/* SPDX-License-Identifier: MIT
 * roof(): over each point of a figure as high as it is from the figure's outline, which is the roof
 * of slope 1 by OpenSCAD's method "voronoi": ridges lie over the medial axis. Over convex polygons
 * the straight skeleton gives the same roof; over others it is straight_roof.c's.
 *
 * With the figure's distance d, inside is d(x, y) >= z: a formula of two fields, that of the figure
 * and that of the half-space below z = 0.
 */
#include <math.h>

#include "base/elementary.h"
#include "scene/formula/formula.h"
#include "solid/measure.h"
#include "solid/operations.h"

static bool is_convex(const csg_outline *outline)
{
    const csg_vec2 *p = outline->points;
    size_t n = outline->point_count;
    for (size_t i = 0; i < n; i++) {
        csg_vec2 a = p[i], b = p[(i + 1) % n], c = p[(i + 2) % n];
        double turn = (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
        double size = csg_hypot(b.x - a.x, b.y - a.y) * csg_hypot(c.x - b.x, c.y - b.y);
        if (turn < -1e-12 * size)
            return false;
    }
    return outline->loop_count == 1;
}

/* A figure whose field is its distance inside, for a straight roof a convex one; or
 * the roof itself. */
static csg_node_id exact_figure(csg_solid_job *job, csg_node_id flat, bool straight, bool *is_roof)
{
    csg_outline outline;
    *is_roof = false;
    if (!straight && csg_distance_is_exact(job, flat, false))
        return flat;
    csgm_status status = csg_flat_outline(job, flat, &outline);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make polygons of this figure");
    *is_roof = straight && !is_convex(&outline);
    return *is_roof ? csg_solid_straight_roof(job, &outline) : csg_solid_region(job, &outline);
}

csg_node_id csg_solid_roof(csg_solid_job *job, csg_node_id flat, bool straight)
{
    const csg_formula_step steps[] = {
        {.op = CSG_FORMULA_X}, {.op = CSG_FORMULA_Y}, {.op = CSG_FORMULA_ADD, .a = 0, .b = 1}};
    double size;
    if (!csg_finite_size(job, flat, &size))
        return csg_solid_empty(job);
    bool is_roof;
    flat = exact_figure(job, flat, straight, &is_roof);
    if (flat == CSG_NODE_NONE || is_roof || csg_solid_is_empty(job, flat))
        return flat;
    csg_box box = csg_build_box(job->builder, flat);
    csg_vec3 sides = csg_box_size(box);
    csg_node_id below = csg_solid_done(
        job, csg_build_half_space(job->builder, csg_vec3_make(0, 0, 1), 0, job->where));
    csg_node_id node =
        csg_solid_done(job, csg_build_combine(job->builder, steps, 3, 0,
                                              (csg_node_id[]){flat, below}, 2, job->where));
    if (csg_solid_is_empty(job, node))
        return node;
    box = csg_box_grow(box, size / 8);
    box.min.z = 0;
    box.max.z = fmin(sides.x, sides.y); /* twice as high as the roof can be */
    return csg_solid_done(job, csg_build_cut(job->builder, node, box, job->where));
}
