/* SPDX-License-Identifier: MIT
 * Half-edges are counted into a list for each point (their lower one) and each short list is sorted
 * by the other point: linear, and near in memory what is near in the file.
 */
#include "shape/polyhedra/edges.h"

static void sift_down(uint64_t *keys, size_t root, size_t count)
{
    uint64_t key = keys[root];
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        child += child + 1 < count && keys[child + 1] > keys[child];
        if (keys[child] <= key)
            break;
        keys[root] = keys[child];
        root = child;
    }
    keys[root] = key;
}

static void insert_keys(uint64_t *keys, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        uint64_t key = keys[i];
        size_t at = i;
        for (; at > 0 && keys[at - 1] > key; at--)
            keys[at] = keys[at - 1];
        keys[at] = key;
    }
}

void csg_sort_keys(uint64_t *keys, size_t count)
{
    if (count <= 24) {
        insert_keys(keys, count);
        return;
    }
    for (size_t root = count / 2; root-- > 0;)
        sift_down(keys, root, count);
    for (size_t last = count; last-- > 1;) {
        uint64_t key = keys[last];
        keys[last] = keys[0];
        keys[0] = key;
        sift_down(keys, 0, last);
    }
}

static uint32_t lower(const csg_triangles *triangles, uint32_t half)
{
    uint32_t a = csg_half_from(triangles, half), b = csg_half_to(triangles, half);
    return a < b ? a : b;
}

/* keys: other point << 32 | half-edge, grouped by lower point; starts has one more than points. */
static void group(const csg_triangles *triangles, size_t *starts, uint64_t *keys)
{
    uint32_t half_count = (uint32_t)(3 * triangles->count);
    for (uint32_t half = 0; half < half_count; half++)
        starts[lower(triangles, half) + 1]++;
    for (size_t i = 1; i <= triangles->point_count; i++)
        starts[i] += starts[i - 1];
    for (uint32_t half = 0; half < half_count; half++) {
        uint32_t low = lower(triangles, half);
        uint32_t a = csg_half_from(triangles, half), b = csg_half_to(triangles, half);
        keys[starts[low]++] = (uint64_t)(a ^ b ^ low) << 32 | half;
    }
    /* each start has moved to the next one's place */
    for (size_t i = triangles->point_count; i > 0; i--)
        starts[i] = starts[i - 1];
    starts[0] = 0;
    for (size_t i = 0; i < triangles->point_count; i++)
        csg_sort_keys(keys + starts[i], starts[i + 1] - starts[i]);
}

static size_t count_edges(const size_t *starts, size_t point_count, const uint64_t *keys)
{
    size_t count = 0;
    for (size_t i = 0; i < point_count; i++)
        for (size_t k = starts[i]; k < starts[i + 1]; k++)
            count += k == starts[i] || keys[k] >> 32 != keys[k - 1] >> 32;
    return count;
}

static void fill(const size_t *starts, size_t point_count, const uint64_t *keys,
                 csg_triangle_edges *out)
{
    size_t edge = 0;
    for (uint32_t i = 0; i < point_count; i++) {
        for (size_t k = starts[i]; k < starts[i + 1]; k++) {
            if (k == starts[i] || keys[k] >> 32 != keys[k - 1] >> 32)
                out->edges[edge++] = (csg_edge){i, (uint32_t)(keys[k] >> 32), (uint32_t)k, 0};
            out->edges[edge - 1].count++;
            out->halves[k] = (uint32_t)keys[k];
            out->of_half[(uint32_t)keys[k]] = (uint32_t)(edge - 1);
        }
    }
}

bool csg_edges_make(csg_arena *arena, const csg_triangles *triangles, csg_triangle_edges *out)
{
    size_t half_count = 3 * triangles->count;
    if (half_count > UINT32_MAX)
        return false;
    out->halves = csg_arena_alloc(arena, half_count * sizeof *out->halves);
    out->of_half = csg_arena_alloc(arena, half_count * sizeof *out->of_half);
    size_t *starts = csg_arena_calloc(arena, triangles->point_count + 1, sizeof *starts);
    uint64_t *keys = csg_arena_alloc(arena, half_count * sizeof *keys);
    if (!out->halves || !out->of_half || !starts || !keys)
        return false;
    group(triangles, starts, keys);
    out->count = count_edges(starts, triangles->point_count, keys);
    out->edges = csg_arena_alloc(arena, out->count * sizeof *out->edges);
    if (!out->edges)
        return false;
    fill(starts, triangles->point_count, keys, out);
    return true;
}

int32_t csg_edge_net(const csg_triangles *triangles, const csg_triangle_edges *edges,
                     const csg_edge *edge)
{
    int32_t net = 0;
    for (uint32_t i = 0; i < edge->count; i++)
        net += csg_half_from(triangles, edges->halves[edge->first + i]) == edge->low ? 1 : -1;
    return net;
}
