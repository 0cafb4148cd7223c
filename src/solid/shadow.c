/* SPDX-License-Identifier: MIT
 * The shadow of a solid on the plane z = 0, put together from the shadows of its pieces. A prism
 * casts its own figure, a convex piece the hull of its corners; of other surfaces the triangles
 * that look up are taken: the edges between those and the rest wind around every point of the
 * shadow, once for each of those triangles above it.
 */
#include <stdlib.h>

#include "shape/plane/polygons.h"
#include "shape/polyhedra/polyhedron.h"
#include "solid/measure.h"
#include "solid/operations.h"
#include "solid/pieces.h"

/* ---- edges of what looks up -------------------------------------------------------------------
 */

typedef struct edge {
    uint32_t from, to;
} edge;

typedef struct shadow {
    csg_memory *memory;
    const csg_triangles *triangles;
    const csg_affine *map;
    edge *edges;
    size_t count, capacity;
} shadow;

static csg_vec3 corner(const shadow *s, size_t triangle, int i)
{
    return csg_affine_point(s->map, s->triangles->points[s->triangles->corners[triangle][i]]);
}

static bool looks_up(const shadow *s, size_t triangle)
{
    csg_vec3 a = corner(s, triangle, 0);
    csg_vec3 normal = csg_vec3_cross(csg_vec3_sub(corner(s, triangle, 1), a),
                                     csg_vec3_sub(corner(s, triangle, 2), a));
    return (normal.z > 0) == (csg_affine_determinant(*s->map) > 0) && normal.z != 0;
}

static bool collect_edges(shadow *s)
{
    for (size_t i = 0; i < s->triangles->count; i++) {
        if (!looks_up(s, i))
            continue;
        if (!csg_memory_reserve(s->memory, (void **)&s->edges, &s->capacity, s->count + 3,
                                sizeof *s->edges))
            return false;
        const uint32_t *c = s->triangles->corners[i];
        for (int k = 0; k < 3; k++)
            s->edges[s->count++] = (edge){c[k], c[(k + 1) % 3]};
    }
    return true;
}

/* By the lower end, then the upper one, then the direction: opposite edges come together. */
static int by_ends(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    uint32_t k[2][3] = {
        {x->from < x->to ? x->from : x->to, x->from < x->to ? x->to : x->from, x->from < x->to},
        {y->from < y->to ? y->from : y->to, y->from < y->to ? y->to : y->from, y->from < y->to}};
    for (int i = 0; i < 3; i++)
        if (k[0][i] != k[1][i])
            return k[0][i] < k[1][i] ? -1 : 1;
    return 0;
}

static int by_start(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    if (x->from != y->from)
        return x->from < y->from ? -1 : 1;
    return x->to < y->to ? -1 : x->to > y->to;
}

/* Takes out pairs of opposite edges. */
static void cancel(shadow *s)
{
    size_t kept = 0;
    qsort(s->edges, s->count, sizeof *s->edges, by_ends);
    for (size_t i = 0; i < s->count;) {
        size_t end = i, down = 0, up = 0;
        uint32_t low = s->edges[i].from < s->edges[i].to ? s->edges[i].from : s->edges[i].to;
        uint32_t high = s->edges[i].from < s->edges[i].to ? s->edges[i].to : s->edges[i].from;
        for (; end < s->count && ((s->edges[end].from == low && s->edges[end].to == high) ||
                                  (s->edges[end].from == high && s->edges[end].to == low));
             end++)
            *(s->edges[end].from == low ? &up : &down) += 1;
        for (size_t k = 0; k < (up > down ? up - down : down - up); k++)
            s->edges[kept++] = up > down ? (edge){low, high} : (edge){high, low};
        i = end;
    }
    s->count = kept;
    qsort(s->edges, s->count, sizeof *s->edges, by_start);
}

/* The first unused edge that begins at a point; count when there is none. `used` by index. */
static size_t edge_from(const shadow *s, const uint8_t *used, uint32_t point)
{
    size_t low = 0, high = s->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (s->edges[middle].from < point)
            low = middle + 1;
        else
            high = middle;
    }
    while (low < s->count && s->edges[low].from == point && used[low])
        low++;
    return low < s->count && s->edges[low].from == point ? low : s->count;
}

/* As many edges end at a point as begin there, so every walk closes. */
static bool trace_loops(const shadow *s, uint8_t *used, csg_outline *out)
{
    for (size_t first = 0; first < s->count; first++) {
        for (size_t at = first; at < s->count && !used[at];
             at = edge_from(s, used, s->edges[at].to)) {
            csg_vec3 p = csg_affine_point(s->map, s->triangles->points[s->edges[at].from]);
            used[at] = 1;
            if (!csg_outline_add(out, (csg_vec2){p.x, p.y}))
                return false;
        }
        if (!csg_outline_close(out))
            return false;
    }
    return true;
}

static csg_node_id shadow_of_triangles(csg_solid_job *job, const csg_triangles *triangles,
                                       const csg_affine *map)
{
    csg_memory *memory = job->memory;
    shadow s = {.memory = memory, .triangles = triangles, .map = map};
    csg_outline outline;
    csg_outline_init(&outline, memory);
    bool ok = csg_solid_charge(job, triangles->count) && collect_edges(&s);
    if (ok && s.count)
        cancel(&s);
    size_t bytes = s.count ? s.count : 1;
    uint8_t *used = ok ? csg_memory_alloc(memory, bytes) : NULL;
    for (size_t i = 0; used && i < bytes; i++)
        used[i] = 0;
    ok = used && trace_loops(&s, used, &outline);
    csg_memory_release(memory, used, bytes);
    csg_memory_release(memory, s.edges, s.capacity * sizeof *s.edges);
    if (ok)
        return csg_solid_area(job, &outline, false);
    csg_outline_release(&outline);
    csg_solid_no_memory(job);
    return CSG_NODE_NONE;
}

/* ---- shadows of pieces ------------------------------------------------------------------------
 */

typedef struct shadows { /* of the pieces so far */
    csg_solid_job *job;
    csg_node_id *nodes;
    size_t count, capacity;
} shadows;

static csg_node_id shadow_of_convex(csg_solid_job *job, const csg_solid_piece *piece, double size)
{
    const double tolerance = 1e-5;
    csg_cloud cloud;
    csg_cloud_init(&cloud, job->memory);
    csgm_status status = csg_piece_cloud(job, piece, tolerance * size, &cloud);
    for (size_t i = 0; i < cloud.count; i++)
        cloud.balls[i].at.z = 0;
    csg_node_id node = status == CSGM_OK ? csg_cloud_hull_flat(job, &cloud, tolerance * size)
                                         : csg_solid_failed(job, status, "project this solid");
    csg_cloud_release(&cloud);
    return node;
}

static csg_node_id shadow_of_other(csg_solid_job *job, const csg_solid_piece *piece)
{
    const csgm_scene *scene = job->builder->scene;
    const csg_node *node = &scene->nodes[piece->node];
    if (node->kind == CSG_NODE_SHAPE && piece->grow == 0)
        return shadow_of_triangles(job, csg_polyhedron_triangles(scene->shapes[node->payload]),
                                   &piece->map);
    csg_triangles triangles;
    csg_triangles_init(&triangles, job->memory);
    csgm_status status = csg_solid_triangles(job, piece->node, &triangles);
    csg_node_id flat = status == CSGM_OK ? shadow_of_triangles(job, &triangles, &piece->map)
                                         : csg_solid_failed(job, status, "project this solid");
    csg_triangles_release(&triangles);
    return csg_solid_grown(job, flat, piece->grow);
}

static void add_shadow(shadows *s, csg_node_id node)
{
    csg_solid_job *job = s->job;
    if (node == CSG_NODE_NONE || job->stop)
        return;
    if (csg_memory_reserve(job->memory, (void **)&s->nodes, &s->capacity, s->count + 1,
                           sizeof node))
        s->nodes[s->count++] = node;
    else
        csg_solid_no_memory(job);
}

/* One for a piece, or those of its figure. */
static void cast_piece(shadows *s, const csg_solid_piece *piece, double size)
{
    csg_solid_job *job = s->job;
    csg_solid_pieces figure;
    double heights[2];
    csg_pieces_init(&figure, job->memory);
    if (csg_piece_prism(job, piece, &figure, heights)) {
        for (size_t i = 0; i < figure.count && !job->stop; i++)
            add_shadow(s, csg_piece_placed(job, &figure.items[i]));
    } else if (!job->stop) {
        add_shadow(s, csg_piece_is_convex(job, piece) ? shadow_of_convex(job, piece, size)
                                                      : shadow_of_other(job, piece));
    }
    csg_pieces_release(&figure);
}

csg_node_id csg_solid_shadow(csg_solid_job *job, csg_node_id solid)
{
    csg_solid_pieces pieces;
    shadows s = {.job = job};
    double size;
    if (!csg_finite_size(job, solid, &size))
        return csg_solid_empty(job);
    csg_node_id node = CSG_NODE_NONE;
    if (csg_solid_sketch_flat(job, csg_build_box(job->builder, solid), &node))
        return node;
    csg_pieces_init(&pieces, job->memory);
    if (!csg_pieces_collect(job->builder->scene, solid, &pieces))
        csg_solid_no_memory(job);
    for (size_t i = 0; i < pieces.count && !job->stop; i++)
        cast_piece(&s, &pieces.items[i], size);
    csg_pieces_release(&pieces);
    node = job->stop ? CSG_NODE_NONE : csg_solid_union(job, s.nodes, s.count);
    csg_memory_release(job->memory, s.nodes, s.capacity * sizeof *s.nodes);
    return node;
}
