/* SPDX-License-Identifier: MIT
 * Meshes of any field with any options: of parts one after the other, reshaped where that is asked
 * for.
 */
#ifndef CSG_MESH_PIPELINE_PARTS_H
#define CSG_MESH_PIPELINE_PARTS_H

#include "mesh/pipeline/build.h"

/* As csgm_mesh_build; the parts of a field (field/field.h) become those of the mesh. */
csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats);

/* Whether csg_mesh_stream makes the same mesh. */
bool csg_mesh_can_stream(const csgm_field *field, const csgm_mesh_options *options);
/* How many times its size a mesh with an origin of its own will be from that of the scene, 0: it
 * has none. (Of a field that can be streamed.) */
double csg_mesh_distance(const csgm_field *field, const csgm_mesh_options *options);

#endif
