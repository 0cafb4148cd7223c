/* SPDX-License-Identifier: MIT
 * Collapsing, flipping and smoothing in turn; see improve.h. All changes are made one after the
 * other in the order of numbers.
 */
#include "mesh/reshape/improve.h"

#include <math.h>

#include "mesh/reshape/improver.h"

/* Sines of angles: what is better than that, 25 degrees, may get worse as long as it stays so. */
static const double GOOD = 0.42, BAD = 0.36;

/* ---- moving -----------------------------------------------------------------------------------
 */

static bool gather(csg_improver *m, uint32_t vertex)
{
    csg_patch *p = &m->patch;
    const csg_remesh *r = m->remesh;
    const csg_corners *corners = &r->corners;
    uint32_t first = corners->corner[vertex], c = first;
    p->now_count = 0;
    do {
        if (p->now_count == CSG_PATCH_MOST)
            return false;
        uint32_t i = p->now_count++;
        p->vertex[i][0] = vertex;
        p->vertex[i][1] = corners->vertex[csg_corner_next(c)];
        p->vertex[i][2] = corners->vertex[csg_corner_previous(c)];
        for (int k = 0; k < 3; k++)
            p->now[i][k] = p->then[i][k] = r->at[p->vertex[i][k]];
        c = csg_corner_swing(corners, c);
    } while (c != first);
    p->then_count = p->now_count;
    p->vertices[0] = vertex;
    p->vertices[1] = p->triangles[0] = p->triangles[1] = CSG_CORNER_NONE;
    return true;
}

/* The mean of the triangles' centroids by their areas: equal areas pull together, few large ones do
 * not push. */
static csg_vec3 middle_of(const csg_patch *p)
{
    csg_vec3 sum = {0, 0, 0};
    double total = 0;
    for (uint32_t i = 0; i < p->now_count; i++) {
        const csg_vec3 *v = p->now[i];
        double area = csg_vec3_norm(csg_triangle_cross(v[0], v[1], v[2]));
        csg_vec3 center = csg_vec3_add(v[0], csg_vec3_add(v[1], v[2]));
        sum = csg_vec3_add(sum, csg_vec3_scale(center, area / 3));
        total += area;
    }
    return total > 0 ? csg_vec3_scale(sum, 1 / total) : p->now[0][0];
}

/* The middle of a crease's two neighbours, where it is straight there. */
static bool middle_of_crease(const csg_remesh *r, uint32_t vertex, csg_vec3 *out)
{
    static const double STRAIGHT = 1e-5; /* of a cell */
    const csg_corners *corners = &r->corners;
    uint32_t first = corners->corner[vertex], c = first, count = 0;
    csg_vec3 end[2] = {{0, 0, 0}, {0, 0, 0}};
    do {
        if (csg_remesh_is_crease(r, c)) {
            if (count == 2)
                return false;
            end[count++] = csg_remesh_corner(r, csg_corner_next(c));
        }
        c = csg_corner_swing(corners, c);
    } while (c != first);
    if (count != 2)
        return false;
    csg_vec3 way = csg_vec3_normalize(csg_vec3_sub(end[1], end[0]));
    csg_vec3 off = csg_vec3_sub(r->at[vertex], end[0]);
    *out = csg_vec3_scale(csg_vec3_add(end[0], end[1]), 0.5);
    return csg_vec3_norm(csg_vec3_cross(way, off)) <= STRAIGHT * r->cell;
}

static bool move_to(csg_improver *m, uint32_t vertex, csg_vec3 at)
{
    static const double LEAST_GAIN = 1.001;
    csg_remesh *r = m->remesh;
    csg_patch *p = &m->patch;
    csg_look_at_vertex look = {{0}, {0}};
    if (r->kind[vertex] == CSG_VERTEX_SMOOTH && !csg_remesh_project(r, &at, r->cell))
        return false;
    for (uint32_t i = 0; i < p->then_count; i++)
        p->then[i][0] = at;
    double before = csg_worst_sine((const csg_vec3(*)[3])p->now, p->now_count);
    double after = csg_worst_sine((const csg_vec3(*)[3])p->then, p->then_count);
    if (after < fmin(LEAST_GAIN * before, GOOD) || !csg_improve_looks_alike(m, vertex, at, &look) ||
        !csg_patch_is_sound(m))
        return false;
    r->at[vertex] = at;
    csg_triangle_tree_update_around(&r->tree, vertex);
    if (r->looks)
        r->looks[vertex] = look;
    return true;
}

static bool move(csg_improver *m, uint32_t vertex, double enough)
{
    static const double LEAST_STEP = 0.01; /* of a cell */
    csg_remesh *r = m->remesh;
    csg_vec3 at;
    if (r->kind[vertex] == CSG_VERTEX_CORNER || !gather(m, vertex) ||
        csg_worst_sine((const csg_vec3(*)[3])m->patch.now, m->patch.now_count) > enough)
        return false;
    if (r->kind[vertex] == CSG_VERTEX_SMOOTH)
        at = middle_of(&m->patch);
    else if (!middle_of_crease(r, vertex, &at))
        return false;
    csg_vec3 step = csg_vec3_sub(at, r->at[vertex]);
    for (int half = 0; half < 3; half++, step = csg_vec3_scale(step, 0.5)) {
        if (csg_vec3_norm(step) < LEAST_STEP * r->cell)
            return false;
        if (move_to(m, vertex, csg_vec3_add(m->patch.now[0][0], step)))
            return true;
    }
    return false;
}

/* ---- flipping ---------------------------------------------------------------------------------
 */

static bool flip(csg_improver *m, uint32_t corner)
{
    static const double FLAT_COS = 0.8, LEAST_GAIN = 1.01;
    csg_remesh *r = m->remesh;
    csg_patch *p = &m->patch;
    const csg_corners *corners = &r->corners;
    uint32_t apex = csg_corner_previous(corner), other = corners->across[apex];
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 c = csg_remesh_corner(r, apex), d = csg_remesh_corner(r, other);
    const csg_vec3 now[2][3] = {{c, a, b}, {d, b, a}}, then[2][3] = {{c, a, d}, {d, b, c}};
    if (csg_worst_sine(then, 2) < LEAST_GAIN * csg_worst_sine(now, 2) ||
        csg_remesh_is_crease(r, corner) || !csg_corners_can_flip(corners, corner))
        return false;
    csg_vec3 left = csg_vec3_normalize(csg_triangle_cross(c, a, d));
    csg_vec3 right = csg_vec3_normalize(csg_triangle_cross(d, b, c));
    if (csg_vec3_dot(left, right) < FLAT_COS)
        return false;
    const uint32_t *v = corners->vertex, a_id = v[corner], b_id = v[csg_corner_next(corner)];
    const uint32_t ids[2][3] = {{v[apex], a_id, v[other]}, {v[other], b_id, v[apex]}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            p->now[i][k] = now[i][k];
            p->then[i][k] = then[i][k];
            p->vertex[i][k] = ids[i][k];
        }
    p->now_count = p->then_count = 2;
    p->vertices[0] = p->vertices[1] = CSG_CORNER_NONE;
    p->triangles[0] = corner / 3;
    p->triangles[1] = other / 3;
    if (!csg_patch_is_sound(m))
        return false;
    csg_corners_flip(&r->corners, corner);
    csg_triangle_tree_update(&r->tree, corner / 3);
    csg_triangle_tree_update(&r->tree, other / 3);
    return true;
}

/* ---- the passes -------------------------------------------------------------------------------
 */

/* Not when time is up: asked from time to time, for a pass over millions takes a while. */
static bool goes_on(const csg_improver *m, uint32_t index)
{
    enum { PER_QUESTION = 1024 };
    return index % PER_QUESTION != 0 || !csg_mesh_should_stop(m->remesh->watch);
}

/* Of each bad triangle the shortest edge that may go. */
static uint64_t collapse_all(csg_improver *m)
{
    csg_remesh *r = m->remesh;
    uint64_t changes = 0;
    for (uint32_t t = 0; t < r->corners.triangle_count && goes_on(m, t); t++) {
        if (!csg_corners_is_live(&r->corners, t))
            continue;
        const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2)};
        if (csg_triangle_least_sine(v) > BAD)
            continue;
        double length[3];
        for (int k = 0; k < 3; k++)
            length[k] = csg_vec3_norm(csg_vec3_sub(v[(k + 1) % 3], v[k]));
        uint32_t least = length[1] < length[0] ? 1 : 0;
        least = length[2] < length[least] ? 2 : least;
        changes += csg_improve_collapse(m, 3 * t + least);
    }
    return changes;
}

static uint64_t flip_all(csg_improver *m)
{
    const csg_corners *corners = &m->remesh->corners;
    uint64_t changes = 0;
    for (uint32_t c = 0; c < 3 * corners->triangle_count && goes_on(m, c); c++)
        if (csg_corners_is_live(corners, c / 3) &&
            csg_corner_previous(c) < corners->across[csg_corner_previous(c)])
            changes += flip(m, c);
    return changes;
}

static uint64_t move_all(csg_improver *m, double enough)
{
    const csg_corners *corners = &m->remesh->corners;
    uint64_t changes = 0;
    for (uint32_t v = 0; v < corners->vertex_count && goes_on(m, v); v++)
        if (corners->corner[v] != CSG_CORNER_NONE)
            changes += move(m, v, enough);
    return changes;
}

/* At first everything that is not quite good is smoothed, later what is bad. */
static csgm_status run_passes(csg_improver *m)
{
    enum { PASSES = 8, SMOOTHING = 3 };
    csg_mesh_watch *watch = m->remesh->watch;
    for (int pass = 0; pass < PASSES; pass++) {
        uint64_t changes = collapse_all(m);
        changes += flip_all(m);
        changes += move_all(m, pass < SMOOTHING ? 0.55 : GOOD);
        if (csg_mesh_should_stop(watch))
            return csg_mesh_why_stopped(watch);
        if (!changes)
            break;
    }
    return CSGM_OK;
}

csgm_status csg_improve(csg_remesh *r, bool thinned)
{
    csg_improver *m = csg_memory_alloc(r->memory, sizeof *m);
    if (!m)
        return csg_context_no_memory(r->context);
    m->remesh = r;
    m->thinned = thinned;
    csgm_status status = csg_improver_measure(m) ? CSGM_OK : csg_context_no_memory(r->context);
    if (status == CSGM_OK)
        status = run_passes(m);
    csg_memory_release(r->memory, m, sizeof *m);
    return status;
}
