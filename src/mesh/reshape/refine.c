/* SPDX-License-Identifier: MIT
 * Refining; see refine.h. What collapses have taken away gives the numbers of the new vertices and
 * triangles.
 */
#include "mesh/reshape/refine.h"

#include <math.h>
#include <string.h>

typedef struct refiner {
    csg_remesh *remesh;
    uint8_t *pending;          /* per triangle: to be proven (again) */
    uint32_t triangle, vertex; /* those before it are in use */
} refiner;

/* The next triangle that is gone; NONE: there is none. */
static uint32_t free_triangle(refiner *f)
{
    const csg_corners *m = &f->remesh->corners;
    while (f->triangle < m->triangle_count && csg_corners_is_live(m, f->triangle))
        f->triangle++;
    return f->triangle < m->triangle_count ? f->triangle++ : CSG_CORNER_NONE;
}

static uint32_t free_vertex(refiner *f)
{
    const csg_corners *m = &f->remesh->corners;
    while (f->vertex < m->vertex_count && m->corner[f->vertex] != CSG_CORNER_NONE)
        f->vertex++;
    return f->vertex < m->vertex_count ? f->vertex++ : CSG_CORNER_NONE;
}

/* The corner that the longest side starts at; creases are halved only where they are straight. */
static uint32_t longest_side(const csg_remesh *r, uint32_t triangle)
{
    uint32_t longest = CSG_CORNER_NONE;
    double most = 0;
    for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; c++) {
        csg_vec3 side =
            csg_vec3_sub(csg_remesh_corner(r, csg_corner_next(c)), csg_remesh_corner(r, c));
        double length = csg_vec3_norm(side);
        if (length > most && !csg_remesh_is_crease(r, c)) {
            most = length;
            longest = c;
        }
    }
    return longest;
}

/* Whether the four triangles keep the way they face, and cross nothing. */
static bool is_sound(const csg_remesh *r, uint32_t corner, csg_vec3 at)
{
    uint32_t apex = csg_corner_previous(corner);
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 c = csg_remesh_corner(r, apex), d = csg_remesh_corner(r, r->corners.across[apex]);
    csg_vec3 left = csg_vec3_normalize(csg_triangle_cross(c, a, b));
    csg_vec3 right = csg_vec3_normalize(csg_triangle_cross(d, b, a));
    const csg_vec3 cut[4][3] = {{c, a, at}, {c, at, b}, {d, b, at}, {d, at, a}};
    for (int i = 0; i < 4; i++) {
        csg_vec3 normal = csg_vec3_normalize(csg_triangle_cross(cut[i][0], cut[i][1], cut[i][2]));
        if (csg_vec3_dot(normal, i < 2 ? left : right) < 0.3 ||
            csg_triangle_quality(cut[i][0], cut[i][1], cut[i][2]) < 1e-3)
            return false;
    }
    const uint32_t *v = r->corners.vertex;
    uint32_t ends[2] = {v[corner], v[csg_corner_next(corner)]}, new = CSG_CORNER_NONE;
    uint32_t apexes[2] = {v[apex], v[r->corners.across[apex]]};
    const uint32_t ids[4][3] = {{apexes[0], ends[0], new},
                                {apexes[0], new, ends[1]},
                                {apexes[1], ends[1], new},
                                {apexes[1], new, ends[0]}};
    const csg_crossing_change change = {.at = cut,
                                        .vertex = ids,
                                        .count = 4,
                                        .vertices = {CSG_CORNER_NONE, CSG_CORNER_NONE},
                                        .triangles = {corner / 3, r->corners.across[apex] / 3}};
    return !csg_crossing_is_made(&r->tree, &change, NULL);
}

static bool halve(refiner *f, uint32_t corner)
{
    csg_remesh *r = f->remesh;
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 at = csg_vec3_scale(csg_vec3_add(a, b), 0.5);
    if (!csg_remesh_project(r, &at, 4 * r->error) || !is_sound(r, corner, at))
        return false;
    uint32_t vertex = free_vertex(f);
    const uint32_t triangles[2] = {free_triangle(f), free_triangle(f)};
    if (vertex == CSG_CORNER_NONE || triangles[0] == CSG_CORNER_NONE ||
        triangles[1] == CSG_CORNER_NONE)
        return false;
    uint32_t other = r->corners.across[csg_corner_previous(corner)] / 3;
    r->at[vertex] = at;
    r->kind[vertex] = CSG_VERTEX_SMOOTH;
    if (r->looks)
        r->looks[vertex] = csg_remesh_look(r, at);
    csg_corners_split(&r->corners, corner, vertex, triangles);
    csg_triangle_tree_update_around(&r->tree, vertex);
    f->pending[corner / 3] = f->pending[other] = 2; /* next round */
    f->pending[triangles[0]] = f->pending[triangles[1]] = 2;
    return true;
}

/* Halves the open triangles, each at most once a round. */
static bool refine_open(refiner *f)
{
    csg_remesh *r = f->remesh;
    bool changed = false;
    for (uint32_t t = 0; t < r->corners.triangle_count; t++) {
        if (f->pending[t] != 1 || !csg_corners_is_live(&r->corners, t))
            continue;
        uint32_t corner = longest_side(r, t);
        changed |= corner != CSG_CORNER_NONE && halve(f, corner);
    }
    return changed;
}

csgm_status csg_refine_until_near(csg_remesh *r, double error, csg_distance_proof *out)
{
    enum { MOST_ROUNDS = 12 };
    size_t count = r->corners.triangle_count;
    refiner f = {.remesh = r, .pending = csg_memory_alloc(r->memory, count)};
    if (!f.pending)
        return csg_context_no_memory(r->context);
    memset(f.pending, 1, count);
    csgm_status status = csg_check_distance(r, error, f.pending, out);
    uint64_t before = UINT64_MAX / 10; /* a round that settles hardly any is the last */
    for (int round = 0; round < MOST_ROUNDS && status == CSGM_OK && out->open && !out->stopped &&
                        out->open * 10 < before * 9;
         round++) {
        before = out->open;
        if (!refine_open(&f))
            break;
        status = csg_check_distance(r, error, f.pending, out);
    }
    csg_memory_release(r->memory, f.pending, count);
    return status;
}
