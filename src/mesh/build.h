/* SPDX-License-Identifier: MIT
 * The meshing pipeline: bounds -> lattice -> octree -> blocks -> counts -> vertices and triangles.
 */
#ifndef CSG_MESH_BUILD_H
#define CSG_MESH_BUILD_H

#include "field/field.h"
#include "mesh/mesh.h"

/* As csgm_mesh_build. */
csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats);

#endif
