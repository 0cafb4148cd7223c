/* SPDX-License-Identifier: MIT
 * Meshes of solids that are polyhedra: their own triangles, where these are as good as a mesh.
 */
#ifndef CSG_MESH_PIPELINE_OWN_H
#define CSG_MESH_PIPELINE_OWN_H

#include "mesh/pipeline/adaptive.h"

/* Where cells would follow the shape. */
static inline bool csg_mesh_may_be_own(const csgm_mesh_options *options)
{
    return csg_mesh_is_adaptive(options) && options->features == CSGM_FEATURES_SHARP;
}

/* Whether triangles as they are have too little, or are more than are wanted. They are nearer than
 * any quality asks for. */
static inline bool csg_mesh_reshapes_own(const csgm_mesh_options *options, uint64_t triangles)
{
    return options->tolerance > 0 || options->simplify_error > 0 || options->simplify_share > 0 ||
           options->improve || (options->triangles && triangles > options->triangles);
}

/* csg_mesh_build_field for such options; of a mesh that is to be reshaped, without normals, what
 * reshaping begins with. *out NULL: the solid is something else, its triangles would be no sound
 * mesh, or bounds cut it; or, where they are to be reshaped, not all of them are polyhedra's, or
 * there are several looks in one piece. */
csgm_status csg_mesh_build_own(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, const csg_mesh_share *share,
                               csgm_mesh **out, csgm_mesh_stats *stats);

#endif
