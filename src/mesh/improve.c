/* SPDX-License-Identifier: MIT
 * Smoothing and flipping; see improve.h. All changes are made one after the other in the order of
 * numbers, each only if the worst triangle around it gets better.
 */
#include "mesh/improve.h"

#include <math.h>
#include <stdlib.h>

enum { PASSES = 6, MOST_RING = CSG_CORNERS_MOST_VALENCE };

typedef struct fan {
    csg_vec3 now[MOST_RING][3], then[MOST_RING][3];
    uint32_t vertex[MOST_RING][3];
    size_t count;
} fan;

/* Of the sines of a triangle's angles the smallest, times the longest side over the shortest: what
 * is 0 for every kind of sliver, 0.87 at best. */
static double shape(const csg_vec3 v[3])
{
    return csg_triangle_quality(v[0], v[1], v[2]);
}

static double worst_shape(const csg_vec3 (*triangles)[3], size_t count)
{
    double worst = 1;
    for (size_t i = 0; i < count; i++)
        worst = fmin(worst, shape(triangles[i]));
    return worst;
}

static bool turns_over(const csg_vec3 now[3], const csg_vec3 then[3])
{
    csg_vec3 a = csg_triangle_cross(now[0], now[1], now[2]);
    csg_vec3 b = csg_triangle_cross(then[0], then[1], then[2]);
    return shape(now) > 0.02 && csg_vec3_dot(a, b) < 0.5 * csg_vec3_norm(a) * csg_vec3_norm(b);
}

/* ---- moving -----------------------------------------------------------------------------------
 */

static bool gather(const csg_remesh *r, uint32_t vertex, fan *f)
{
    const csg_corners *m = &r->corners;
    uint32_t first = m->corner[vertex], c = first;
    f->count = 0;
    do {
        if (f->count == MOST_RING)
            return false;
        uint32_t *ids = f->vertex[f->count];
        csg_vec3 *v = f->now[f->count++];
        ids[0] = vertex;
        ids[1] = m->vertex[csg_corner_next(c)];
        ids[2] = m->vertex[csg_corner_previous(c)];
        v[0] = r->at[vertex];
        v[1] = csg_remesh_corner(r, csg_corner_next(c));
        v[2] = csg_remesh_corner(r, csg_corner_previous(c));
        c = csg_corner_swing(m, c);
    } while (c != first);
    return true;
}

/* The mean of the triangles' centroids by their areas: equal areas pull together, few large ones do
 * not push. */
static csg_vec3 middle_of(const fan *f)
{
    csg_vec3 sum = {0, 0, 0};
    double total = 0;
    for (size_t i = 0; i < f->count; i++) {
        const csg_vec3 *v = f->now[i];
        double area = csg_vec3_norm(csg_triangle_cross(v[0], v[1], v[2]));
        csg_vec3 center = csg_vec3_add(v[0], csg_vec3_add(v[1], v[2]));
        sum = csg_vec3_add(sum, csg_vec3_scale(center, area / 3));
        total += area;
    }
    return total > 0 ? csg_vec3_scale(sum, 1 / total) : f->now[0][0];
}

static bool looks_stay(csg_remesh *r, uint32_t vertex, csg_vec3 at, csg_look_at_vertex *look)
{
    enum { COLOR_STEP = 4, MATERIAL_STEP = 200 };
    if (!r->looks)
        return true;
    *look = csg_remesh_look(r, at);
    for (int c = 0; c < 4; c++)
        if (abs(look->color[c] - r->looks[vertex].color[c]) > COLOR_STEP)
            return false;
    for (int c = 0; c < 2; c++)
        if (abs(look->material[c] - r->looks[vertex].material[c]) > MATERIAL_STEP)
            return false;
    return true;
}

static bool move(csg_remesh *r, uint32_t vertex, fan *f)
{
    static const double LEAST_GAIN = 1.001;
    if (r->kind[vertex] != CSG_VERTEX_SMOOTH || !gather(r, vertex, f))
        return false;
    csg_vec3 at = middle_of(f);
    csg_look_at_vertex look = {{0}, {0}};
    if (!csg_remesh_project(r, &at, r->cell) || !looks_stay(r, vertex, at, &look))
        return false;
    for (size_t i = 0; i < f->count; i++) {
        f->then[i][0] = at;
        f->then[i][1] = f->now[i][1];
        f->then[i][2] = f->now[i][2];
        if (turns_over(f->now[i], f->then[i]))
            return false;
    }
    double before = worst_shape((const csg_vec3(*)[3])f->now, f->count);
    double after = worst_shape((const csg_vec3(*)[3])f->then, f->count);
    if (after < LEAST_GAIN * before ||
        !csg_remesh_brackets(r, (const csg_vec3(*)[3])f->then, f->count))
        return false;
    const csg_crossing_change change = {.at = (const csg_vec3(*)[3])f->then,
                                        .vertex = (const uint32_t(*)[3])f->vertex,
                                        .count = f->count,
                                        .vertices = {vertex, CSG_CORNER_NONE},
                                        .triangles = {CSG_CORNER_NONE, CSG_CORNER_NONE}};
    if (csg_crossing_is_made(&r->crossing, &change))
        return false;
    r->at[vertex] = at;
    csg_crossing_update_around(&r->crossing, vertex);
    if (r->looks)
        r->looks[vertex] = look;
    return true;
}

/* ---- flipping ---------------------------------------------------------------------------------
 */

static bool flip(csg_remesh *r, uint32_t corner)
{
    static const double FLAT_COS = 0.9, LEAST_GAIN = 1.01;
    const csg_corners *m = &r->corners;
    uint32_t apex = csg_corner_previous(corner), other = m->across[apex];
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 c = csg_remesh_corner(r, apex), d = csg_remesh_corner(r, other);
    const csg_vec3 now[2][3] = {{c, a, b}, {d, b, a}}, then[2][3] = {{c, a, d}, {d, b, c}};
    if (worst_shape(then, 2) < LEAST_GAIN * worst_shape(now, 2) ||
        csg_remesh_is_crease(r, corner) || !csg_corners_can_flip(m, corner))
        return false;
    csg_vec3 left = csg_vec3_normalize(csg_triangle_cross(c, a, d));
    csg_vec3 right = csg_vec3_normalize(csg_triangle_cross(d, b, c));
    if (csg_vec3_dot(left, right) < FLAT_COS || turns_over(now[0], then[0]) ||
        turns_over(now[1], then[1]) || turns_over(now[0], then[1]) || turns_over(now[1], then[0]) ||
        !csg_remesh_brackets(r, then, 2))
        return false;
    const uint32_t *v = m->vertex, a_id = v[corner], b_id = v[csg_corner_next(corner)];
    const uint32_t ids[2][3] = {{v[apex], a_id, v[other]}, {v[other], b_id, v[apex]}};
    const csg_crossing_change change = {.at = then,
                                        .vertex = ids,
                                        .count = 2,
                                        .vertices = {CSG_CORNER_NONE, CSG_CORNER_NONE},
                                        .triangles = {corner / 3, other / 3}};
    if (csg_crossing_is_made(&r->crossing, &change))
        return false;
    csg_corners_flip(&r->corners, corner);
    csg_crossing_update(&r->crossing, corner / 3);
    csg_crossing_update(&r->crossing, other / 3);
    return true;
}

/* ---- the passes -------------------------------------------------------------------------------
 */

static uint64_t flip_all(csg_remesh *r)
{
    uint64_t changes = 0;
    for (uint32_t c = 0; c < 3 * r->corners.triangle_count; c++)
        if (csg_corners_is_live(&r->corners, c / 3) &&
            csg_corner_previous(c) < r->corners.across[csg_corner_previous(c)])
            changes += flip(r, c);
    return changes;
}

static uint64_t move_all(csg_remesh *r, fan *f)
{
    uint64_t changes = 0;
    for (uint32_t v = 0; v < r->corners.vertex_count; v++)
        if (r->corners.corner[v] != CSG_CORNER_NONE)
            changes += move(r, v, f);
    return changes;
}

csgm_status csg_improve(csg_remesh *r)
{
    csg_mesh_work *w = r->work;
    fan *f = csg_memory_alloc(r->memory, sizeof *f);
    if (!f)
        return csg_context_no_memory(w->context);
    csgm_status status = CSGM_OK;
    uint64_t changes = 1;
    for (int pass = 0; pass < PASSES && changes && status == CSGM_OK; pass++) {
        changes = flip_all(r);
        changes += move_all(r, f);
        if (csg_mesh_should_stop(w))
            status = csg_mesh_why_stopped(w);
    }
    csg_memory_release(r->memory, f, sizeof *f);
    return status;
}
