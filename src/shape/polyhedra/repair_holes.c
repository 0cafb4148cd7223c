/* SPDX-License-Identifier: MIT
 * Where more triangles run an edge one way than the other, edges back are needed. At every point as
 * many needed edges come in as go out (the boundary of a boundary is nothing), so a walk along
 * unused ones never sticks; whenever it comes back to a point it is on, a loop is cut off. Each
 * loop is filled with triangles over its own points, so the chain closes and no edge is left.
 */
#include "shape/polyhedra/repair.h"

typedef struct walk {
    uint64_t *edges; /* from << 32 | to, sorted */
    size_t count;
    size_t *unused;    /* at the first edge of each point: the next one to take */
    uint32_t *path;    /* points */
    uint32_t *on_path; /* per point of the chain: its place in the path + 1, or 0 */
    size_t length;
} walk;

/* The first edge out of a point, which has one. */
static size_t first_out(const walk *w, uint32_t from)
{
    size_t low = 0, high = w->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (w->edges[middle] >> 32 < from)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static bool has_unused(const walk *w, uint32_t from, size_t *first)
{
    *first = first_out(w, from);
    size_t at = w->unused[*first];
    return at < w->count && w->edges[at] >> 32 == from;
}

static size_t count_needed(const csg_triangles *triangles, const csg_triangle_edges *edges)
{
    size_t count = 0;
    for (size_t i = 0; i < edges->count; i++) {
        int32_t net = csg_edge_net(triangles, edges, &edges->edges[i]);
        count += (size_t)(net < 0 ? -net : net);
    }
    return count;
}

static void list_needed(const csg_triangles *triangles, const csg_triangle_edges *edges, walk *w)
{
    size_t at = 0;
    for (size_t i = 0; i < edges->count; i++) {
        const csg_edge *edge = &edges->edges[i];
        int32_t net = csg_edge_net(triangles, edges, edge);
        uint64_t back = net > 0 ? (uint64_t)edge->high << 32 | edge->low
                                : (uint64_t)edge->low << 32 | edge->high;
        for (int32_t k = net < 0 ? -net : net; k > 0; k--)
            w->edges[at++] = back;
    }
    csg_sort_keys(w->edges, w->count);
    for (size_t i = 0; i < w->count; i++)
        w->unused[i] = i;
}

/* Fills the loop that ends the path, from `begin` on. Loops of no area (seams where points of one
 * side lie on edges of the other) are closed too, but are no holes. */
static bool close_loop(csg_arena *scratch, csg_triangles *triangles, walk *w, size_t begin,
                       uint64_t *effort, csg_repairs *repairs)
{
    size_t before = triangles->count, filled = 0;
    if (csg_memory_has_ended(triangles->memory) ||
        !csg_repair_fill_loop(scratch, triangles, w->path + begin, w->length - begin, effort))
        return false;
    for (size_t t = before; t < triangles->count; t++)
        filled += !csg_repair_is_flat(triangles, triangles->corners[t]);
    repairs->filled += filled;
    repairs->holes += filled > 0;
    return true;
}

/* From this point until it has no unused edge left. */
static bool walk_from(csg_arena *scratch, csg_triangles *triangles, walk *w, uint32_t point,
                      uint64_t *effort, csg_repairs *repairs)
{
    size_t first;
    w->path[0] = point;
    w->length = 1;
    w->on_path[point] = 1;
    while (has_unused(w, w->path[w->length - 1], &first)) {
        uint32_t to = (uint32_t)w->edges[w->unused[first]++];
        if (!w->on_path[to]) {
            w->path[w->length++] = to;
            w->on_path[to] = (uint32_t)w->length;
            continue;
        }
        size_t begin = w->on_path[to] - 1;
        for (size_t i = begin + 1; i < w->length; i++)
            w->on_path[w->path[i]] = 0;
        if (!close_loop(scratch, triangles, w, begin, effort, repairs))
            return false;
        w->path[begin] = to; /* filling moves corners */
        w->length = begin + 1;
    }
    w->on_path[point] = 0;
    return true;
}

bool csg_repair_fill(csg_arena *scratch, csg_triangles *triangles, const csg_triangle_edges *edges,
                     csg_repairs *repairs)
{
    walk w = {.count = count_needed(triangles, edges)};
    if (!w.count)
        return true;
    w.edges = csg_arena_alloc(scratch, w.count * sizeof *w.edges);
    w.unused = csg_arena_alloc(scratch, w.count * sizeof *w.unused);
    w.path = csg_arena_alloc(scratch, (w.count + 1) * sizeof *w.path);
    w.on_path = csg_arena_calloc(scratch, triangles->point_count, sizeof *w.on_path);
    if (!w.edges || !w.unused || !w.path || !w.on_path)
        return false;
    list_needed(triangles, edges, &w);
    uint64_t effort = 40000000; /* about a second */
    size_t first;
    for (size_t i = 0; i < w.count; i++) {
        uint32_t from = (uint32_t)(w.edges[i] >> 32);
        if (has_unused(&w, from, &first) &&
            !walk_from(scratch, triangles, &w, from, &effort, repairs))
            return false;
    }
    return true;
}
