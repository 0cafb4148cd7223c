/* SPDX-License-Identifier: MIT
 * Meshes of a lattice that follows the shape: chosen, refined, cut into triangles, thinned out.
 */
#ifndef CSG_MESH_PIPELINE_ADAPTIVE_H
#define CSG_MESH_PIPELINE_ADAPTIVE_H

#include "mesh/pipeline/build.h"

/* Neither -r nor -s: cells are as small as the tolerance asks for. */
static inline bool csg_mesh_is_adaptive(const csgm_mesh_options *options)
{
    return !options->resolution && !(options->cell_size > 0);
}

/* csg_mesh_build_field for options that ask for it. */
csgm_status csg_mesh_build_adaptive(csgm_context *context, const csgm_field *field,
                                    const csgm_mesh_options *options, const csg_mesh_share *share,
                                    csgm_mesh **out, csgm_mesh_stats *stats);

#endif
