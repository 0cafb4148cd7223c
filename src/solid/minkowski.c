/* SPDX-License-Identifier: MIT
 * The Minkowski sum of two nodes:
 *   with a ball (or a disc in the plane): the other one, grown: exact where its field is a distance
 *   outside, else a polyhedron of its tessellation (or polygons) is grown;
 *   prisms along z: the sum of their figures, extruded over the sum of their heights;
 *   convex solids: the hull of the sums of their corners and balls (hull.c says how exact);
 *   unions: the union of the sums of their members;
 *   figures of the plane: by polygons, with each convex part of one of them;
 *   other solids: the union of the sums of their convex parts (convex_pieces.c), of which there may
 *   be too many: then it is an error.
 */
#include <math.h>

#include "scene/primitives/curve.h"
#include "shape/plane/polygons.h"
#include "shape/plane/region.h"
#include "solid/measure.h"
#include "solid/operations.h"
#include "solid/pieces.h"

static const double tolerance = 1e-4, flat_tolerance = 1e-5; /* of the size */

typedef struct summing {
    csg_solid_job *job;
    double size; /* of both operands together */
    csg_solid_pieces a, b;
    csg_node_id *sums;
    size_t count, capacity;
    bool flat, ok;
} summing;

static void add_sum(summing *s, csg_node_id node)
{
    csg_solid_job *job = s->job;
    s->ok = s->ok && node != CSG_NODE_NONE;
    if (s->ok && !csg_memory_reserve(job->memory, (void **)&s->sums, &s->capacity, s->count + 1,
                                     sizeof node)) {
        csg_solid_no_memory(job);
        s->ok = false;
    }
    if (s->ok)
        s->sums[s->count++] = node;
}

/* ---- with a ball ----------------------------------------------------------------------------- */

/* A node whose distance is exact outside, for one that may have none. */
static csg_node_id with_distance(csg_solid_job *job, csg_node_id node)
{
    csgm_status status;
    if (csg_distance_is_exact(job, node, true))
        return node;
    if (csg_solid_is_flat(job, node)) {
        csg_outline outline;
        status = csg_flat_outline(job, node, &outline);
        return status == CSGM_OK ? csg_solid_region(job, &outline)
                                 : csg_solid_failed(job, status, "make polygons of this figure");
    }
    csg_triangles triangles;
    csg_triangles_init(&triangles, job->memory);
    status = csg_solid_triangles(job, node, &triangles);
    if (status == CSGM_OK)
        return csg_solid_of_triangles(job, &triangles, NULL);
    csg_triangles_release(&triangles);
    return csg_solid_failed(job, status, "tessellate this solid");
}

static csg_node_id grow(csg_solid_job *job, csg_node_id node, csg_ball ball)
{
    csg_affine by = csg_affine_translate(ball.at);
    node = with_distance(job, node);
    if (node == CSG_NODE_NONE || csg_solid_is_empty(job, node))
        return node;
    node = csg_solid_done(job, csg_build_offset(job->builder, ball.radius, node, job->where));
    return csg_solid_moved(job, node, &by);
}

/* ---- clouds ---------------------------------------------------------------------------------- */

static csgm_status sum_of_clouds(csg_solid_job *job, const csg_cloud *a, const csg_cloud *b,
                                 csg_cloud *out)
{
    if (!csg_solid_charge(job, (uint64_t)a->count * b->count))
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < a->count; i++)
        for (size_t k = 0; k < b->count; k++)
            if (!csg_cloud_add(out, csg_vec3_add(a->balls[i].at, b->balls[k].at),
                               a->balls[i].radius + b->balls[k].radius))
                return CSGM_ERR_MEMORY;
    return CSGM_OK;
}

/* Of convex pieces. Sampled ones are taken coarser when there would be too many pairs. */
static csg_node_id sum_convex(summing *s, const csg_solid_pieces *a, const csg_solid_pieces *b,
                              bool flat)
{
    enum { MOST_PAIRS = 1 << 20 };
    csg_solid_job *job = s->job;
    double within = s->size * (flat ? flat_tolerance : tolerance);
    csg_cloud clouds[3];
    csgm_status status = CSGM_OK;
    for (int i = 0; i < 3; i++)
        csg_cloud_init(&clouds[i], job->memory);
    for (int round = 0; round < 4 && status == CSGM_OK; round++, within *= 8) {
        clouds[0].count = clouds[1].count = 0;
        for (size_t i = 0; i < a->count && status == CSGM_OK; i++)
            status = csg_piece_cloud(job, &a->items[i], within, &clouds[0]);
        for (size_t i = 0; i < b->count && status == CSGM_OK; i++)
            status = csg_piece_cloud(job, &b->items[i], within, &clouds[1]);
        if (clouds[0].count * clouds[1].count <= MOST_PAIRS)
            break;
    }
    if (status == CSGM_OK)
        status = sum_of_clouds(job, &clouds[0], &clouds[1], &clouds[2]);
    csg_node_id node = status != CSGM_OK ? csg_solid_failed(job, status, "add these solids")
                       : flat            ? csg_cloud_hull_flat(job, &clouds[2], within)
                                         : csg_cloud_hull(job, &clouds[2], within);
    for (int i = 0; i < 3; i++)
        csg_cloud_release(&clouds[i]);
    return node;
}

/* ---- figures of the plane -------------------------------------------------------------------- */

static csg_node_id refuse(csg_solid_job *job, const char *what, const char *hint)
{
    const csg_solid_reason reason = {.fault = CSG_SOLID_NO_SUM, .what = what, .hint = hint};
    csg_solid_note(job, &reason);
    return csg_solid_empty(job);
}

/* The union of the sums of a with each convex part of b. */
static csgm_status add_polygons(csg_solid_job *job, const csg_outline *a, const csg_outline *b,
                                csg_outline *out)
{
    csg_outline parts, sums;
    csg_outline_init(out, job->memory);
    csgm_status status = csg_polygons_convex_parts(b, job->memory, &parts);
    csg_outline_init(&sums, job->memory);
    for (size_t loop = 0; loop < parts.loop_count && status == CSGM_OK; loop++) {
        size_t first = csg_outline_first(&parts, loop);
        uint32_t end = (uint32_t)(parts.ends[loop] - first);
        const csg_outline part = {.memory = job->memory,
                                  .points = parts.points + first,
                                  .ends = &end,
                                  .point_count = end,
                                  .loop_count = 1};
        csg_outline sum;
        csg_outline_init(&sum, job->memory);
        status = csg_solid_charge(job, (uint64_t)a->point_count + end)
                     ? csg_polygons_minkowski(a, &part, &sum)
                     : CSGM_ERR_LIMIT;
        if (status == CSGM_OK && !csg_outline_append(&sums, &sum))
            status = CSGM_ERR_MEMORY;
        csg_outline_release(&sum);
    }
    if (status == CSGM_OK)
        status = csg_polygons_clean(&sums, CSG_FILL_NONZERO, out);
    csg_outline_release(&sums);
    csg_outline_release(&parts);
    return status;
}

static csg_node_id sum_polygons(summing *s, const csg_solid_piece *a, const csg_solid_piece *b)
{
    csg_solid_job *job = s->job;
    csg_outline outlines[2], sum;
    const csg_solid_piece *pieces[2] = {a, b};
    csgm_status status = CSGM_OK;
    int made = 0;
    for (; made < 2 && status == CSGM_OK; made++) {
        csg_node_id node = csg_piece_placed(job, pieces[made]);
        status =
            node == CSG_NODE_NONE ? CSGM_ERR_MEMORY : csg_flat_outline(job, node, &outlines[made]);
    }
    if (status == CSGM_OK)
        status = csg_piece_is_convex(job, b)
                     ? csg_polygons_minkowski(&outlines[0], &outlines[1], &sum)
                     : add_polygons(job, &outlines[0], &outlines[1], &sum);
    else
        made--;
    while (made-- > 0)
        csg_outline_release(&outlines[made]);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "add these figures");
    return csg_solid_region(job, &sum);
}

static csg_node_id sum_flat(summing *s, const csg_solid_piece *a, const csg_solid_piece *b)
{
    csg_solid_job *job = s->job;
    csg_ball ball;
    if (csg_piece_ball(job->builder->scene, b, &ball))
        return grow(s->job, csg_piece_placed(s->job, a), ball);
    if (csg_piece_ball(job->builder->scene, a, &ball))
        return grow(s->job, csg_piece_placed(s->job, b), ball);
    bool convex[2] = {csg_piece_is_convex(job, a), csg_piece_is_convex(job, b)};
    csg_solid_pieces one[2] = {{.items = (csg_solid_piece[]){*a}, .count = 1},
                               {.items = (csg_solid_piece[]){*b}, .count = 1}};
    if (convex[0] && convex[1])
        return sum_convex(s, &one[0], &one[1], true);
    return convex[0] ? sum_polygons(s, b, a) : sum_polygons(s, a, b);
}

/* The sum of prisms; *done tells whether both are. */
static csg_node_id sum_prisms(summing *s, const csg_solid_piece *a, const csg_solid_piece *b,
                              bool *done)
{
    csg_solid_job *job = s->job;
    csg_solid_pieces figures[2];
    double heights[2][2];
    csg_node_id node = CSG_NODE_NONE;
    csg_pieces_init(&figures[0], job->memory);
    csg_pieces_init(&figures[1], job->memory);
    *done = csg_piece_prism(job, a, &figures[0], heights[0]) &&
            csg_piece_prism(job, b, &figures[1], heights[1]);
    if (*done) {
        summing flat = {.job = job, .size = s->size, .flat = true, .ok = true};
        for (size_t i = 0; i < figures[0].count && flat.ok; i++)
            for (size_t k = 0; k < figures[1].count && flat.ok; k++)
                add_sum(&flat, sum_flat(&flat, &figures[0].items[i], &figures[1].items[k]));
        if (flat.ok)
            node = csg_solid_union(job, flat.sums, flat.count);
        csg_memory_release(job->memory, flat.sums, flat.capacity * sizeof *flat.sums);
        if (node != CSG_NODE_NONE)
            node = csg_solid_done(
                job, csg_build_extrude(job->builder, node, heights[0][0] + heights[1][0],
                                       heights[0][1] + heights[1][1], job->where));
    }
    csg_pieces_release(&figures[0]);
    csg_pieces_release(&figures[1]);
    return node;
}

/* ---- solids that are not convex -------------------------------------------------------------- */

/* The union of the sums of all their convex parts. */
static csg_node_id sum_clouds(summing *s, const csg_clouds *a, const csg_clouds *b)
{
    csg_solid_job *job = s->job;
    summing parts = {.job = job, .ok = true};
    for (size_t i = 0; i < a->count && parts.ok; i++)
        for (size_t k = 0; k < b->count && parts.ok; k++) {
            csg_cloud sum;
            csg_cloud_init(&sum, job->memory);
            csgm_status status = sum_of_clouds(job, &a->items[i], &b->items[k], &sum);
            csg_node_id node = status != CSGM_OK ? csg_solid_failed(job, status, "add these solids")
                                                 : csg_cloud_hull(job, &sum, s->size * tolerance);
            csg_cloud_release(&sum);
            add_sum(&parts, node);
        }
    csg_node_id node = parts.ok ? csg_solid_union(job, parts.sums, parts.count) : CSG_NODE_NONE;
    csg_memory_release(job->memory, parts.sums, parts.capacity * sizeof *parts.sums);
    return node;
}

static csg_node_id sum_parts(summing *s, const csg_solid_piece *a, const csg_solid_piece *b)
{
    enum { MOST_SUMS = 20000 };
    csg_solid_job *job = s->job;
    csg_clouds clouds[2];
    csg_node_id node;
    csg_clouds_init(&clouds[0], job->memory);
    csg_clouds_init(&clouds[1], job->memory);
    csgm_status status = csg_piece_convex_clouds(job, a, s->size * tolerance, &clouds[0]);
    if (status == CSGM_OK)
        status = csg_piece_convex_clouds(job, b, s->size * tolerance, &clouds[1]);
    if (status == CSGM_OK && clouds[0].count * clouds[1].count > MOST_SUMS)
        status = CSGM_ERR_LIMIT;
    if (status == CSGM_ERR_LIMIT && !job->stop)
        node = refuse(job, "two solids with so many hollows",
                      "write them as unions of convex solids, or use a sphere");
    else if (status != CSGM_OK)
        node = csg_solid_failed(job, status, "take these solids apart");
    else
        node = sum_clouds(s, &clouds[0], &clouds[1]);
    csg_clouds_release(&clouds[0]);
    csg_clouds_release(&clouds[1]);
    return node;
}

/* ---- pairs ----------------------------------------------------------------------------------- */

static csg_node_id sum_solids(summing *s, const csg_solid_piece *a, const csg_solid_piece *b)
{
    csg_solid_job *job = s->job;
    csg_ball ball;
    bool done = false;
    if (csg_piece_ball(job->builder->scene, b, &ball))
        return grow(s->job, csg_piece_placed(s->job, a), ball);
    if (csg_piece_ball(job->builder->scene, a, &ball))
        return grow(s->job, csg_piece_placed(s->job, b), ball);
    csg_node_id node = sum_prisms(s, a, b, &done);
    if (done || job->stop)
        return node;
    csg_solid_pieces one[2] = {{.items = (csg_solid_piece[]){*a}, .count = 1},
                               {.items = (csg_solid_piece[]){*b}, .count = 1}};
    if (csg_piece_is_convex(job, a) && csg_piece_is_convex(job, b))
        return sum_convex(s, &one[0], &one[1], false);
    return sum_parts(s, a, b);
}

/* Exact growth of a whole union at once, when the other operand is one ball. */
static bool is_one_ball(const csg_solid_job *job, const csg_solid_pieces *pieces, csg_ball *ball)
{
    return pieces->count == 1 && csg_piece_ball(job->builder->scene, &pieces->items[0], ball);
}

static csg_node_id sum_pairs(summing *s)
{
    csg_solid_job *job = s->job;
    csg_node_id node = CSG_NODE_NONE;
    for (size_t i = 0; i < s->a.count && s->ok; i++)
        for (size_t k = 0; k < s->b.count && s->ok; k++) {
            s->ok = csg_solid_charge(job, 1);
            if (s->ok)
                add_sum(s, s->flat ? sum_flat(s, &s->a.items[i], &s->b.items[k])
                                   : sum_solids(s, &s->a.items[i], &s->b.items[k]));
        }
    if (s->ok)
        node = csg_solid_union(job, s->sums, s->count);
    csg_memory_release(job->memory, s->sums, s->capacity * sizeof *s->sums);
    return node;
}

/* Capsules in the places of a tube along a curve, which is not convex. */
static bool add_capsules(summing *s, const csg_solid_piece *piece, csg_solid_pieces *out)
{
    csg_solid_job *job = s->job;
    const csg_node *node = &job->builder->scene->nodes[piece->node];
    csg_node_id chain = csg_solid_capsules(s->job, (csg_node_kind)node->kind,
                                           job->builder->scene->parameters + node->payload);
    size_t first = out->count;
    if (chain == CSG_NODE_NONE || !csg_pieces_collect(job->builder->scene, chain, out))
        return false;
    for (size_t i = first; i < out->count; i++) {
        out->items[i].map = csg_affine_multiply(piece->map, out->items[i].map);
        out->items[i].grow += piece->grow;
    }
    return true;
}

static bool split_curves(summing *s, csg_solid_pieces *pieces)
{
    csg_solid_job *job = s->job;
    csg_solid_pieces all;
    bool ok = true;
    csg_pieces_init(&all, job->memory);
    for (size_t i = 0; i < pieces->count && ok; i++) {
        const csg_solid_piece *piece = &pieces->items[i];
        ok = csg_node_is_curve(job->builder->scene->nodes[piece->node].kind)
                 ? add_capsules(s, piece, &all)
                 : csg_pieces_add(&all, *piece);
    }
    csg_pieces_release(pieces);
    *pieces = all;
    if (!ok && !job->stop)
        csg_solid_no_memory(job);
    return ok;
}

csg_node_id csg_solid_minkowski(csg_solid_job *job, csg_node_id a, csg_node_id b)
{
    double sizes[2];
    csg_ball ball;
    csg_node_id node = CSG_NODE_NONE;
    if (csg_solid_is_empty(job, a) || csg_solid_is_empty(job, b))
        return csg_solid_is_empty(job, a) ? a : b;
    if (!csg_finite_size(job, a, &sizes[0]) || !csg_finite_size(job, b, &sizes[1]))
        return csg_solid_empty(job);
    csg_box boxes[2] = {csg_build_box(job->builder, a), csg_build_box(job->builder, b)};
    const csg_box sum = {csg_vec3_add(boxes[0].min, boxes[1].min),
                         csg_vec3_add(boxes[0].max, boxes[1].max)};
    if (!csg_solid_is_flat(job, a) && csg_solid_sketch(job, sum, &node))
        return node;
    summing s = {
        .job = job, .size = sizes[0] + sizes[1], .flat = csg_solid_is_flat(job, a), .ok = true};
    csg_pieces_init(&s.a, job->memory);
    csg_pieces_init(&s.b, job->memory);
    if (!csg_pieces_collect(job->builder->scene, a, &s.a) ||
        !csg_pieces_collect(job->builder->scene, b, &s.b))
        csg_solid_no_memory(job);
    else if (is_one_ball(job, &s.b, &ball))
        node = grow(job, a, ball);
    else if (is_one_ball(job, &s.a, &ball))
        node = grow(job, b, ball);
    else if (split_curves(&s, &s.a) && split_curves(&s, &s.b))
        node = sum_pairs(&s);
    csg_pieces_release(&s.a);
    csg_pieces_release(&s.b);
    return node;
}
