/* SPDX-License-Identifier: MIT
 * minkowski(), two operands at a time:
 *   with a ball (or a disc in the plane): the other one, grown: exact where its field is a distance
 *   outside, else a polyhedron of its tessellation (or polygons) is grown;
 *   prisms along z: the sum of their figures, extruded over the sum of their heights;
 *   convex solids: the hull of the sums of their corners and balls (hull.c says how exact);
 *   unions: the union of the sums of their members;
 *   figures of the plane: by polygons, when one is convex.
 * Other pairs are errors: no sum of two solids that both have hollows is known to be a field.
 */
#include <math.h>

#include "lang/modules/pieces.h"
#include "scene/primitives/curve.h"
#include "shape/plane/polygons.h"
#include "shape/plane/region.h"

static const double tolerance = 1e-4, flat_tolerance = 1e-5; /* of the size */

typedef struct summing {
    csg_module_call *call;
    double size; /* of both operands together */
    csg_pieces a, b;
    csg_node_id *sums;
    size_t count, capacity;
    bool flat, ok;
} summing;

static void add_sum(summing *s, csg_node_id node)
{
    csg_eval *e = s->call->e;
    s->ok = s->ok && node != CSG_NODE_NONE;
    if (s->ok && !csg_memory_reserve(e->heap.memory, (void **)&s->sums, &s->capacity, s->count + 1,
                                     sizeof node)) {
        csg_eval_no_memory(e);
        s->ok = false;
    }
    if (s->ok)
        s->sums[s->count++] = node;
}

/* ---- with a ball ----------------------------------------------------------------------------- */

/* A node whose distance is exact outside, for one that may have none. */
static csg_node_id with_distance(csg_module_call *call, csg_node_id node)
{
    csg_eval *e = call->e;
    csgm_status status;
    if (csg_distance_is_exact(e, node, true))
        return node;
    if (csg_shape_is_flat(e, node)) {
        csg_outline outline;
        status = csg_flat_outline(call, node, &outline);
        return status == CSGM_OK ? csg_shape_region(call, &outline)
                                 : csg_shape_failed(call, status, "make polygons of this figure");
    }
    csg_triangles triangles;
    csg_triangles_init(&triangles, e->heap.memory);
    status = csg_solid_triangles(call, node, &triangles);
    if (status == CSGM_OK)
        return csg_shape_solid(call, &triangles, false);
    csg_triangles_release(&triangles);
    return csg_shape_failed(call, status, "tessellate this solid");
}

static csg_node_id grow(csg_module_call *call, csg_node_id node, csg_ball ball)
{
    csg_affine by = csg_affine_translate(ball.at);
    node = with_distance(call, node);
    if (node == CSG_NODE_NONE || csg_shape_is_empty(call->e, node))
        return node;
    node = csg_shape_done(
        call, csg_build_offset(&call->e->builder, ball.radius, node, call->statement->where));
    return csg_shape_moved(call, node, &by);
}

/* A copy of a piece in the common frame. */
static csg_node_id placed(csg_module_call *call, const csg_piece *piece)
{
    csg_scene_builder *builder = &call->e->builder;
    csg_span where = call->statement->where;
    csg_node_id node = csg_shape_done(call, csg_build_copy(builder, piece->node));
    node = csg_shape_moved(call, node, &piece->map);
    if (node == CSG_NODE_NONE || piece->grow == 0)
        return node;
    return csg_shape_done(call, csg_build_offset(builder, piece->grow, node, where));
}

/* ---- clouds ---------------------------------------------------------------------------------- */

static csgm_status sum_of_clouds(csg_module_call *call, const csg_cloud *a, const csg_cloud *b,
                                 csg_cloud *out)
{
    if (!csg_eval_charge(call->e, (uint64_t)a->count * b->count, call->statement->where))
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = 0; k < b->count; k++)
            if (!csg_cloud_add(out, csg_vec3_add(a->balls[i].at, b->balls[k].at),
                               a->balls[i].radius + b->balls[k].radius))
                return CSGM_ERR_MEMORY;
    return CSGM_OK;
}

/* Of convex pieces. Sampled ones are taken coarser when there would be too many pairs. */
static csg_node_id sum_convex(summing *s, const csg_pieces *a, const csg_pieces *b, bool flat)
{
    enum { MOST_PAIRS = 1 << 20 };
    csg_module_call *call = s->call;
    double within = s->size * (flat ? flat_tolerance : tolerance);
    csg_cloud clouds[3];
    csgm_status status = CSGM_OK;
    for (int i = 0; i < 3; i++)
        csg_cloud_init(&clouds[i], call->e->heap.memory);
    for (int round = 0; round < 4 && status == CSGM_OK; round++, within *= 8) {
        clouds[0].count = clouds[1].count = 0;
        for (size_t i = 0; i < a->count && status == CSGM_OK; i++)
            status = csg_piece_cloud(call, &a->items[i], within, &clouds[0]);
        for (size_t i = 0; i < b->count && status == CSGM_OK; i++)
            status = csg_piece_cloud(call, &b->items[i], within, &clouds[1]);
        if (clouds[0].count * clouds[1].count <= MOST_PAIRS)
            break;
    }
    if (status == CSGM_OK)
        status = sum_of_clouds(call, &clouds[0], &clouds[1], &clouds[2]);
    csg_node_id node = status != CSGM_OK ? csg_shape_failed(call, status, "add these solids")
                       : flat            ? csg_cloud_hull_flat(call, &clouds[2], within)
                                         : csg_cloud_hull(call, &clouds[2], within);
    for (int i = 0; i < 3; i++)
        csg_cloud_release(&clouds[i]);
    return node;
}

/* ---- figures of the plane -------------------------------------------------------------------- */

static csg_node_id refuse(csg_module_call *call, const char *what, const char *hint)
{
    csg_eval_report(call->e, CSG_DIAG_NOT_EXACT, call->statement->where, hint,
                    "minkowski(): the sum of %s cannot be computed", what);
    return csg_shape_empty(call);
}

static csg_node_id sum_polygons(summing *s, const csg_piece *a, const csg_piece *b)
{
    csg_module_call *call = s->call;
    csg_outline outlines[2], sum;
    const csg_piece *pieces[2] = {a, b};
    csgm_status status = CSGM_OK;
    int made = 0;
    for (; made < 2 && status == CSGM_OK; made++) {
        csg_node_id node = placed(call, pieces[made]);
        status =
            node == CSG_NODE_NONE ? CSGM_ERR_MEMORY : csg_flat_outline(call, node, &outlines[made]);
    }
    if (status == CSGM_OK)
        status = csg_polygons_minkowski(&outlines[0], &outlines[1], &sum);
    else
        made--;
    while (made-- > 0)
        csg_outline_release(&outlines[made]);
    if (status != CSGM_OK)
        return csg_shape_failed(call, status, "add these figures");
    return csg_shape_region(call, &sum);
}

static csg_node_id sum_flat(summing *s, const csg_piece *a, const csg_piece *b)
{
    csg_eval *e = s->call->e;
    csg_ball ball;
    if (csg_piece_ball(e, b, &ball))
        return grow(s->call, placed(s->call, a), ball);
    if (csg_piece_ball(e, a, &ball))
        return grow(s->call, placed(s->call, b), ball);
    bool convex[2] = {csg_piece_is_convex(e, a), csg_piece_is_convex(e, b)};
    csg_pieces one[2] = {{.items = (csg_piece[]){*a}, .count = 1},
                         {.items = (csg_piece[]){*b}, .count = 1}};
    if (convex[0] && convex[1])
        return sum_convex(s, &one[0], &one[1], true);
    if (convex[0] || convex[1])
        return convex[0] ? sum_polygons(s, b, a) : sum_polygons(s, a, b);
    return refuse(s->call, "two figures that are both not convex",
                  "make one of them a union of convex ones");
}

/* The sum of prisms; *done tells whether both are. */
static csg_node_id sum_prisms(summing *s, const csg_piece *a, const csg_piece *b, bool *done)
{
    csg_module_call *call = s->call;
    csg_eval *e = call->e;
    csg_pieces figures[2];
    double heights[2][2];
    csg_node_id node = CSG_NODE_NONE;
    csg_pieces_init(&figures[0], e->heap.memory);
    csg_pieces_init(&figures[1], e->heap.memory);
    *done = csg_piece_prism(e, a, &figures[0], heights[0]) &&
            csg_piece_prism(e, b, &figures[1], heights[1]);
    if (*done) {
        summing flat = {.call = call, .size = s->size, .flat = true, .ok = true};
        for (size_t i = 0; i < figures[0].count && flat.ok; i++)
            for (size_t k = 0; k < figures[1].count && flat.ok; k++)
                add_sum(&flat, sum_flat(&flat, &figures[0].items[i], &figures[1].items[k]));
        if (flat.ok)
            node =
                csg_shape_done(call, csg_build_operator(&e->builder, CSG_NODE_UNION,
                                                        (csg_blend){CSG_BLEND_SHARP, 0}, flat.sums,
                                                        flat.count, call->statement->where));
        csg_memory_release(e->heap.memory, flat.sums, flat.capacity * sizeof *flat.sums);
        if (node != CSG_NODE_NONE)
            node = csg_shape_done(
                call, csg_build_extrude(&e->builder, node, heights[0][0] + heights[1][0],
                                        heights[0][1] + heights[1][1], call->statement->where));
    }
    csg_pieces_release(&figures[0]);
    csg_pieces_release(&figures[1]);
    return node;
}

/* ---- pairs ----------------------------------------------------------------------------------- */

static csg_node_id sum_solids(summing *s, const csg_piece *a, const csg_piece *b)
{
    csg_eval *e = s->call->e;
    csg_ball ball;
    bool done = false;
    if (csg_piece_ball(e, b, &ball))
        return grow(s->call, placed(s->call, a), ball);
    if (csg_piece_ball(e, a, &ball))
        return grow(s->call, placed(s->call, b), ball);
    csg_node_id node = sum_prisms(s, a, b, &done);
    if (done || e->stop)
        return node;
    csg_pieces one[2] = {{.items = (csg_piece[]){*a}, .count = 1},
                         {.items = (csg_piece[]){*b}, .count = 1}};
    if (csg_piece_is_convex(e, a) && csg_piece_is_convex(e, b))
        return sum_convex(s, &one[0], &one[1], false);
    return refuse(s->call, "a solid that is not convex and one that is no ball",
                  "write it as a union of convex solids, or use a sphere");
}

/* Exact growth of a whole union at once, when the other operand is one ball. */
static bool is_one_ball(const csg_eval *e, const csg_pieces *pieces, csg_ball *ball)
{
    return pieces->count == 1 && csg_piece_ball(e, &pieces->items[0], ball);
}

static csg_node_id sum_pairs(summing *s)
{
    csg_module_call *call = s->call;
    csg_eval *e = call->e;
    csg_node_id node = CSG_NODE_NONE;
    for (size_t i = 0; i < s->a.count && s->ok; i++)
        for (size_t k = 0; k < s->b.count && s->ok; k++) {
            s->ok = csg_eval_charge(e, 1, call->statement->where);
            if (s->ok)
                add_sum(s, s->flat ? sum_flat(s, &s->a.items[i], &s->b.items[k])
                                   : sum_solids(s, &s->a.items[i], &s->b.items[k]));
        }
    if (s->ok)
        node = csg_shape_done(call, csg_build_operator(&e->builder, CSG_NODE_UNION,
                                                       (csg_blend){CSG_BLEND_SHARP, 0}, s->sums,
                                                       s->count, call->statement->where));
    csg_memory_release(e->heap.memory, s->sums, s->capacity * sizeof *s->sums);
    return node;
}

/* Capsules in the places of a tube along a curve, which is not convex. */
static bool add_capsules(summing *s, const csg_piece *piece, csg_pieces *out)
{
    csg_eval *e = s->call->e;
    const csg_node *node = &e->builder.scene->nodes[piece->node];
    csg_node_id chain = csg_shape_capsules(s->call, (csg_node_kind)node->kind,
                                           e->builder.scene->parameters + node->payload);
    size_t first = out->count;
    if (chain == CSG_NODE_NONE || !csg_pieces_collect(e, chain, out))
        return false;
    for (size_t i = first; i < out->count; i++) {
        out->items[i].map = csg_affine_multiply(piece->map, out->items[i].map);
        out->items[i].grow += piece->grow;
    }
    return true;
}

static bool split_curves(summing *s, csg_pieces *pieces)
{
    csg_eval *e = s->call->e;
    csg_pieces all;
    bool ok = true;
    csg_pieces_init(&all, e->heap.memory);
    for (size_t i = 0; i < pieces->count && ok; i++) {
        const csg_piece *piece = &pieces->items[i];
        ok = csg_node_is_curve(e->builder.scene->nodes[piece->node].kind)
                 ? add_capsules(s, piece, &all)
                 : csg_pieces_add(&all, *piece);
    }
    csg_pieces_release(pieces);
    *pieces = all;
    if (!ok && !e->stop)
        csg_eval_no_memory(e);
    return ok;
}

static csg_node_id sum(csg_module_call *call, csg_node_id a, csg_node_id b)
{
    csg_eval *e = call->e;
    double sizes[2];
    csg_ball ball;
    csg_node_id node = CSG_NODE_NONE;
    if (csg_shape_is_empty(e, a) || csg_shape_is_empty(e, b))
        return csg_shape_is_empty(e, a) ? a : b;
    if (!csg_finite_size(call, a, &sizes[0]) || !csg_finite_size(call, b, &sizes[1]))
        return csg_shape_empty(call);
    summing s = {
        .call = call, .size = sizes[0] + sizes[1], .flat = csg_shape_is_flat(e, a), .ok = true};
    csg_pieces_init(&s.a, e->heap.memory);
    csg_pieces_init(&s.b, e->heap.memory);
    if (!csg_pieces_collect(e, a, &s.a) || !csg_pieces_collect(e, b, &s.b))
        csg_eval_no_memory(e);
    else if (is_one_ball(e, &s.b, &ball))
        node = grow(call, a, ball);
    else if (is_one_ball(e, &s.a, &ball))
        node = grow(call, b, ball);
    else if (split_curves(&s, &s.a) && split_curves(&s, &s.b))
        node = sum_pairs(&s);
    csg_pieces_release(&s.a);
    csg_pieces_release(&s.b);
    return node;
}

csg_node_id csg_module_minkowski(csg_module_call *call)
{
    csg_eval *e = call->e;
    size_t first = e->part_count;
    csg_run_scope(e, call->statement->children, call->frame, false);
    if (e->stop)
        return CSG_NODE_NONE;
    csg_shape_keep_alike(e, first, call->statement->where);
    if (e->part_count == first)
        return csg_shape_empty(call);
    csg_node_id node = e->parts[first].node;
    for (size_t i = first + 1; i < e->part_count && node != CSG_NODE_NONE && !e->stop; i++)
        node = sum(call, node, e->parts[i].node);
    e->part_count = first;
    return node;
}
