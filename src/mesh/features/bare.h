/* SPDX-License-Identifier: MIT
 * Polygons without an apex around corners of the solid that lie outside their cell.
 */
#ifndef CSG_MESH_FEATURES_BARE_H
#define CSG_MESH_FEATURES_BARE_H

#include "mesh/features/near.h"

/* Where the apex of a corner lies outside its cell, the polygons around the vertices on the faces
 * it lies beyond become features without an apex, so that these vertices may move
 * (shift.h). Numbers of vertices and triangles stay. The store is indexed before and
 * after. edges and scratch: room; *evaluations grows. False: out of memory. */
bool csg_feature_add_bare(csg_feature_store *store, const csg_marching *marching,
                          const csg_octree *octree, csg_edges *edges, float *scratch,
                          size_t scratch_floats, uint64_t *evaluations);

#endif
