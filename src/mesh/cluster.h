/* SPDX-License-Identifier: MIT
 * Which vertices become one where a mesh is drawn with fewer triangles than it has.
 */
#ifndef CSG_MESH_CLUSTER_H
#define CSG_MESH_CLUSTER_H

#include "base/context.h"

/* csgm_mesh_cluster of the public header; indices are in range. */
csgm_status csg_mesh_cluster(csgm_context *context, const csgm_mesh_view *mesh, csgm_box frame,
                             uint64_t most_triangles, uint32_t *cluster_of, uint32_t *cluster_count,
                             double *cell_size);

#endif
