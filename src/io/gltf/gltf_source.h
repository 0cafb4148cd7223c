/* SPDX-License-Identifier: MIT
 * Mesh -> shapes and nodes: a shape for each part, or for each piece of one that is there several
 * times; levels of detail behind one another; texture coordinates; and what EXT_mesh_manifold says.
 */
#ifndef CSG_IO_GLTF_SOURCE_H
#define CSG_IO_GLTF_SOURCE_H

#include "io/gltf/gltf_plan.h"

/* The mesh has triangles; its arrays may stay borrowed. Reports what fails; release `out` then,
 * too.
 */
csgm_status csg_gltf_source_make(csgm_context *context, const csgm_mesh_view *mesh,
                                 const csgm_write_options *options, csg_gltf_source *out);
void csg_gltf_source_release(csg_gltf_source *source); /* all zero: no-op */

/* gltf_levels.c: the mesh and the coarser ones of the options as one mesh, with a show for each
 * part of each. CSGM_ERR_ARGUMENT (reported): they do not have the same arrays. */
csgm_status csg_gltf_take_levels(csgm_context *context, const csgm_mesh_view *mesh,
                                 const csgm_write_options *options, csg_gltf_source *out);
/* gltf_components.c: components that are the same, moved, stand behind one another in the same
 * order. False: out of memory, not reported. */
bool csg_gltf_lay_out_components(csg_gltf_source *source);
/* gltf_pieces.c: shapes of which pieces repeat become a shape for each piece. False: out of memory,
 * not reported. */
bool csg_gltf_find_pieces(csg_gltf_source *source);
/* gltf_uv.c: each vertex of several projections becomes several. False: out of memory, not
 * reported.
 */
bool csg_gltf_project(csg_gltf_source *source, csgm_uv how);

#endif
