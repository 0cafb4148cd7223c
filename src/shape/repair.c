/* SPDX-License-Identifier: MIT
 * The order of mending; see repair.h.
 */
#include "shape/repair.h"

bool csg_repair_is_flat(const csg_triangles *triangles, const uint32_t corners[3])
{
    csg_vec3 a = triangles->points[corners[0]];
    csg_vec3 b = csg_vec3_sub(triangles->points[corners[1]], a);
    csg_vec3 c = csg_vec3_sub(triangles->points[corners[2]], a);
    csg_int128 bx = csg_frame_steps(b.x), by = csg_frame_steps(b.y), bz = csg_frame_steps(b.z);
    csg_int128 cx = csg_frame_steps(c.x), cy = csg_frame_steps(c.y), cz = csg_frame_steps(c.z);
    return by * cz == bz * cy && bz * cx == bx * cz && bx * cy == by * cx;
}

static bool points_are_finite(const csg_triangles *in)
{
    for (size_t i = 0; i < in->point_count; i++) {
        csg_vec3 p = in->points[i];
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
            return false;
    }
    return true;
}

static bool corners_are_points(const csg_triangles *in)
{
    for (size_t t = 0; t < in->count; t++)
        for (int k = 0; k < 3; k++)
            if (in->corners[t][k] >= in->point_count)
                return false;
    return true;
}

/* Box of the points that triangles have. */
static csg_box used_box(const csg_triangles *in)
{
    csg_box box = csg_box_empty();
    for (size_t t = 0; t < in->count; t++)
        for (int k = 0; k < 3; k++) {
            csg_vec3 p = in->points[in->corners[t][k]];
            box = csg_box_hull(box, (csg_box){p, p});
        }
    return box;
}

static bool has_open_edge(const csg_edges *edges)
{
    for (size_t i = 0; i < edges->count; i++)
        if (edges->edges[i].count == 1)
            return true;
    return false;
}

/* Everything up to the closed chain; false is for memory. */
static bool close_chain(csg_arena *scratch, csg_triangles *triangles, csg_edges *edges,
                        csg_repairs *repairs)
{
    if (!csg_repair_drop(scratch, triangles, false, repairs) ||
        !csg_edges_make(scratch, triangles, edges))
        return false;
    if (has_open_edge(edges)) {
        size_t before = repairs->welded;
        if (!csg_repair_weld_rims(scratch, triangles, edges, &repairs->welded))
            return false;
        if (repairs->welded > before && (!csg_repair_drop(scratch, triangles, false, repairs) ||
                                         !csg_edges_make(scratch, triangles, edges)))
            return false;
    }
    for (size_t i = 0; i < edges->count; i++)
        repairs->nonmanifold += edges->edges[i].count > 2;
    for (size_t t = 0; t < triangles->count; t++)
        repairs->degenerate += csg_repair_is_flat(triangles, triangles->corners[t]);
    if (!csg_repair_turn(scratch, triangles, edges, &repairs->flipped) ||
        (repairs->flipped && !csg_edges_make(scratch, triangles, edges)))
        return false;
    size_t count = triangles->count;
    if (!csg_repair_fill(scratch, triangles, edges, repairs))
        return false;
    return triangles->count == count || (csg_repair_drop(scratch, triangles, true, repairs) &&
                                         csg_edges_make(scratch, triangles, edges));
}

/* ---- pieces -----------------------------------------------------------------------------------
 */

static uint32_t find_root(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/* pieces: per triangle, numbered in the order of their first triangles. */
static bool find_pieces(csg_arena *scratch, const csg_edges *edges, csg_chain *chain)
{
    size_t count = chain->triangles.count;
    uint32_t *parents = csg_arena_alloc(scratch, count * sizeof *parents);
    chain->pieces = csg_arena_alloc(scratch, count * sizeof *chain->pieces);
    if (!parents || !chain->pieces)
        return false;
    for (uint32_t t = 0; t < count; t++)
        parents[t] = t;
    for (size_t i = 0; i < edges->count; i++) {
        const uint32_t *halves = edges->halves + edges->edges[i].first;
        uint32_t first = find_root(parents, halves[0] / 3);
        for (uint32_t k = 1; k < edges->edges[i].count; k++) {
            uint32_t other = find_root(parents, halves[k] / 3);
            uint32_t low = first < other ? first : other;
            parents[first] = parents[other] = low;
            first = low;
        }
    }
    chain->piece_count = 0;
    for (uint32_t t = 0; t < count; t++) {
        uint32_t root = find_root(parents, t);
        chain->pieces[t] = root == t ? (uint32_t)chain->piece_count++ : chain->pieces[root];
    }
    return true;
}

/* Six times the volume of the tetrahedron over the origin. */
static double volume6(const csg_triangles *triangles, size_t t)
{
    const uint32_t *corners = triangles->corners[t];
    return csg_vec3_dot(
        triangles->points[corners[0]],
        csg_vec3_cross(triangles->points[corners[1]], triangles->points[corners[2]]));
}

static double area_of(const csg_triangles *triangles, size_t t)
{
    const uint32_t *corners = triangles->corners[t];
    csg_vec3 a = triangles->points[corners[0]];
    return csg_vec3_norm(csg_vec3_cross(csg_vec3_sub(triangles->points[corners[1]], a),
                                        csg_vec3_sub(triangles->points[corners[2]], a))) /
           2;
}

static bool measure_pieces(csg_arena *scratch, csg_chain *chain)
{
    chain->volumes = csg_arena_calloc(scratch, chain->piece_count, sizeof *chain->volumes);
    if (!chain->volumes)
        return false;
    for (size_t t = 0; t < chain->triangles.count; t++)
        chain->volumes[chain->pieces[t]] += volume6(&chain->triangles, t) / 6;
    return true;
}

/* A piece is thicker than rounding to the lattice makes a flat one. */
static bool bounds_volume(const csg_chain *chain)
{
    double area = 0, largest = 0;
    for (size_t t = 0; t < chain->triangles.count; t++)
        area += area_of(&chain->triangles, t);
    for (size_t i = 0; i < chain->piece_count; i++)
        largest = fmax(largest, fabs(chain->volumes[i]));
    return largest > 0x1p-36 * area;
}

static void turn_outwards(csg_chain *chain, csg_repairs *repairs)
{
    double volume = 0;
    for (size_t i = 0; i < chain->piece_count; i++)
        volume += chain->volumes[i];
    if (volume >= 0)
        return;
    repairs->inside_out = true;
    for (size_t i = 0; i < chain->piece_count; i++)
        chain->volumes[i] = -chain->volumes[i];
    for (size_t t = 0; t < chain->triangles.count; t++) {
        uint32_t *corners = chain->triangles.corners[t], corner = corners[1];
        corners[1] = corners[2];
        corners[2] = corner;
    }
}

/* What has no area bounds nothing and is nearest to nothing: its edges were needed, it is not. */
static void drop_flat(csg_chain *chain)
{
    csg_triangles *triangles = &chain->triangles;
    size_t kept = 0;
    for (size_t t = 0; t < triangles->count; t++) {
        if (csg_repair_is_flat(triangles, triangles->corners[t]))
            continue;
        for (int k = 0; k < 3; k++)
            triangles->corners[kept][k] = triangles->corners[t][k];
        chain->pieces[kept++] = chain->pieces[t];
    }
    triangles->count = kept;
}

/* Points that no triangle has any more go. */
static bool drop_points(csg_arena *scratch, csg_triangles *triangles)
{
    size_t kept = 0;
    uint32_t *number = csg_arena_calloc(scratch, triangles->point_count, sizeof *number);
    if (!number)
        return false;
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++)
            number[triangles->corners[t][k]] = 1;
    for (size_t i = 0; i < triangles->point_count; i++) {
        if (!number[i])
            continue;
        triangles->points[kept] = triangles->points[i];
        number[i] = (uint32_t)kept++;
    }
    triangles->point_count = kept;
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++)
            triangles->corners[t][k] = number[triangles->corners[t][k]];
    return true;
}

static csgm_status repair(csg_arena *scratch, const csg_triangles *in, csg_chain *out,
                          csg_repairs *repairs)
{
    csg_edges edges;
    if (!csg_repair_weld(scratch, &out->frame, in, &out->triangles, repairs) ||
        !close_chain(scratch, &out->triangles, &edges, repairs))
        return CSGM_ERR_MEMORY;
    if (!find_pieces(scratch, &edges, out))
        return CSGM_ERR_MEMORY;
    drop_flat(out);
    if (!drop_points(scratch, &out->triangles) || !measure_pieces(scratch, out))
        return CSGM_ERR_MEMORY;
    turn_outwards(out, repairs);
    return bounds_volume(out) ? CSGM_OK : CSGM_ERR_SCENE;
}

csgm_status csg_repair(csg_memory *memory, csg_arena *scratch, const csg_triangles *in,
                       csg_chain *out, csg_repairs *repairs)
{
    static const size_t MOST = 1u << 26; /* four times as many when mended: places have 28 bits */
    *repairs = (csg_repairs){0};
    *out = (csg_chain){0};
    if (!in->count || in->count > MOST || in->point_count > MOST || !corners_are_points(in) ||
        !points_are_finite(in) || !csg_frame_make(used_box(in), &out->frame))
        return CSGM_ERR_SCENE;
    csg_triangles_init(&out->triangles, memory);
    csgm_status status = repair(scratch, in, out, repairs);
    if (status != CSGM_OK)
        csg_triangles_release(&out->triangles);
    return status;
}
