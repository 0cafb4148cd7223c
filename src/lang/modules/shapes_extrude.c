/* SPDX-License-Identifier: MIT
 * linear_extrude and rotate_extrude. Straight extrusions and full turns keep exact distances; a
 * twist is a warp. With scale the solid is a frustum or a polyhedron, and so it is where facets are
 * asked for.
 */
#include <math.h>
#include <string.h>

#include "lang/modules/imports.h"
#include "lang/modules/pieces.h"
#include "lang/modules/sweeps.h"
#include "shape/plane/polygons.h"

static csg_node_id extrude(csg_module_call *call, csg_node_id flat, double low, double high)
{
    if (flat == CSG_NODE_NONE || call->e->stop)
        return CSG_NODE_NONE;
    return csg_shape_done(
        call, csg_build_extrude(&call->e->builder, flat, low, high, call->statement->where));
}

/* ---- linear_extrude -------------------------------------------------------------------------- */

enum { HEIGHT, DIRECTION, CENTER, TWIST, SCALE, SLICES, CONVEXITY, FILE_NAME, LAYER, ORIGIN };

typedef struct straight { /* a linear extrusion */
    double height, twist, scale[2];
    uint32_t slices; /* 0 = not given */
    csg_vec3 direction;
    bool center, scaled;
} straight;

static straight read_straight(csg_module_call *call)
{
    straight s = {.height = 100, .scale = {1, 1}, .direction = {0, 0, 1}};
    double slices = csg_argument_number(call, SLICES, 0, CSG_ANY);
    if (csg_has_argument(call, DIRECTION)) {
        s.direction = csg_argument_vector(call, DIRECTION, s.direction, false);
        s.height = csg_vec3_norm(s.direction);
        if (!call->failed && s.direction.z == 0)
            csg_argument_error(call, DIRECTION, CSG_DIAG_OUT_OF_RANGE,
                               "v lies in the plane of the figure");
    }
    if (call->values[HEIGHT].kind != CSG_VALUE_STRING)
        s.height = csg_argument_number(call, HEIGHT, s.height, CSG_SIZE);
    s.twist = csg_argument_number(call, TWIST, 0, CSG_ANY);
    csg_argument_pair(call, SCALE, s.scale);
    s.scale[0] = fmax(s.scale[0], 0);
    s.scale[1] = fmax(s.scale[1], 0);
    s.scaled = s.scale[0] != 1 || s.scale[1] != 1;
    s.slices = slices >= 1 ? (uint32_t)fmin(slices, 1e6) : 0;
    s.center = csg_argument_boolean(call, CENTER);
    s.direction = csg_vec3_normalize(s.direction);
    s.height *= fabs(s.direction.z);
    return s;
}

/* A cone for discs around the axis: the frustum's ends when every piece is one. */
static bool is_cone(csg_module_call *call, csg_node_id flat, const straight *s, double *radius)
{
    csg_eval *e = call->e;
    csg_pieces pieces;
    csg_ball ball;
    if (s->twist != 0 || s->scale[0] != s->scale[1] || csg_facets_are_exact(e))
        return false;
    csg_pieces_init(&pieces, e->heap.memory);
    bool cone = csg_pieces_collect(e, flat, &pieces) && pieces.count == 1 &&
                csg_piece_ball(e, &pieces.items[0], &ball) && ball.at.x == 0 && ball.at.y == 0;
    csg_pieces_release(&pieces);
    if (cone)
        *radius = ball.radius;
    return cone;
}

static csg_node_id cone(csg_module_call *call, const straight *s, double radius)
{
    const double sizes[4] = {radius, radius * s->scale[0], s->height / 2, 0};
    csg_affine up = csg_affine_translate(csg_vec3_make(0, 0, s->height / 2));
    csg_node_id node =
        csg_build_primitive(&call->e->builder, CSG_NODE_FRUSTUM, sizes, call->statement->where);
    return csg_shape_moved(call, csg_shape_done(call, node), &up);
}

/* Steps of a twist or an uneven scale as OpenSCAD counts them: by $fn, or by the smaller of what
 * $fa asks of the angle and $fs of the way of the farthest point. */
static uint32_t helix_slices(csg_module_call *call, csg_node_id flat, const straight *s)
{
    enum { PARTS = 64 };
    const double most = 1e6, least = 0.01, degree = acos(-1) / 180;
    csg_eval *e = call->e;
    csg_outline outline;
    double twist = fabs(s->twist), r = 0, way = 0, drift = 0;
    double lowest = fmax(ceil(twist / 120), 1), fn = csg_special_number(e, "$fn", 0);
    if (twist == 0 && s->scale[0] == s->scale[1])
        return 1;
    if (fn > 0)
        return (uint32_t)fmin(fmax(ceil(twist == 0 ? fn : twist / 360 * fn), lowest), most);
    if (csg_flat_outline(call, flat, &outline) != CSGM_OK)
        return 1;
    for (size_t i = 0; i < outline.point_count; i++) {
        csg_vec2 p = outline.points[i];
        r = fmax(r, hypot(p.x, p.y));
        drift = fmax(drift, hypot(p.x * (s->scale[0] - 1), p.y * (s->scale[1] - 1)));
    }
    csg_outline_release(&outline);
    double grows = fmax(s->scale[0], s->scale[1]) - 1;
    for (int i = 0; i < PARTS; i++) {
        double across = r * (1 + grows * (i + 0.5) / PARTS) * twist * degree;
        way += sqrt(s->height * s->height + across * across + r * r * grows * grows) / PARTS;
    }
    if (twist == 0)
        return (uint32_t)fmin(
            ceil(hypot(drift, s->height) / fmax(csg_special_number(e, "$fs", 2), least)), most);
    double by_angle = ceil(twist / fmax(csg_special_number(e, "$fa", 12), least));
    double by_length = ceil(way / fmax(csg_special_number(e, "$fs", 2), least));
    return (uint32_t)fmin(fmax(fmin(by_angle, by_length), lowest), most);
}

/* Between z = 0 and z = height. */
static csg_node_id raise(csg_module_call *call, csg_node_id flat, const straight *s)
{
    csg_eval *e = call->e;
    double radius;
    bool facets = csg_facets_are_exact(e);
    if (s->scaled && is_cone(call, flat, s, &radius))
        return cone(call, s, radius);
    if (s->scaled || (facets && s->twist != 0)) {
        csg_sweep sweep = {.height = s->height,
                           .twist = s->twist,
                           .scale = {s->scale[0], s->scale[1]},
                           .slices = s->slices,
                           .smooth = !facets};
        if (facets && !s->slices)
            sweep.slices = helix_slices(call, flat, s);
        return csg_sweep_up(call, flat, &sweep);
    }
    if (s->twist == 0)
        return extrude(call, flat, 0, s->height);
    const csg_warp warp = {.kind = CSG_WARP_TWIST,
                           .parameters = {-s->twist / s->height, 0, s->height}};
    flat = csg_shape_done(call, csg_build_warp(&e->builder, &warp, flat, call->statement->where));
    return extrude(call, flat, 0, s->height);
}

/* The children, or the file that OpenSCAD's old form names. */
static csg_node_id figure(csg_module_call *call, uint32_t file, uint32_t layer, uint32_t origin)
{
    if (csg_has_argument(call, file))
        return csg_import_figure(call, file, layer, origin);
    return csg_shape_children(call, true);
}

csg_node_id csg_module_linear_extrude(csg_module_call *call)
{
    csg_eval *e = call->e;
    straight s = read_straight(call);
    bool old = call->values[HEIGHT].kind == CSG_VALUE_STRING;
    csg_node_id flat = figure(call, old ? HEIGHT : FILE_NAME, LAYER, ORIGIN);
    if (flat == CSG_NODE_NONE || e->stop || csg_shape_is_empty(e, flat))
        return flat;
    if (call->failed)
        return csg_shape_empty(call);
    csg_node_id node = raise(call, flat, &s);
    csg_affine by = csg_affine_identity();
    if (s.center)
        by.t[2] = -s.height / 2;
    if (s.direction.z != 0) {
        csg_affine lean = csg_affine_identity();
        lean.m[0][2] = s.direction.x / fabs(s.direction.z);
        lean.m[1][2] = s.direction.y / fabs(s.direction.z);
        lean.m[2][2] = s.direction.z > 0 ? 1 : -1;
        by = csg_affine_multiply(lean, by);
    }
    return csg_shape_moved(call, node, &by);
}

/* ---- rotate_extrude -------------------------------------------------------------------------- */

/* The points at angles 0 .. angle around z; angle > 0. */
static csg_node_id wedge(csg_module_call *call, double angle)
{
    csg_scene_builder *builder = &call->e->builder;
    csg_span where = call->statement->where;
    const double begin[4] = {0, -1, 0, 0};
    const double end[4] = {-csg_sine_deg(angle), csg_cosine_deg(angle), 0, 0};
    csg_node_id sides[2] = {csg_build_primitive(builder, CSG_NODE_PLANE, begin, where),
                            csg_build_primitive(builder, CSG_NODE_PLANE, end, where)};
    if (sides[0] == CSG_NODE_NONE || sides[1] == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    return csg_build_operator(builder, angle <= 180 ? CSG_NODE_INTERSECTION : CSG_NODE_UNION,
                              (csg_blend){CSG_BLEND_SHARP, 0}, sides, 2, where);
}

/* A figure that touches the axis goes on behind it, so that the axis is no edge. */
static csg_node_id both_sides(csg_module_call *call, csg_outline *outline)
{
    csg_outline mirrored, both;
    csg_affine mirror = csg_affine_mirror(csg_vec3_make(1, 0, 0));
    csgm_status status = CSGM_ERR_MEMORY;
    csg_outline_init(&mirrored, call->e->heap.memory);
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
        return csg_shape_failed(call, status, "revolve this figure");
    return csg_shape_region(call, &both);
}

/* Puts points within rounding of the axis on it; on which side the others lie. False: on both. */
static bool side_of_axis(csg_module_call *call, csg_outline *outline, double *side, bool *touches)
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
    csg_eval_report(call->e, CSG_DIAG_CROSSES_AXIS, call->statement->where,
                    "move it to one side: translate([r, 0])",
                    "%s(): the figure reaches from x = %g to x = %g, over the axis it turns about",
                    call->name, box.min.x, box.max.x);
    return false;
}

/* The figure on the side of +x, as the warp needs it; `outline` is released. */
static csg_node_id profile(csg_module_call *call, csg_node_id flat, csg_outline *outline,
                           double side, bool touches)
{
    if (touches)
        return both_sides(call, outline);
    csg_outline_release(outline);
    csg_affine mirror = csg_affine_mirror(csg_vec3_make(1, 0, 0));
    return side > 0 ? flat : csg_shape_moved(call, flat, &mirror);
}

static csg_node_id turn(csg_module_call *call, csg_node_id flat, double angle, double start)
{
    csg_eval *e = call->e;
    csg_span where = call->statement->where;
    const csg_warp warp = {.kind = CSG_WARP_REVOLVE};
    if (flat == CSG_NODE_NONE || e->stop)
        return CSG_NODE_NONE;
    csg_node_id node = csg_shape_done(call, csg_build_warp(&e->builder, &warp, flat, where));
    if (node == CSG_NODE_NONE || fabs(angle) >= 360)
        return node;
    csg_node_id cut = wedge(call, fabs(angle));
    csg_affine by = csg_affine_rotate(angle > 0 ? start : start + angle, csg_vec3_make(0, 0, 1));
    cut = csg_shape_moved(call, csg_shape_done(call, cut), &by);
    if (cut == CSG_NODE_NONE)
        return cut;
    return csg_shape_done(call, csg_build_operator(&e->builder, CSG_NODE_INTERSECTION,
                                                   (csg_blend){CSG_BLEND_SHARP, 0},
                                                   (csg_node_id[]){node, cut}, 2, where));
}

static csg_node_id revolve(csg_module_call *call, csg_node_id flat, double angle, double start)
{
    csg_eval *e = call->e;
    csg_outline outline;
    double side;
    bool touches;
    csgm_status status = csg_flat_outline(call, flat, &outline);
    if (status != CSGM_OK)
        return csg_shape_failed(call, status, "make polygons of this figure");
    if (!side_of_axis(call, &outline, &side, &touches)) {
        csg_outline_release(&outline);
        return csg_shape_empty(call);
    }
    csg_box box = csg_outline_box(&outline);
    uint32_t facets = csg_facets(e, fmax(box.max.x, -box.min.x));
    if (facets)
        return csg_sweep_around(call, &outline, angle, start,
                                (uint32_t)fmax(facets * fabs(angle) / 360, 1));
    return turn(call, profile(call, flat, &outline, side, touches), angle,
                side > 0 ? start : start + 180);
}

csg_node_id csg_module_rotate_extrude(csg_module_call *call)
{
    enum { ANGLE, START, FILE_OF_FIGURE = 3, ITS_LAYER, ITS_ORIGIN, SYMMETRIC };
    csg_eval *e = call->e;
    double angle = csg_argument_number(call, ANGLE, 360, CSG_ANY);
    if (angle <= -360 || angle > 360)
        angle = 360;
    double start = csg_argument_number(call, START, angle == 360 ? 180 : 0, CSG_ANY);
    csg_node_id flat = figure(call, FILE_OF_FIGURE, ITS_LAYER, ITS_ORIGIN);
    if (flat == CSG_NODE_NONE || e->stop || csg_shape_is_empty(e, flat))
        return flat;
    if (!call->failed && angle == 0)
        csg_eval_report(e, CSG_DIAG_EMPTY_SHAPE, call->statement->where, NULL,
                        "rotate_extrude() by an angle of 0 makes nothing");
    if (call->failed || angle == 0)
        return csg_shape_empty(call);
    if (csg_argument_boolean(call, SYMMETRIC))
        return turn(call, flat, angle, start);
    return revolve(call, flat, angle, start);
}
