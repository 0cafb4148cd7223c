/* SPDX-License-Identifier: MIT
 * What marching cubes makes of one cell, wherever it lies: signs and roots by the block that has
 * it, or, where that is not in memory, by the tape of the octree's frontier. They are the bits of
 * the mesh either way (pruning changes none).
 */
#ifndef CSG_MESH_FEATURES_CELL_H
#define CSG_MESH_FEATURES_CELL_H

#include "mesh/marching/marching.h"

typedef struct csg_feature_cell {
    unsigned pattern;            /* 0: no surface */
    float at[CSG_CELL_EDGES][3]; /* of crossed edges, field frame */
} csg_feature_cell;

/* edges: room for it. Returns point evaluations made. */
uint64_t csg_feature_cell_find(const csg_marching *marching, const csg_octree *octree,
                               const uint32_t cell[3], csg_edges *edges, float *scratch,
                               size_t scratch_floats, csg_feature_cell *out);

#endif
