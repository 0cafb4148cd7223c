/* SPDX-License-Identifier: MIT
 * The edges of a list of triangles, each with the half-edges that lie on it. Half-edge 3 t + k runs
 * from corner k of triangle t to its next.
 */
#ifndef CSG_SHAPE_EDGES_H
#define CSG_SHAPE_EDGES_H

#include "shape/polyhedra/triangles.h"

typedef struct csg_edge {
    uint32_t low, high;    /* points, low < high */
    uint32_t first, count; /* its half-edges, in halves */
} csg_edge;

typedef struct csg_triangle_edges {
    csg_edge *edges; /* by low, then high */
    size_t count;
    uint32_t *halves;
    uint32_t *of_half; /* the edge of each half-edge */
} csg_triangle_edges;

/* False: out of memory, or of numbers for half-edges. No triangle has two equal corners. */
bool csg_edges_make(csg_arena *arena, const csg_triangles *triangles, csg_triangle_edges *out);

static inline uint32_t csg_half_from(const csg_triangles *triangles, uint32_t half)
{
    return triangles->corners[half / 3][half % 3];
}
static inline uint32_t csg_half_to(const csg_triangles *triangles, uint32_t half)
{
    return triangles->corners[half / 3][(half % 3 + 1) % 3];
}
/* How often more from low to high than back. */
int32_t csg_edge_net(const csg_triangles *triangles, const csg_triangle_edges *edges,
                     const csg_edge *edge);

/* In place, by heap: no memory, and never slow. */
void csg_sort_keys(uint64_t *keys, size_t count);

#endif
