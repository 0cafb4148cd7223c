/* SPDX-License-Identifier: MIT
 * Marching squares on a quadtree (trace.h). A square is divided unless the value at its centre and
 * the Lipschitz constant say that nothing of the contour lies in it, so few cells off the contour
 * are seen. Each cell of the last level contributes the ways of the contour through it, inside on
 * the left, from lattice edge to lattice edge; both cells at an edge see the same ends, so the ways
 * close to loops. Their corners are roots of the field along the lattice edges.
 */
#include "scene/outlines/trace.h"

#include <stdlib.h>

#include "scene/boxes/bounds.h"
#include "scene/reference.h"

enum { ROOT_STEPS = 30 };
/* How often it asks whether to end: a field may be a formula of a millisecond. */
enum { EVALUATIONS_PER_QUESTION = 16 };

/* Lattice edges are named by their lower end and direction: x, y, upwards or not. */
typedef uint64_t edge_name;

typedef struct way {
    edge_name from, to;
} way;

typedef struct square {
    uint32_t x, y, size; /* in cells */
} square;

typedef struct tracer {
    const csgm_scene *scene;
    csg_memory *memory;
    csg_vec2 origin;
    double cell, lipschitz;
    way *ways; /* sorted by from, once all are there */
    size_t way_count, way_capacity;
    square *waiting;
    size_t waiting_count, waiting_capacity;
    csgm_status status;
} tracer;

static double value_at(tracer *t, double x, double y)
{
    double value = csg_reference_eval(t->scene, csg_vec3_make(x, y, 0), &t->status).value;
    return isnan(value) ? -INFINITY : value;
}

/* Coordinates in cells; computed from them alone, so every cell sees the same point. */
static double value_on(tracer *t, double x, double y)
{
    return value_at(t, t->origin.x + x * t->cell, t->origin.y + y * t->cell);
}

/* ---- ways through cells ------------------------------------------------------------------- */

static edge_name name_edge(uint32_t x, uint32_t y, bool is_upwards)
{
    return (uint64_t)x << 33 | (uint64_t)y << 1 | is_upwards;
}

static bool add_way(tracer *t, edge_name from, edge_name to)
{
    void *ways = t->ways;
    if (!csg_memory_reserve(t->memory, &ways, &t->way_capacity, t->way_count + 1,
                            sizeof *t->ways)) {
        t->status = CSGM_ERR_MEMORY;
        return false;
    }
    t->ways = ways;
    t->ways[t->way_count++] = (way){from, to};
    return true;
}

/* Corners counter-clockwise from the lower left; edge k runs from corner k to the next. Around the
 * cell, the contour comes in where inside follows outside, and goes out where outside
 * follows inside. With two of each, the value in the middle tells whether the two inside corners
 * hang together. */
static bool march(tracer *t, uint32_t x, uint32_t y)
{
    const edge_name edges[4] = {name_edge(x, y, false), name_edge(x + 1, y, true),
                                name_edge(x, y + 1, false), name_edge(x, y, true)};
    bool inside[4];
    for (uint32_t k = 0; k < 4; k++)
        inside[k] = value_on(t, x + (k == 1 || k == 2), y + (k >= 2)) >= 0;
    bool is_saddle = inside[0] == inside[2] && inside[1] == inside[3] && inside[0] != inside[1];
    bool hangs_together = is_saddle && value_on(t, x + 0.5, y + 0.5) >= 0;
    for (uint32_t k = 0; k < 4; k++) {
        if (!inside[k] || inside[(k + 1) % 4]) /* on edge k the contour comes into the cell */
            continue;
        /* around this run of inside corners, or straight to the next run */
        uint32_t out = (k + 3) % 4;
        while (!is_saddle && inside[out])
            out = (out + 3) % 4;
        if (hangs_together)
            out = (k + 1) % 4;
        if (!add_way(t, edges[k], edges[out]))
            return false;
    }
    return t->status == CSGM_OK;
}

/* ---- quadtree ----------------------------------------------------------------------------- */

static bool push_square(tracer *t, square s)
{
    void *waiting = t->waiting;
    if (!csg_memory_reserve(t->memory, &waiting, &t->waiting_capacity, t->waiting_count + 1,
                            sizeof *t->waiting)) {
        t->status = CSGM_ERR_MEMORY;
        return false;
    }
    t->waiting = waiting;
    t->waiting[t->waiting_count++] = s;
    return true;
}

static bool is_crossed(tracer *t, square s)
{
    double half = 0.5 * s.size;
    double reach = half * t->cell * 1.4142135623731 * t->lipschitz * (1 + 1e-9);
    return !(fabs(value_on(t, s.x + half, s.y + half)) > reach);
}

static bool visit(tracer *t, square s)
{
    if (!is_crossed(t, s))
        return t->status == CSGM_OK;
    if (s.size == 1)
        return march(t, s.x, s.y);
    uint32_t half = s.size / 2;
    for (uint32_t k = 0; k < 4; k++) {
        if (!push_square(t, (square){s.x + (k & 1) * half, s.y + (k >> 1) * half, half}))
            return false;
    }
    return true;
}

/* ---- loops -------------------------------------------------------------------------------- */

static int compare_ways(const void *left, const void *right)
{
    const way *a = left, *b = right;
    return (a->from > b->from) - (a->from < b->from);
}

static way *way_from(const tracer *t, edge_name from)
{
    const way key = {from, 0};
    return bsearch(&key, t->ways, t->way_count, sizeof key, compare_ways);
}

/* Where the contour crosses the edge; bisection, which nothing misleads. */
static csg_vec2 root_on(tracer *t, edge_name edge)
{
    double x = (double)(edge >> 33), y = (double)(edge >> 1 & UINT32_MAX);
    double dx = edge & 1 ? 0 : 1, dy = edge & 1 ? 1 : 0, low = 0, high = 1;
    bool is_low_inside = value_on(t, x, y) >= 0;
    for (int i = 0; i < ROOT_STEPS; i++) {
        double middle = 0.5 * (low + high);
        bool is_inside = value_on(t, x + middle * dx, y + middle * dy) >= 0;
        *(is_inside == is_low_inside ? &low : &high) = middle;
    }
    double at = 0.5 * (low + high);
    return (csg_vec2){t->origin.x + (x + at * dx) * t->cell, t->origin.y + (y + at * dy) * t->cell};
}

static const edge_name taken = UINT64_MAX;

/* Follows the ways from one on and takes them. */
static bool follow(tracer *t, way *first, csg_outline *out)
{
    for (way *w = first; w && w->to != taken;) {
        if (csg_memory_has_ended(t->memory) || !csg_outline_add(out, root_on(t, w->from)))
            return false;
        edge_name to = w->to;
        w->to = taken;
        w = way_from(t, to);
    }
    return csg_outline_close(out);
}

static bool close_loops(tracer *t, csg_outline *out)
{
    if (t->way_count)
        qsort(t->ways, t->way_count, sizeof *t->ways, compare_ways);
    for (size_t i = 0; i < t->way_count; i++) {
        if (t->ways[i].to != taken && !follow(t, &t->ways[i], out))
            return false;
    }
    return true;
}

/* ---- all ---------------------------------------------------------------------------------- */

static csgm_status trace(tracer *t, uint32_t cells, csg_outline *out)
{
    if (!push_square(t, (square){0, 0, cells}))
        return t->status;
    for (size_t seen = 0; t->waiting_count; seen++) {
        if (!visit(t, t->waiting[--t->waiting_count]))
            return t->status;
        if (seen % EVALUATIONS_PER_QUESTION == 0 && csg_memory_has_ended(t->memory))
            return CSGM_ERR_MEMORY;
    }
    if (!close_loops(t, out))
        return CSGM_ERR_MEMORY;
    return t->status;
}

csgm_status csg_trace(const csgm_scene *scene, uint32_t cells, csg_outline *out)
{
    csg_box box = csg_bounds_of_solid(scene);
    double side = fmax(box.max.x - box.min.x, box.max.y - box.min.y);
    tracer t = {
        .scene = scene, .memory = &scene->context->memory, .lipschitz = csg_scene_lipschitz(scene)};
    csg_outline_init(out, t.memory);
    if (csg_box_is_empty(box))
        return CSGM_OK;
    if (!(isfinite(box.min.x) && isfinite(box.min.y) && isfinite(side)) || !(t.lipschitz > 0))
        return CSGM_ERR_SCENE;
    if (!(side > 0))
        return CSGM_OK;
    t.cell = side / (cells - 2); /* a cell of outside all around */
    t.origin = (csg_vec2){box.min.x - t.cell, box.min.y - t.cell};
    csgm_status status = trace(&t, cells, out);
    csg_memory_release(t.memory, t.ways, t.way_capacity * sizeof *t.ways);
    csg_memory_release(t.memory, t.waiting, t.waiting_capacity * sizeof *t.waiting);
    if (status)
        csg_outline_release(out);
    return status;
}
