/* SPDX-License-Identifier: MIT
 * The meshing pipeline: bounds -> lattice -> octree -> blocks -> counts -> vertices and triangles.
 */
#ifndef CSG_MESH_BUILD_H
#define CSG_MESH_BUILD_H

#include "field/field.h"
#include "mesh/mesh.h"
#include "mesh/run.h"

/* As csgm_mesh_build; the parts of a field (field/field.h) become those of the mesh. */
csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats);

/* The same mesh of a field without parts and materials, handed to a receiver in memory of
 * O(blocks). *counts (may be NULL) as begun. CSGM_ERR_IO without a report when put() ended the
 * build. */
static inline bool csg_mesh_can_stream(const csgm_field *field, const csgm_mesh_options *options)
{
    return !field->part_count && !(field->has_materials && options->colors) &&
           !(options->tolerance > 0) && !(options->simplify_error > 0) &&
           !(options->simplify_share > 0) && !options->improve;
}
csgm_status csg_mesh_stream(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, const csg_mesh_receiver *receiver,
                            csg_mesh_counts *counts, csgm_mesh_stats *stats);

#endif
