/* SPDX-License-Identifier: MIT
 * Where the surface crosses lattice edges: bracketed roots of the field along each edge, all edges
 * of a block in one batch. A root depends on its own edge only, not on the batch. Built once per
 * instruction set, like the kernels.
 */
#ifndef CSG_FIELD_ROOTS_H
#define CSG_FIELD_ROOTS_H

#include "field/kernels/kernel.h"

enum {
    CSG_BLOCK_MOST_EDGES = 1952, /* 3 * 8 * 9 * 9, up to whole CSG_LANES */
};

/* Edges from a to b = a + d, one coordinate of d not zero. Arrays of whole CSG_LANES. */
struct csg_edges {
    uint32_t count;
    float end_distance; /* roots keep this far from both ends: a part of the edge */
    bool has_ends;      /* fa and fb are given: the field at both ends */
    float ax[CSG_BLOCK_MOST_EDGES], ay[CSG_BLOCK_MOST_EDGES], az[CSG_BLOCK_MOST_EDGES];
    float dx[CSG_BLOCK_MOST_EDGES], dy[CSG_BLOCK_MOST_EDGES], dz[CSG_BLOCK_MOST_EDGES];
    /* results: the point on the edge, and working room */
    float x[CSG_BLOCK_MOST_EDGES], y[CSG_BLOCK_MOST_EDGES], z[CSG_BLOCK_MOST_EDGES];
    float t[CSG_BLOCK_MOST_EDGES], f[CSG_BLOCK_MOST_EDGES];
    float ta[CSG_BLOCK_MOST_EDGES], tb[CSG_BLOCK_MOST_EDGES];
    float fa[CSG_BLOCK_MOST_EDGES], fb[CSG_BLOCK_MOST_EDGES];
    float tolerance[CSG_BLOCK_MOST_EDGES]; /* |f| small enough to stop */
    float moved[CSG_BLOCK_MOST_EDGES]; /* the end that the last step moved: -1 a, +1 b, 0 none */
    bool a_inside[CSG_BLOCK_MOST_EDGES];
    uint16_t rank[CSG_BLOCK_MOST_EDGES]; /* where the caller wants the result */
};

#endif
