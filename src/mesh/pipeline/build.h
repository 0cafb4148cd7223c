/* SPDX-License-Identifier: MIT
 * The mesh of one field: bounds -> lattice -> octree -> blocks -> counts -> vertices and triangles.
 * Meshes of any field and any options are parts.h.
 */
#ifndef CSG_MESH_BUILD_H
#define CSG_MESH_BUILD_H

#include "mesh/pipeline/input.h"
#include "mesh/reshape/tolerance.h"
#include "mesh/run.h"

/* Of a field without parts; what options ask of the finished mesh is not looked at, but in the goal
 * (NULL: nothing is). */
csgm_status csg_mesh_build_field(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, const csg_mesh_share *share,
                                 csg_mesh_goal *goal, csgm_mesh **out, csgm_mesh_stats *stats);

/* The same mesh of a field without parts and materials, handed to a receiver in memory of
 * O(blocks). *counts (may be NULL) as begun. CSGM_ERR_IO without a report when put() ended the
 * build. */
csgm_status csg_mesh_stream(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, const csg_mesh_receiver *receiver,
                            csg_mesh_counts *counts, csgm_mesh_stats *stats);

#endif
