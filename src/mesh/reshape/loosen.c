/* SPDX-License-Identifier: MIT
 * What stands in the way of collapses in flat parts: slivers that the first of them left, whose
 * removal would turn others over, and corners that only the small triangles at the beginning
 * showed. Edges are flipped as Lawson (1977) does, where the smallest angle grows.
 */
#include <math.h>
#include <string.h>

#include "mesh/reshape/decimate.h"

/* The two triangles over an edge, a b, as they are, (c, a, b) and (d, b, a), and as they would be,
 * (c, a, d) and (c, d, b). */
typedef struct quad {
    uint32_t a, b, c, d;
    csg_vec3 now[2][3], then[2][3];
} quad;

static quad quad_of(const csg_remesh *r, uint32_t corner)
{
    const csg_corners *m = &r->corners;
    uint32_t apex = csg_corner_previous(corner);
    quad q = {.a = m->vertex[corner],
              .b = m->vertex[csg_corner_next(corner)],
              .c = m->vertex[apex],
              .d = m->vertex[m->across[apex]]};
    csg_vec3 a = r->at[q.a], b = r->at[q.b], c = r->at[q.c], d = r->at[q.d];
    const csg_vec3 now[2][3] = {{c, a, b}, {d, b, a}}, then[2][3] = {{c, a, d}, {c, d, b}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            q.now[i][k] = now[i][k];
            q.then[i][k] = then[i][k];
        }
    return q;
}

/* Whether all four points lie in one plane, to rounding, and the new triangles face as it does. */
static bool is_plane(const csg_remesh *r, const quad *q)
{
    static const double ROUNDING = 2; /* of the tree's noise */
    csg_vec3 normal = {0, 0, 0}, middle = {0, 0, 0};
    for (int i = 0; i < 2; i++)
        normal = csg_vec3_add(normal, csg_triangle_cross(q->now[i][0], q->now[i][1], q->now[i][2]));
    const csg_vec3 at[4] = {q->now[0][0], q->now[0][1], q->now[0][2], q->now[1][0]};
    for (int k = 0; k < 4; k++)
        middle = csg_vec3_add(middle, csg_vec3_scale(at[k], 0.25));
    double most = ROUNDING * r->tree.noise, square = csg_vec3_dot(normal, normal);
    for (int k = 0; k < 4; k++) {
        double height = csg_vec3_dot(normal, csg_vec3_sub(at[k], middle));
        if (!(height * height <= most * most * square))
            return false;
    }
    for (int i = 0; i < 2; i++) {
        csg_vec3 own = csg_triangle_cross(q->then[i][0], q->then[i][1], q->then[i][2]);
        double most_long = csg_triangle_longest_side(q->then[i]);
        if (!(csg_vec3_dot(normal, own) > most * most_long * sqrt(square)))
            return false;
    }
    return true;
}

static bool looks_the_same(const csg_remesh *r, const quad *q)
{
    const csg_look_at_vertex *looks = r->looks;
    return !looks || (!memcmp(&looks[q->a], &looks[q->b], sizeof *looks) &&
                      !memcmp(&looks[q->a], &looks[q->c], sizeof *looks) &&
                      !memcmp(&looks[q->a], &looks[q->d], sizeof *looks));
}

/* Whether each sample of both triangles finds one that answers for it. */
static bool samples_go_over(csg_decimation *d, uint32_t corner, const quad *q)
{
    csg_collapse_room *room = d->room;
    const csg_remesh *r = d->remesh;
    const uint32_t ids[2][3] = {{q->c, q->a, q->d}, {q->c, q->d, q->b}};
    room->count = 2;
    room->gone = 0;
    room->triangle[0] = corner / 3;
    room->triangle[1] = r->corners.across[csg_corner_previous(corner)] / 3;
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            room->vertex[i][k] = ids[i][k];
            room->after[i][k] = q->then[i][k];
        }
        room->normal[i] = csg_triangle_cross(q->then[i][0], q->then[i][1], q->then[i][2]);
    }
    if (r->looks)
        room->look = r->looks[q->c];
    return csg_decimation_can_hand_over(d, q->c, r->error);
}

static bool flip(csg_decimation *d, uint32_t corner)
{
    static const double LEAST_GAIN = 1.01;
    csg_remesh *r = d->remesh;
    quad q = quad_of(r, corner);
    if (csg_worst_sine((const csg_vec3(*)[3])q.then, 2) <
            LEAST_GAIN * csg_worst_sine((const csg_vec3(*)[3])q.now, 2) ||
        !is_plane(r, &q) || !looks_the_same(r, &q) || !csg_corners_can_flip(&r->corners, corner) ||
        !samples_go_over(d, corner, &q))
        return false;
    csg_decimation_hand_over(d);
    csg_corners_flip(&r->corners, corner);
    csg_triangle_tree_update(&r->tree, d->room->triangle[0]);
    csg_triangle_tree_update(&r->tree, d->room->triangle[1]);
    const uint32_t of[4] = {q.a, q.b, q.c, q.d};
    for (int k = 0; k < 4; k++)
        d->state[of[k]] = CSG_VERTEX_FRESH;
    return true;
}

static bool flip_all(csg_decimation *d)
{
    const csg_corners *m = &d->remesh->corners;
    bool any = false;
    for (uint32_t c = 0; c < 3 * m->triangle_count; c++)
        if (csg_corners_is_live(m, c / 3) &&
            csg_corner_previous(c) < m->across[csg_corner_previous(c)] && flip(d, c))
            any = true;
    return any;
}

/* Kinds that are less than they were; their vertices are fresh. False: stopped, or without memory;
 * the watch knows. */
static bool ease_kinds(csg_decimation *d, bool *any)
{
    csg_remesh *r = d->remesh;
    uint32_t count = r->corners.vertex_count;
    uint8_t *before = csg_memory_alloc(r->memory, count);
    if (!before)
        return csg_mesh_stop_without_memory(r->watch);
    memcpy(before, r->kind, count);
    bool done = csg_remesh_ease_kinds(r);
    for (uint32_t v = 0; v < count; v++)
        if (before[v] != r->kind[v]) {
            d->state[v] = CSG_VERTEX_FRESH;
            *any = true;
        }
    csg_memory_release(r->memory, before, count);
    return done;
}

bool csg_decimation_loosen(csg_decimation *d, bool *any)
{
    enum { PASSES = 8 };
    *any = false;
    if (!ease_kinds(d, any))
        return false;
    for (int pass = 0; pass < PASSES && flip_all(d); pass++)
        *any = true;
    return true;
}
