/* SPDX-License-Identifier: MIT
 * A solid is cut by the planes of its own triangles (a binary space partition: Thibault, Naylor,
 * SIGGRAPH 1987), but only by planes that have some of the surface before them, and no cell is cut
 * whose surface is convex: there the solid is what lies behind all of its planes. A cell without
 * surface is wholly inside or outside, as the side of its last plane is.
 */
#include "shape/polyhedra/convex_parts.h"

#include <math.h>
#include <string.h>

#include "shape/polyhedra/convex_cell.h"

typedef struct wall { /* a half-space that a cell lies in, and those before it */
    csg_cut_plane within;
    const struct wall *outer;
} wall;

typedef struct cell {
    const wall *walls;
    csg_facet *facets; /* of the surface, in it */
    size_t count;
} cell;

typedef struct cutting {
    csg_arena arena;
    double slack;
    csg_box box; /* around the solid */
    cell *work;  /* a stack */
    size_t work_count, work_capacity;
    uint32_t *last_tried; /* per plane: the turn in which it was tried last */
    uint32_t turn;
    uint64_t tests, points; /* facets held against planes, corners made */
    size_t most;
    csg_convex_parts *parts;
    csgm_status status;
} cutting;

static const uint64_t most_tests = 100000000, most_points = 4000000; /* some seconds, 100 MB */

static bool fail(cutting *c, csgm_status status)
{
    if (c->status == CSGM_OK)
        c->status = status;
    return false;
}

/* ---- parts ----------------------------------------------------------------------------------- */

void csg_convex_parts_init(csg_convex_parts *parts, csg_memory *memory)
{
    *parts = (csg_convex_parts){.memory = memory};
}

void csg_convex_parts_release(csg_convex_parts *parts)
{
    csg_memory_release(parts->memory, parts->points, parts->point_capacity * sizeof *parts->points);
    csg_memory_release(parts->memory, parts->ends, parts->capacity * sizeof *parts->ends);
    csg_convex_parts_init(parts, parts->memory);
}

bool csg_convex_parts_add(csg_convex_parts *parts, const csg_vec3 *points, size_t count)
{
    if (!csg_memory_reserve(parts->memory, (void **)&parts->points, &parts->point_capacity,
                            parts->point_count + count, sizeof *points) ||
        !csg_memory_reserve(parts->memory, (void **)&parts->ends, &parts->capacity,
                            parts->count + 1, sizeof *parts->ends))
        return false;
    memcpy(parts->points + parts->point_count, points, count * sizeof *points);
    parts->point_count += count;
    parts->ends[parts->count++] = parts->point_count;
    return true;
}

/* What lies within the cell's walls and behind its facets. */
static bool add_part(cutting *c, const cell *of)
{
    csg_convex_cell solid;
    csg_vec3 *corners;
    size_t count = 0;
    csg_arena_mark mark = csg_arena_get_mark(&c->arena);
    bool ok = csg_convex_cell_begin(&solid, &c->arena, c->box, c->slack);
    for (const wall *at = of->walls; at && ok; at = at->outer)
        ok = csg_convex_cell_cut(&solid, &at->within);
    for (size_t i = 0; i < of->count && ok; i++)
        ok = csg_convex_cell_cut(&solid, &of->facets[i].plane);
    ok = ok && csg_convex_cell_corners(&solid, &corners, &count);
    if (ok && count > 3) {
        if (c->parts->count >= c->most)
            return fail(c, CSGM_ERR_LIMIT);
        ok = csg_convex_parts_add(c->parts, corners, count);
    }
    csg_arena_release_to(&c->arena, mark);
    return ok || fail(c, CSGM_ERR_MEMORY);
}

/* ---- cutting --------------------------------------------------------------------------------- */

/* Facets that lie before the plane, or are cut by it, count against it; -1: none does. */
static double cost_of(cutting *c, const cell *of, const csg_cut_plane *plane)
{
    size_t before = 0, behind = 0, cut = 0;
    for (size_t i = 0; i < of->count; i++) {
        double low, high;
        csg_facet_reach(&of->facets[i], plane, &low, &high);
        bool is_before = high > c->slack, is_behind = low < -c->slack;
        cut += is_before && is_behind;
        before += is_before;
        behind += is_behind;
    }
    c->tests += of->count;
    if (before == 0)
        return -1;
    double uneven = before > behind ? (double)(before - behind) : (double)(behind - before);
    return 1 + 8 * (double)cut + uneven;
}

/* The best of some of the planes that have surface before them; the number of facets where none
 * has: the surface is convex there. Facets in one plane have it tried once. */
static size_t choose(cutting *c, const cell *of)
{
    enum { TRIED = 24 };
    size_t best = of->count, found = 0, step = of->count / TRIED + 1;
    double least = INFINITY;
    c->turn++;
    for (size_t offset = 0; offset < step && found == 0; offset++)
        for (size_t i = offset; i < of->count; i += step) {
            uint32_t *tried = &c->last_tried[of->facets[i].number];
            if (*tried == c->turn)
                continue;
            *tried = c->turn;
            double cost = cost_of(c, of, &of->facets[i].plane);
            found += cost >= 0;
            if (cost >= 0 && cost < least) {
                least = cost;
                best = i;
            }
        }
    return best;
}

static bool push_cell(cutting *c, const cell *of)
{
    void *work = c->work;
    if (!csg_memory_reserve(c->arena.memory, &work, &c->work_capacity, c->work_count + 1,
                            sizeof *c->work))
        return fail(c, CSGM_ERR_MEMORY);
    c->work = work;
    c->work[c->work_count++] = *of;
    return true;
}

/* A cell more behind a plane; without surface it is solid, or (is_outside) it is nothing. */
static bool go_on(cutting *c, const cell *half, bool is_outside)
{
    if (half->count)
        return push_cell(c, half);
    return is_outside || add_part(c, half);
}

/* Facets in the plane are the border of both halves and are in neither. Where bodies touch there
 * are some of both directions, and both halves are solid. */
static bool cut_cell(cutting *c, const cell *of, csg_cut_plane plane)
{
    wall *walls = csg_arena_calloc(&c->arena, 2, sizeof *walls);
    cell halves[2] = {{&walls[0], csg_arena_calloc(&c->arena, of->count, sizeof(csg_facet)), 0},
                      {&walls[1], csg_arena_calloc(&c->arena, of->count, sizeof(csg_facet)), 0}};
    if (!walls || !halves[0].facets || !halves[1].facets)
        return fail(c, CSGM_ERR_MEMORY);
    walls[0] = (wall){plane, of->walls};
    walls[1] = (wall){csg_cut_plane_turned(&plane), of->walls};
    bool touches = false;
    for (size_t i = 0; i < of->count; i++) {
        csg_facet parts[2];
        if (!csg_facet_split(&c->arena, &of->facets[i], &plane, c->slack, parts))
            return fail(c, CSGM_ERR_MEMORY);
        bool is_in_plane = !parts[0].count && !parts[1].count;
        touches |= is_in_plane && csg_vec3_dot(of->facets[i].plane.normal, plane.normal) < 0;
        for (int k = 0; k < 2; k++)
            if (parts[k].count) {
                halves[k].facets[halves[k].count++] = parts[k];
                c->points += parts[k].count;
            }
    }
    return go_on(c, &halves[0], false) && go_on(c, &halves[1], !touches);
}

/* Facets that lie in one plane get the same one. */
static bool number_planes(cutting *c, cell *whole)
{
    size_t count = 0;
    csg_cut_plane *planes = csg_arena_calloc(&c->arena, whole->count, sizeof *planes);
    c->last_tried = csg_arena_calloc(&c->arena, whole->count, sizeof *c->last_tried);
    if (!planes || !c->last_tried)
        return fail(c, CSGM_ERR_MEMORY);
    for (size_t i = 0; i < whole->count; i++) {
        csg_facet *facet = &whole->facets[i];
        size_t at = count;
        double low = 1, high = 1;
        for (; at > 0 && (low < -c->slack || high > c->slack); at--) {
            low = high = 1;
            if (csg_vec3_dot(planes[at - 1].normal, facet->plane.normal) > 0.5)
                csg_facet_reach(facet, &planes[at - 1], &low, &high);
        }
        c->tests += count - at;
        bool is_known = low >= -c->slack && high <= c->slack;
        if (!is_known)
            planes[at = count++] = facet->plane;
        facet->plane = planes[at];
        facet->number = (uint32_t)at;
    }
    return c->tests <= most_tests || fail(c, CSGM_ERR_LIMIT);
}

static bool take_triangles(cutting *c, const csg_triangles *solid)
{
    cell whole = {NULL, csg_arena_calloc(&c->arena, solid->count + 1, sizeof(csg_facet)), 0};
    for (size_t i = 0; i < solid->count && whole.facets; i++) {
        csg_vec3 *corners = csg_arena_calloc(&c->arena, 3, sizeof *corners);
        if (!corners)
            return fail(c, CSGM_ERR_MEMORY);
        for (int k = 0; k < 3; k++)
            corners[k] = solid->points[solid->corners[i][k]];
        csg_facet facet = {.points = corners, .count = 3};
        if (csg_facet_find_plane(&facet, c->slack))
            whole.facets[whole.count++] = facet;
    }
    if (!whole.facets)
        return fail(c, CSGM_ERR_MEMORY);
    return whole.count == 0 || (number_planes(c, &whole) && push_cell(c, &whole));
}

csgm_status csg_convex_parts_find(const csg_triangles *solid, double slack, size_t most,
                                  csg_convex_parts *parts)
{
    cutting c = {.slack = slack, .most = most, .parts = parts, .status = CSGM_OK};
    csg_arena_init(&c.arena, parts->memory);
    c.box = csg_box_grow(csg_triangles_box(solid), 16 * slack);
    bool ok = take_triangles(&c, solid);
    while (ok && c.work_count) {
        cell now = c.work[--c.work_count];
        size_t chosen = choose(&c, &now);
        ok = chosen < now.count ? cut_cell(&c, &now, now.facets[chosen].plane) : add_part(&c, &now);
        if (ok && (c.tests > most_tests || c.points > most_points))
            ok = fail(&c, CSGM_ERR_LIMIT);
    }
    csg_memory_release(c.arena.memory, c.work, c.work_capacity * sizeof *c.work);
    csg_arena_reset(&c.arena);
    return c.status;
}
