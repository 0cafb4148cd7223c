/* SPDX-License-Identifier: MIT
 * The pieces of a closed chain, joined by edges: numbered, measured, rid of what bounds nothing,
 * and turned so that together they have a volume that is not negative.
 */
#include "shape/polyhedra/repair.h"

#include "base/sets.h"

/* ---- pieces -----------------------------------------------------------------------------------
 */

/* pieces: per triangle, numbered in the order of their first triangles. */
static bool find_pieces(csg_arena *scratch, const csg_triangle_edges *edges, csg_chain *chain)
{
    size_t count = chain->triangles.count;
    uint32_t *parents = csg_arena_alloc(scratch, count * sizeof *parents);
    chain->pieces = csg_arena_alloc(scratch, count * sizeof *chain->pieces);
    if (!parents || !chain->pieces)
        return false;
    csg_sets_init(parents, count);
    for (size_t i = 0; i < edges->count; i++) {
        const uint32_t *halves = edges->halves + edges->edges[i].first;
        for (uint32_t k = 1; k < edges->edges[i].count; k++)
            csg_sets_join(parents, halves[0] / 3, halves[k] / 3);
    }
    chain->piece_count = 0;
    for (uint32_t t = 0; t < count; t++) {
        uint32_t root = csg_set_root(parents, t);
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

static bool measure_pieces(csg_arena *scratch, csg_chain *chain)
{
    chain->volumes = csg_arena_calloc(scratch, chain->piece_count, sizeof *chain->volumes);
    if (!chain->volumes)
        return false;
    for (size_t t = 0; t < chain->triangles.count; t++)
        chain->volumes[chain->pieces[t]] += volume6(&chain->triangles, t) / 6;
    return true;
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

/* ---- what bounds nothing ----------------------------------------------------------------------
 */

/* The plane of a piece's largest triangle, and how far the piece reaches out of it. */
typedef struct slab {
    csg_vec3 point, normal; /* as long as twice the area */
    double height;
} slab;

static csg_vec3 corner_of(const csg_triangles *triangles, size_t t, int k)
{
    return triangles->points[triangles->corners[t][k]];
}

static void lay_slabs(const csg_chain *chain, slab *slabs)
{
    const csg_triangles *triangles = &chain->triangles;
    for (size_t t = 0; t < triangles->count; t++) {
        slab *s = &slabs[chain->pieces[t]];
        csg_vec3 a = corner_of(triangles, t, 0);
        csg_vec3 normal = csg_vec3_cross(csg_vec3_sub(corner_of(triangles, t, 1), a),
                                         csg_vec3_sub(corner_of(triangles, t, 2), a));
        if (csg_vec3_dot(normal, normal) > csg_vec3_dot(s->normal, s->normal))
            *s = (slab){a, normal, 0};
    }
    for (size_t t = 0; t < triangles->count; t++) {
        slab *s = &slabs[chain->pieces[t]];
        double length = csg_vec3_norm(s->normal);
        for (int k = 0; k < 3; k++) {
            csg_vec3 away = csg_vec3_sub(corner_of(triangles, t, k), s->point);
            s->height = fmax(s->height, fabs(csg_vec3_dot(away, s->normal)) / length);
        }
    }
}

/* Triangles without area: their edges were needed, they are not, being nearest to nothing. And
 * pieces that are flat up to what rounding to the lattice does: loose sheets, closed by their own
 * rear. */
static bool drop_flat(csg_arena *scratch, csg_chain *chain, csg_repairs *repairs)
{
    static const double FLAT = 0x1p-33;
    csg_triangles *triangles = &chain->triangles;
    slab *slabs = csg_arena_calloc(scratch, chain->piece_count, sizeof *slabs);
    if (!slabs)
        return false;
    lay_slabs(chain, slabs);
    size_t kept = 0;
    for (size_t t = 0; t < triangles->count; t++) {
        bool has_area = !csg_repair_is_flat(triangles, triangles->corners[t]);
        bool is_sheet = !(slabs[chain->pieces[t]].height > FLAT);
        repairs->degenerate += has_area && is_sheet;
        if (!has_area || is_sheet)
            continue;
        for (int k = 0; k < 3; k++)
            triangles->corners[kept][k] = triangles->corners[t][k];
        chain->pieces[kept++] = chain->pieces[t];
    }
    triangles->count = kept;
    return true;
}

/* Points that no triangle has any more go. */
static bool drop_points(csg_arena *scratch, csg_chain *chain)
{
    size_t kept = 0;
    csg_triangles *triangles = &chain->triangles;
    uint32_t *number = csg_arena_calloc(scratch, triangles->point_count, sizeof *number);
    chain->welded = csg_arena_alloc(scratch, triangles->point_count * sizeof *chain->welded);
    if (!number || !chain->welded)
        return false;
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++)
            number[triangles->corners[t][k]] = 1;
    for (size_t i = 0; i < triangles->point_count; i++) {
        if (!number[i])
            continue;
        triangles->points[kept] = triangles->points[i];
        chain->welded[kept] = (uint32_t)i;
        number[i] = (uint32_t)kept++;
    }
    triangles->point_count = kept;
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++)
            triangles->corners[t][k] = number[triangles->corners[t][k]];
    return true;
}

csgm_status csg_repair_pieces(csg_arena *scratch, const csg_triangle_edges *edges, csg_chain *chain,
                              csg_repairs *repairs)
{
    if (!find_pieces(scratch, edges, chain) || !drop_flat(scratch, chain, repairs) ||
        !drop_points(scratch, chain) || !measure_pieces(scratch, chain))
        return CSGM_ERR_MEMORY;
    if (!chain->triangles.count)
        return CSGM_ERR_SCENE;
    turn_outwards(chain, repairs);
    return CSGM_OK;
}
