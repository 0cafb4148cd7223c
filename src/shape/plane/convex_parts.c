/* SPDX-License-Identifier: MIT
 * A clean outline -> convex loops: triangles, joined across every edge between two of them whose
 * ends stay convex without it (Hertel, Mehlhorn, FCT 1983): at most four times the fewest.
 */
#include <stdlib.h>
#include <string.h>

#include "shape/plane/polygons.h"

typedef struct half_edge {
    uint32_t from, next, previous, twin; /* NONE: an edge of the outline, or joined across */
    bool gone;
} half_edge;

enum { NONE = UINT32_MAX };

typedef struct edge_key {
    uint32_t low, high, half;
} edge_key;

static int by_ends(const void *a, const void *b)
{
    const edge_key *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->half < y->half ? -1 : x->half > y->half;
}

static void link_triangles(half_edge *edges, edge_key *keys, const uint32_t *indices, size_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t first = i - i % 3;
        edges[i] = (half_edge){indices[i], first + (i + 1) % 3, first + (i + 2) % 3, NONE, false};
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = indices[i], b = indices[edges[i].next];
        keys[i] = (edge_key){a < b ? a : b, a < b ? b : a, i};
    }
    qsort(keys, count, sizeof *keys, by_ends);
    for (size_t i = 0; i + 1 < count; i++)
        if (keys[i].low == keys[i + 1].low && keys[i].high == keys[i + 1].high) {
            edges[keys[i].half].twin = keys[i + 1].half;
            edges[keys[i + 1].half].twin = keys[i].half;
        }
}

/* Does b lie on the left of the way from a to c, or on it? */
static bool turns_left(const csg_vec2 *points, uint32_t a, uint32_t b, uint32_t c)
{
    csg_vec2 p = points[a], q = points[b], r = points[c];
    return (q.x - p.x) * (r.y - q.y) - (q.y - p.y) * (r.x - q.x) >= 0;
}

/* Where this edge begins: is the corner convex without it? */
static bool may_go(const half_edge *edges, const csg_vec2 *points, uint32_t edge)
{
    const half_edge *twin = &edges[edges[edge].twin];
    uint32_t before = edges[edges[edge].previous].from;
    uint32_t behind = edges[edges[twin->next].next].from;
    return turns_left(points, before, edges[edge].from, behind);
}

static void join_across(half_edge *edges, uint32_t edge)
{
    uint32_t twin = edges[edge].twin;
    edges[edges[edge].previous].next = edges[twin].next;
    edges[edges[twin].next].previous = edges[edge].previous;
    edges[edges[twin].previous].next = edges[edge].next;
    edges[edges[edge].next].previous = edges[twin].previous;
    edges[edge].gone = edges[twin].gone = true;
}

/* Each loop once; it is `gone` then. */
static bool take_loops(half_edge *edges, size_t count, const csg_vec2 *points, csg_outline *out)
{
    bool ok = true;
    for (size_t i = 0; i < count && ok; i++) {
        if (edges[i].gone)
            continue;
        for (uint32_t at = (uint32_t)i; ok && !edges[at].gone; at = edges[at].next) {
            ok = csg_outline_add(out, points[edges[at].from]);
            edges[at].gone = true;
        }
        ok = ok && csg_outline_close(out);
    }
    return ok;
}

csgm_status csg_polygons_convex_parts(const csg_outline *in, csg_memory *memory, csg_outline *out)
{
    uint32_t *indices = NULL;
    size_t count = 0;
    csg_outline_init(out, memory);
    csgm_status status = csg_polygons_triangulate(in, memory, &indices, &count);
    if (status != CSGM_OK || !count)
        return status;
    half_edge *edges = csg_memory_alloc(memory, count * sizeof *edges);
    edge_key *keys = csg_memory_alloc(memory, count * sizeof *keys);
    bool ok = edges && keys;
    if (ok) {
        link_triangles(edges, keys, indices, count);
        for (uint32_t i = 0; i < count; i++)
            if (edges[i].twin != NONE && !edges[i].gone && may_go(edges, in->points, i) &&
                may_go(edges, in->points, edges[i].twin))
                join_across(edges, i);
        ok = take_loops(edges, count, in->points, out);
    }
    csg_memory_release(memory, edges, count * sizeof *edges);
    csg_memory_release(memory, keys, count * sizeof *keys);
    csg_memory_release(memory, indices, count * sizeof *indices);
    if (ok)
        return CSGM_OK;
    csg_outline_release(out);
    return CSGM_ERR_MEMORY;
}
