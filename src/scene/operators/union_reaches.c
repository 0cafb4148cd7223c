/* SPDX-License-Identifier: MIT
 * How far the operands of a union reach towards an end, from the leaves up: by their support
 * functions and by the boxes of all nodes, never too little.
 *
 * The boxes of unions that are wanted take them to end flush on all sides (csg_node_ends_flush).
 * Where no face lies at a side, a blend may swell there: how far is kept for whoever asks for the
 * union from above, and a node with such a union below has a box that proves nothing.
 */
#include "scene/operators/union_ends_private.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

/* ---- how far the operands reach --------------------------------------------------------------- */

csg_end_reach csg_farther_end_reach(csg_end_reach a, csg_end_reach b)
{
    double at = fmax(a.at, b.at), from = at - csg_near_end(at);
    return (csg_end_reach){at, (a.has_face && a.at >= from) || (b.has_face && b.at >= from)};
}

static csg_end_reach nearer(csg_end_reach a, csg_end_reach b)
{
    double at = fmin(a.at, b.at), to = at + csg_near_end(at);
    return (csg_end_reach){at, (a.has_face && a.at <= to) || (b.has_face && b.at <= to)};
}

static double side(double n, double low, double high)
{
    return n == 0 ? 0 : n > 0 ? n * high : n * low;
}

double csg_box_reach(csg_box box, csg_vec3 n)
{
    return side(n.x, box.min.x, box.max.x) + side(n.y, box.min.y, box.max.y) +
           side(n.z, box.min.z, box.max.z);
}

static csg_vec3 corner_of(csg_box box, int k)
{
    return csg_vec3_make(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                         k & 4 ? box.max.z : box.min.z);
}

/* An extrusion reaches as far as its figure and its height do together. */
static void hand_down(csg_end_search *s, size_t i)
{
    const csgm_scene *scene = s->scene;
    const csg_node *node = &scene->nodes[i];
    csg_vec3 n = s->normals[i];
    if (node->kind == CSG_NODE_TRANSFORM)
        n = csg_affine_covector(&scene->transforms[node->payload], n);
    if (node->kind == CSG_NODE_WARP)
        csg_warp_plane(&scene->warps[node->payload], n, &n);
    for (uint32_t k = 0; k < node->child_count; k++) {
        csg_node_id child = csg_scene_children(scene, node)[k];
        csg_vec3 inner = n;
        if (csg_node_is_plate(node))
            inner = scene->nodes[child].flags & CSG_FLAG_FLAT ? csg_vec3_make(n.x, n.y, 0)
                                                              : csg_vec3_make(0, 0, n.z);
        s->normals[child] = inner;
    }
}

/* Operators within all of their operands, or within the first. */
static bool is_within(const csg_node *node)
{
    return !csg_blend_is_rule(node->blend);
}

/* Caps and sides have faces; what lies between is where an edge is. */
static csg_end_reach plate_reach(const csg_end_search *s, const csg_node *node, csg_vec3 n)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    csg_end_reach plate = {0, false};
    for (uint32_t k = 0; k < node->child_count; k++) {
        bool is_figure = s->scene->nodes[children[k]].flags & CSG_FLAG_FLAT;
        double across = is_figure ? fabs(n.z) : fabs(n.x) + fabs(n.y);
        csg_end_reach one = s->reaches[children[k]];
        plate.at += one.at;
        plate.has_face |= one.has_face && across < CSG_AT_END * csg_vec3_norm(n);
    }
    return plate;
}

static csg_end_reach children_reach(const csg_end_search *s, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    bool meets = node->kind == CSG_NODE_INTERSECTION;
    csg_end_reach all = s->reaches[children[0]];
    for (uint32_t k = 1; k < node->child_count && node->kind != CSG_NODE_DIFFERENCE; k++) {
        csg_end_reach one = s->reaches[children[k]];
        all = meets ? nearer(all, one) : csg_farther_end_reach(all, one);
    }
    return all;
}

static bool polyhedron_has_face(const csg_triangles *t, csg_vec3 n, double from)
{
    for (size_t i = 0; i < t->count; i++) {
        bool is_there = true;
        for (int k = 0; k < 3 && is_there; k++)
            is_there = csg_vec3_dot(n, t->points[t->corners[i][k]]) >= from;
        if (is_there)
            return true;
    }
    return false;
}

static bool outline_has_edge(const csg_outline *o, csg_vec3 n, double from)
{
    for (size_t k = 0; k < o->loop_count; k++) {
        size_t first = csg_outline_first(o, k);
        for (size_t i = first; i < o->ends[k]; i++) {
            size_t next = i + 1 < o->ends[k] ? i + 1 : first;
            if (n.x * o->points[i].x + n.y * o->points[i].y >= from &&
                n.x * o->points[next].x + n.y * o->points[next].y >= from)
                return true;
        }
    }
    return false;
}

/* To its outermost corner; of very many it is not looked for. */
static csg_end_reach shape_reach(const csg_shape *shape, csg_vec3 n)
{
    enum { MOST_POINTS = 1 << 16 };
    double most = -INFINITY;
    if (shape->kind == CSG_SHAPE_POLYHEDRON) {
        const csg_triangles *t = csg_polyhedron_triangles(shape);
        for (size_t i = 0; i < t->point_count && t->point_count <= MOST_POINTS; i++)
            most = fmax(most, csg_vec3_dot(n, t->points[i]));
        if (isfinite(most))
            return (csg_end_reach){most, polyhedron_has_face(t, n, most - csg_near_end(most))};
    } else if (n.z == 0) {
        const csg_outline *o = csg_region_outline(shape);
        for (size_t i = 0; i < o->point_count && o->point_count <= MOST_POINTS; i++)
            most = fmax(most, n.x * o->points[i].x + n.y * o->points[i].y);
        if (isfinite(most))
            return (csg_end_reach){most, outline_has_edge(o, n, most - csg_near_end(most))};
    }
    return (csg_end_reach){INFINITY, false};
}

/* Of a union whose sides are known. */
static csg_end_reach sides_reach(const csg_end_search *s, csg_node_id i)
{
    const csg_sides *known = &s->sides[s->settled[i] - 1];
    csg_vec3 n = s->normals[i];
    const double v[3] = {n.x, n.y, n.z};
    csg_end_reach all = {csg_box_reach(s->scene->bounds[i], n), false};
    for (int axis = 0; axis < 3; axis++) {
        int at = 2 * axis + (v[axis] < 0);
        if (v[axis] == 0)
            continue;
        all.at += fabs(v[axis]) * known->over[at];
        all.has_face |= known->has_face[at] && fabs(v[axis]) >= (1 - CSG_AT_END) * csg_vec3_norm(n);
    }
    return all;
}

/* The part of a box beyond n p = d, where n has an axis's direction; else the box. */
static csg_box box_beyond(csg_box box, csg_vec3 n, double d)
{
    const double v[3] = {n.x, n.y, n.z};
    double *const low[3] = {&box.min.x, &box.min.y, &box.min.z};
    double *const high[3] = {&box.max.x, &box.max.y, &box.max.z};
    for (int k = 0; k < 3; k++) {
        if (v[(k + 1) % 3] != 0 || v[(k + 2) % 3] != 0)
            continue;
        if (v[k] > 0)
            *low[k] = fmax(*low[k], d / v[k]);
        else
            *high[k] = fmin(*high[k], d / v[k]);
    }
    return box;
}

/* What is subtracted, a convex primitive: where along n the box ends if it takes all of it beyond a
 * face. Else INFINITY. */
static double cut_at(const csgm_scene *scene, csg_node_id i, csg_vec3 n, csg_box box)
{
    const csg_node *node = &scene->nodes[i];
    csg_affine to_own = csg_affine_identity(), place;
    for (; node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR;
         node = &scene->nodes[csg_scene_children(scene, node)[0]])
        if (node->kind == CSG_NODE_TRANSFORM)
            to_own = csg_affine_multiply(scene->inverses[node->payload], to_own);
    if (!csg_primitive_has(node->kind, CSG_TRAIT_CONVEX) || !csg_affine_invert(to_own, &place))
        return INFINITY;
    const csg_primitive *p = csg_primitive_of(node->kind);
    const double *v = csg_scene_parameters(scene, node);
    csg_vec3 back = csg_affine_covector(&place, csg_vec3_scale(n, -1));
    double at =
        csg_vec3_dot(n, csg_vec3_make(place.t[0], place.t[1], place.t[2])) - p->support(v, back);
    if (!isfinite(at) || !p->has_face(v, back))
        return INFINITY;
    box = box_beyond(box, n, at);
    for (int k = 0; k < 8; k++) {
        if (p->distance(v, csg_affine_point(&to_own, corner_of(box, k))).value < -csg_near_end(0))
            return INFINITY;
    }
    return at;
}

/* Within its first operand, and what is left where another takes all beyond a face. */
static csg_end_reach difference_reach(const csg_end_search *s, const csg_node *node, csg_vec3 n)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    csg_end_reach all = s->reaches[children[0]];
    csg_box box = s->scene->bounds[children[0]];
    if (s->is_loose[children[0]] || !csg_box_is_finite(box))
        return all;
    for (uint32_t k = 1; k < node->child_count; k++)
        all = nearer(all, (csg_end_reach){cut_at(s->scene, children[k], n, box), true});
    return all;
}

/* Of what stands below the union: INFINITY where it is not known. */
static csg_end_reach node_reach(const csg_end_search *s, csg_node_id i)
{
    const csgm_scene *scene = s->scene;
    const csg_node *node = &scene->nodes[i];
    csg_vec3 n = s->normals[i], inner;
    if (csg_node_is_named_primitive(node->kind)) {
        const csg_primitive *p = csg_primitive_of(node->kind);
        const double *v = csg_scene_parameters(scene, node);
        return (csg_end_reach){p->support(v, n), p->has_face(v, n)};
    }
    if (node->kind == CSG_NODE_SHAPE)
        return shape_reach(scene->shapes[node->payload], n);
    if (node->kind == CSG_NODE_TRANSFORM) {
        csg_end_reach all = children_reach(s, node);
        const double *t = scene->transforms[node->payload].t;
        all.at += csg_vec3_dot(n, csg_vec3_make(t[0], t[1], t[2]));
        return all;
    }
    if (node->kind == CSG_NODE_COLOR ||
        (node->kind == CSG_NODE_WARP && csg_warp_plane(&scene->warps[node->payload], n, &inner)))
        return children_reach(s, node);
    if (csg_node_is_plate(node))
        return plate_reach(s, node, n);
    if (s->settled[i])
        return sides_reach(s, i);
    if (!csg_node_is_operator(node->kind) || !is_within(node) || csg_union_adds(node))
        return (csg_end_reach){INFINITY, false};
    return node->kind == CSG_NODE_DIFFERENCE ? difference_reach(s, node, n)
                                             : children_reach(s, node);
}

/* Of an operand grown by its ball, where its box tells that it is. */
static bool offset_has_face(const csg_end_search *s, const csg_node *node, csg_vec3 n, double at)
{
    double r = csg_scene_parameters(s->scene, node)[0] * csg_vec3_norm(n);
    csg_end_reach inner = s->reaches[csg_scene_children(s->scene, node)[0]];
    return inner.has_face && fabs(inner.at + r - at) <= csg_near_end(at);
}

/* As far as is known, and as the node's box says. */
static csg_end_reach bounded_reach(const csg_end_search *s, csg_node_id i)
{
    const csg_node *node = &s->scene->nodes[i];
    csg_vec3 n = s->normals[i];
    csg_end_reach known = node_reach(s, i);
    double box = s->is_loose[i] ? INFINITY : csg_box_reach(s->scene->bounds[i], n);
    if (known.at < box) /* a NaN is no bound */
        return known;
    if (node->kind == CSG_NODE_OFFSET)
        return (csg_end_reach){box, offset_has_face(s, node, n, box)};
    /* an operator's box is smaller where a half-space cuts it */
    bool is_cut = csg_node_is_operator(node->kind) && isfinite(known.at) &&
                  box < known.at - csg_near_end(known.at);
    return (csg_end_reach){box, known.has_face || is_cut};
}

void csg_end_find_reaches(csg_end_search *s, csg_vec3 n)
{
    s->normals[s->root] = n;
    for (size_t at = 0; at < s->seen_count; at++)
        if (at == 0 || !csg_union_adds(&s->scene->nodes[s->seen[at]]))
            hand_down(s, s->seen[at]);
    for (size_t at = s->seen_count; at-- > 1;)
        s->reaches[s->seen[at]] = bounded_reach(s, s->seen[at]);
}

/* ---- how far they lie off an axis --------------------------------------------------------------
 */

/* Of a box in a node's own frame: its farthest corner. */
static double corner_off(const csg_end_search *s, size_t i, const csg_fillet_end *axis)
{
    csg_box box = s->scene->bounds[i];
    csg_affine place;
    csg_vec3 away;
    double most = 0;
    if (!s->is_placed[i] || s->is_loose[i] || !csg_box_is_finite(box) ||
        !csg_affine_invert(s->to_own[i], &place))
        return INFINITY;
    for (int k = 0; k < 8; k++) {
        most = fmax(most,
                    csg_fillet_towards(axis, csg_affine_point(&place, corner_of(box, k)), &away));
    }
    return most;
}

static csg_end_reach node_off(const csg_end_search *s, size_t i, const csg_fillet_end *axis)
{
    const csg_node *node = &s->scene->nodes[i];
    const csg_node_id *children = csg_scene_children(s->scene, node);
    double scale;
    bool is_about = csg_end_is_about(s, i, axis, &scale);
    if (is_about && node->kind == CSG_NODE_WARP) {
        csg_end_reach figure = s->reaches[children[0]];
        return (csg_end_reach){scale * fmax(figure.at, 0), figure.has_face};
    }
    if (is_about) {
        double off = csg_primitive_of(node->kind)
                         ->support(csg_scene_parameters(s->scene, node), csg_vec3_make(1, 0, 0));
        return (csg_end_reach){scale * off, csg_end_has_side(node)};
    }
    if (node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR)
        return children_reach(s, node);
    if (csg_node_is_plate(node))
        return nearer(s->reaches[children[0]], s->reaches[children[1]]);
    if (!csg_node_is_operator(node->kind) || !is_within(node) || csg_union_adds(node))
        return (csg_end_reach){INFINITY, false};
    return children_reach(s, node);
}

/* What is turned about the axis lies as far off it as its figure reaches along x. */
static void hand_down_figures(csg_end_search *s, const csg_fillet_end *axis)
{
    s->normals[s->root] = csg_vec3_make(0, 0, 0);
    for (size_t at = 0; at < s->seen_count; at++) {
        csg_node_id i = s->seen[at];
        const csg_node *node = &s->scene->nodes[i];
        double scale;
        if (at > 0 && csg_union_adds(node))
            continue;
        hand_down(s, i);
        if (node->kind == CSG_NODE_WARP && csg_end_is_about(s, i, axis, &scale))
            s->normals[csg_scene_children(s->scene, node)[0]] = csg_vec3_make(1, 0, 0);
    }
}

void csg_end_find_off(csg_end_search *s, const csg_fillet_end *axis)
{
    hand_down_figures(s, axis);
    for (size_t at = s->seen_count; at-- > 1;) {
        csg_node_id i = s->seen[at];
        if (csg_vec3_norm(s->normals[i]) > 0) {
            s->reaches[i] = bounded_reach(s, i);
            continue;
        }
        csg_end_reach corner = {corner_off(s, i, axis), false}, known = node_off(s, i, axis);
        s->reaches[i] = known.at <= corner.at ? known : corner;
    }
}
