/* SPDX-License-Identifier: MIT
 * Vertices and triangles of blocks that have features; what marching/marching.h does for all
 * others.
 */
#ifndef CSG_MESH_FEATURES_EMIT_H
#define CSG_MESH_FEATURES_EMIT_H

#include "mesh/features/features.h"

/* The apexes, behind the block's other vertices; `out` begins with the block's first. split: one
 * vertex per sheet, with the sheet's normal. */
void csg_feature_vertices(const csg_marching *marching, const csg_block *block,
                          const csg_feature_store *store, const csg_feature_block *features,
                          bool split, csg_marching_room *room, const csg_marching_output *out,
                          float *scratch, size_t scratch_floats);
/* Indices; vertices that have moved go to their places where there are positions. */
void csg_feature_triangles(const csg_marching *marching, const csg_block *block,
                           const csg_feature_store *store, const csg_feature_block *features,
                           bool split, csg_marching_room *room, const csg_marching_output *out);
/* As csg_marching_corners. */
uint64_t csg_feature_corners(const csg_marching *marching, const csg_block *block,
                             const csg_feature_store *store, const csg_feature_block *features,
                             csg_marching_room *room, float *corners, float *scratch,
                             size_t scratch_floats);

#endif
