/* SPDX-License-Identifier: MIT
 * Figures pulled straight up or turned about an axis. Straight extrusions and full turns keep exact
 * distances; a twist is a warp, with scale or without. With scale alone the solid is a frustum or a
 * polyhedron, and so it is where facets are asked for, or the scale is nearly 0.
 */
#include <math.h>

#include "base/elementary.h"
#include "scene/operators/rule.h"
#include "scene/outlines/unite.h"
#include "scene/primitives/kinds.h"
#include "scene/warp_kinds.h"
#include "shape/plane/polygons.h"
#include "solid/measure.h"
#include "solid/operations.h"
#include "solid/pieces.h"
#include "solid/sweeps.h"

/* A figure whose edges are straight is one outline before it becomes a solid. */
static csg_node_id united(csg_solid_job *job, csg_node_id flat)
{
    if (flat == CSG_NODE_NONE || job->stop)
        return CSG_NODE_NONE;
    return csg_solid_done(job, csg_unite(job->builder, flat));
}

static csg_node_id extrude(csg_solid_job *job, csg_node_id flat, double low, double high)
{
    if (flat == CSG_NODE_NONE || job->stop)
        return CSG_NODE_NONE;
    return csg_solid_done(job, csg_build_extrude(job->builder, flat, low, high, job->where));
}

/* ---- up -------------------------------------------------------------------------------------- */

/* A cone for discs around the axis: the frustum's ends when every piece is one. */
static bool is_cone(csg_solid_job *job, csg_node_id flat, const csg_extrusion *s, double *radius)
{
    csg_solid_pieces pieces;
    csg_ball ball;
    if (s->twist != 0 || s->scale[0] != s->scale[1])
        return false;
    csg_pieces_init(&pieces, job->memory);
    bool cone = csg_pieces_collect(job->builder->scene, flat, &pieces) && pieces.count == 1 &&
                csg_piece_ball(job->builder->scene, &pieces.items[0], &ball) && ball.at.x == 0 &&
                ball.at.y == 0;
    csg_pieces_release(&pieces);
    if (cone)
        *radius = ball.radius;
    return cone;
}

static csg_node_id cone(csg_solid_job *job, const csg_extrusion *s, double radius)
{
    const double sizes[4] = {radius, radius * s->scale[0], s->height / 2, 0};
    csg_affine up = csg_affine_translate(csg_vec3_make(0, 0, s->height / 2));
    csg_node_id node = csg_build_primitive(job->builder, CSG_NODE_FRUSTUM, sizes, job->where);
    return csg_solid_moved(job, csg_solid_done(job, node), &up);
}

/* Steps of a twist or an uneven scale as OpenSCAD counts them: by $fn, or by the smaller of what
 * $fa asks of the angle and $fs of the way of the farthest point. */
static uint32_t helix_slices(csg_solid_job *job, const csg_facet_rule *rule, csg_node_id flat,
                             const csg_extrusion *s)
{
    enum { PARTS = 64 };
    const double most = 1e6, least = 0.01, degree = csg_acos(-1) / 180;
    csg_outline outline;
    double twist = fabs(s->twist), r = 0, way = 0, drift = 0;
    double lowest = fmax(ceil(twist / 120), 1);
    if (twist == 0 && s->scale[0] == s->scale[1])
        return 1;
    if (rule->fn > 0)
        return (uint32_t)fmin(fmax(ceil(twist == 0 ? rule->fn : twist / 360 * rule->fn), lowest),
                              most);
    if (csg_flat_outline(job, flat, &outline) != CSGM_OK)
        return 1;
    for (size_t i = 0; i < outline.point_count; i++) {
        csg_vec2 p = outline.points[i];
        r = fmax(r, csg_hypot(p.x, p.y));
        drift = fmax(drift, csg_hypot(p.x * (s->scale[0] - 1), p.y * (s->scale[1] - 1)));
    }
    csg_outline_release(&outline);
    double grows = fmax(s->scale[0], s->scale[1]) - 1;
    for (int i = 0; i < PARTS; i++) {
        double across = r * (1 + grows * (i + 0.5) / PARTS) * twist * degree;
        way += sqrt(s->height * s->height + across * across + r * r * grows * grows) / PARTS;
    }
    if (twist == 0)
        return (uint32_t)fmin(ceil(csg_hypot(drift, s->height) / fmax(rule->fs, least)), most);
    double by_angle = ceil(twist / fmax(rule->fa, least));
    double by_length = ceil(way / fmax(rule->fs, least));
    return (uint32_t)fmin(fmax(fmin(by_angle, by_length), lowest), most);
}

/* A twisted figure between z = 0 and the height. */
static csg_node_id twisted(csg_solid_job *job, csg_node_id flat, const csg_warp *warp,
                           double height)
{
    if (flat == CSG_NODE_NONE)
        return flat;
    flat = csg_solid_done(job, csg_build_warp(job->builder, warp, flat, job->where));
    return extrude(job, flat, 0, height);
}

/* Where a taper's field would be a small part of the distance, exact distances serve better. */
static bool is_mild(const double scale[2])
{
    const double least = 0.2, most = 10;
    return fmin(scale[0], scale[1]) >= least && fmax(scale[0], scale[1]) <= most;
}

csg_node_id csg_solid_extrude(csg_solid_job *job, const csg_facet_rule *rule, csg_node_id flat,
                              const csg_extrusion *s)
{
    double radius;
    bool facets = rule->exact;
    bool scaled = s->scale[0] != 1 || s->scale[1] != 1;
    if (scaled && !facets && is_cone(job, flat, s, &radius))
        return cone(job, s, radius);
    if (scaled && s->twist != 0 && !facets && is_mild(s->scale)) {
        const csg_warp taper = {
            .kind = CSG_WARP_TAPER,
            .parameters = {-s->twist / s->height, 0, s->height, s->scale[0], s->scale[1]}};
        return twisted(job, united(job, flat), &taper, s->height);
    }
    if (scaled || (facets && s->twist != 0)) {
        csg_sweep sweep = {.height = s->height,
                           .twist = s->twist,
                           .scale = {s->scale[0], s->scale[1]},
                           .slices = s->slices,
                           .smooth = !facets};
        if (facets && !s->slices)
            sweep.slices = helix_slices(job, rule, flat, s);
        return csg_sweep_up(job, flat, &sweep);
    }
    flat = united(job, flat);
    if (s->twist == 0)
        return extrude(job, flat, 0, s->height);
    const csg_warp twist = {.kind = CSG_WARP_TWIST,
                            .parameters = {-s->twist / s->height, 0, s->height}};
    return twisted(job, flat, &twist, s->height);
}

/* ---- around ---------------------------------------------------------------------------------- */

/* The points at angles 0 .. angle around z; angle > 0. */
static csg_node_id wedge(csg_solid_job *job, double angle)
{
    csg_scene_builder *builder = job->builder;
    csg_span where = job->where;
    csg_vec3 begin = csg_vec3_make(0, -1, 0);
    csg_vec3 end = csg_vec3_make(-csg_sine_deg(angle), csg_cosine_deg(angle), 0);
    csg_node_id sides[2] = {csg_build_half_space(builder, begin, 0, where),
                            csg_build_half_space(builder, end, 0, where)};
    if (sides[0] == CSG_NODE_NONE || sides[1] == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    return csg_build_operator(builder, angle <= 180 ? CSG_NODE_INTERSECTION : CSG_NODE_UNION,
                              CSG_SHARP, sides, 2, where);
}

/* A figure that touches the axis goes on behind it, so that the axis is no edge. */
static csg_node_id both_sides(csg_solid_job *job, csg_outline *outline)
{
    csg_outline mirrored, both;
    csg_affine mirror = csg_affine_mirror(csg_vec3_make(1, 0, 0));
    csgm_status status = CSGM_ERR_MEMORY;
    csg_outline_init(&mirrored, job->memory);
    if (csg_outline_append(&mirrored, outline)) {
        csg_outline_transform(&mirrored, &mirror);
        csg_outline turned = mirrored; /* clean outer loops run counter-clockwise */
        status = csg_polygons_clean(&turned, CSG_FILL_EVEN_ODD, &mirrored);
        csg_outline_release(&turned);
    }
    if (status == CSGM_OK)
        status = csg_polygons_combine(CSG_POLYGONS_UNION, outline, &mirrored, &both);
    csg_outline_release(&mirrored);
    csg_outline_release(outline);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "revolve this figure");
    return csg_solid_region(job, &both);
}

/* Puts points within rounding of the axis on it; on which side the others lie. False: on both. */
static bool side_of_axis(csg_solid_job *job, csg_outline *outline, double *side, bool *touches)
{
    csg_box box = csg_outline_box(outline);
    double slack = 1e-8 * fmax(fmax(-box.min.x, box.max.x), box.max.y - box.min.y);
    *touches = false;
    for (size_t i = 0; i < outline->point_count; i++)
        if (fabs(outline->points[i].x) <= slack) {
            outline->points[i].x = 0;
            *touches = true;
        }
    *side = box.max.x > slack ? 1 : -1;
    if (box.min.x >= -slack || box.max.x <= slack)
        return true;
    const csg_solid_reason reason = {.fault = CSG_SOLID_CROSSES_AXIS,
                                     .range = {box.min.x, box.max.x}};
    csg_solid_note(job, &reason);
    return false;
}

/* The figure on the side of +x, as the warp needs it; `outline` is released. */
static csg_node_id profile(csg_solid_job *job, csg_node_id flat, csg_outline *outline, double side,
                           bool touches)
{
    if (touches)
        return both_sides(job, outline);
    csg_outline_release(outline);
    csg_affine mirror = csg_affine_mirror(csg_vec3_make(1, 0, 0));
    return side > 0 ? flat : csg_solid_moved(job, flat, &mirror);
}

csg_node_id csg_solid_turn(csg_solid_job *job, csg_node_id flat, double angle, double start)
{
    csg_span where = job->where;
    const csg_warp warp = {.kind = CSG_WARP_REVOLVE};
    flat = united(job, flat);
    if (flat == CSG_NODE_NONE)
        return flat;
    csg_node_id node = csg_solid_done(job, csg_build_warp(job->builder, &warp, flat, where));
    if (node == CSG_NODE_NONE || fabs(angle) >= 360)
        return node;
    csg_node_id cut = wedge(job, fabs(angle));
    csg_affine by = csg_affine_rotate(angle > 0 ? start : start + angle, csg_vec3_make(0, 0, 1));
    cut = csg_solid_moved(job, csg_solid_done(job, cut), &by);
    if (cut == CSG_NODE_NONE)
        return cut;
    return csg_solid_done(job, csg_build_operator(job->builder, CSG_NODE_INTERSECTION, CSG_SHARP,
                                                  (csg_node_id[]){node, cut}, 2, where));
}

csg_node_id csg_solid_revolve(csg_solid_job *job, const csg_facet_rule *rule, csg_node_id flat,
                              double angle, double start)
{
    csg_outline outline;
    double side;
    bool touches;
    csgm_status status = csg_flat_outline(job, flat, &outline);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make polygons of this figure");
    if (!side_of_axis(job, &outline, &side, &touches)) {
        csg_outline_release(&outline);
        return csg_solid_empty(job);
    }
    csg_box box = csg_outline_box(&outline);
    uint32_t facets = csg_facets(rule, fmax(box.max.x, -box.min.x));
    if (facets)
        return csg_sweep_around(job, &outline, angle, start,
                                (uint32_t)fmax(facets * fabs(angle) / 360, 1));
    return csg_solid_turn(job, profile(job, flat, &outline, side, touches), angle,
                          side > 0 ? start : start + 180);
}
