/* SPDX-License-Identifier: MIT
 * Clusters of vertices by the cells of a grid (Rossignac and Borrel, "Multi-resolution 3D
 * approximations for rendering complex scenes", 1993). Cells grow until few enough triangles have
 * their corners in three of them.
 */
#include "mesh/cluster.h"

#include <math.h>
#include <stdlib.h>

enum { FINEST = 512, COARSEST = 8 };

typedef struct placed {
    uint64_t cell;
    uint32_t vertex;
} placed;

static int compare_placed(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    if (a->cell != b->cell)
        return a->cell < b->cell ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static uint64_t cell_along(double from, double origin, float at, double per_length)
{
    double cells = (origin + (double)at - from) * per_length;
    return (uint64_t)fmin(FINEST, fmax(0, cells));
}

/* The cluster of each vertex, clusters in the order of cells; their number. */
static uint32_t find_clusters(const csgm_mesh_view *mesh, csgm_vec3 from, double per_length,
                              placed *scratch, uint32_t *cluster_of)
{
    uint32_t vertices = (uint32_t)mesh->vertex_count, count = 0;
    for (uint32_t v = 0; v < vertices; v++) {
        const float *p = mesh->positions + 3 * (size_t)v;
        uint64_t x = cell_along(from.x, mesh->origin.x, p[0], per_length);
        uint64_t y = cell_along(from.y, mesh->origin.y, p[1], per_length);
        uint64_t z = cell_along(from.z, mesh->origin.z, p[2], per_length);
        scratch[v] = (placed){(x << 16 | y) << 16 | z, v};
    }
    qsort(scratch, vertices, sizeof *scratch, compare_placed);
    for (uint32_t i = 0; i < vertices; i++) {
        count += i == 0 || scratch[i].cell != scratch[i - 1].cell;
        cluster_of[scratch[i].vertex] = count - 1;
    }
    return count;
}

static uint64_t count_left(const csgm_mesh_view *mesh, const uint32_t *cluster_of)
{
    uint64_t left = 0;
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *corners = mesh->indices + 3 * t;
        uint32_t a = cluster_of[corners[0]], b = cluster_of[corners[1]], c = cluster_of[corners[2]];
        left += a != b && b != c && c != a;
    }
    return left;
}

csgm_status csg_mesh_cluster(csgm_context *context, const csgm_mesh_view *mesh, csgm_box frame,
                             uint64_t most_triangles, uint32_t *cluster_of, uint32_t *cluster_count,
                             double *cell_size)
{
    double x = frame.max.x - frame.min.x, y = frame.max.y - frame.min.y,
           z = frame.max.z - frame.min.z, longest = fmax(x, fmax(y, z));
    size_t bytes = (size_t)mesh->vertex_count * sizeof(placed);
    *cell_size = 0;
    *cluster_count = (uint32_t)mesh->vertex_count;
    if (mesh->triangle_count <= most_triangles || !(longest > 0) || !isfinite(longest)) {
        for (uint32_t v = 0; v < *cluster_count; v++)
            cluster_of[v] = v;
        return CSGM_OK;
    }
    placed *scratch = csg_memory_alloc(&context->memory, bytes);
    if (!scratch)
        return csg_context_no_memory(context);
    for (int cells = FINEST;;) {
        *cluster_count = find_clusters(mesh, frame.min, cells / longest, scratch, cluster_of);
        *cell_size = longest / cells;
        uint64_t left = count_left(mesh, cluster_of);
        if (left <= most_triangles || cells <= COARSEST)
            break;
        /* triangles grow as the square of the cells */
        double share = sqrt((double)most_triangles / (double)left);
        cells = (int)(cells * fmin(0.9, fmax(0.25, 0.97 * share)));
    }
    csg_memory_release(&context->memory, scratch, bytes);
    return CSGM_OK;
}
