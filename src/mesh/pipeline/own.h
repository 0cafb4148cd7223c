/* SPDX-License-Identifier: MIT
 * Meshes of solids that are polyhedra: their own triangles, where these are as good as a mesh.
 */
#ifndef CSG_MESH_PIPELINE_OWN_H
#define CSG_MESH_PIPELINE_OWN_H

#include "mesh/pipeline/adaptive.h"

/* Where cells would follow the shape, and nothing is asked that triangles as they are do not have:
 * they are nearer than any quality asks for, but may be more than are wanted. */
static inline bool csg_mesh_may_be_own(const csgm_mesh_options *options)
{
    return csg_mesh_is_adaptive(options) && options->features == CSGM_FEATURES_SHARP &&
           !(options->tolerance > 0) && !(options->simplify_error > 0) &&
           !(options->simplify_share > 0) && !options->improve;
}

/* csg_mesh_build_field for such options. *out NULL: the solid is something else, its triangles
 * would be no sound mesh or more than options->triangles, or bounds cut it. */
csgm_status csg_mesh_build_own(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, const csg_mesh_share *share,
                               csgm_mesh **out, csgm_mesh_stats *stats);

#endif
