/* SPDX-License-Identifier: MIT
 * Meshes that are reshaped: one of cells that follow the shape; or tries, of one lattice of equal
 * cells each, until one is within the tolerance.
 */
#ifndef CSG_MESH_PIPELINE_TRIES_H
#define CSG_MESH_PIPELINE_TRIES_H

#include "mesh/pipeline/adaptive.h"

static inline bool csg_mesh_is_reshaped(const csgm_mesh_options *options)
{
    return options->tolerance > 0 || options->simplify_error > 0 || options->simplify_share > 0 ||
           options->improve || csg_mesh_is_adaptive(options);
}

/* Within which cells follow the shape where nothing but a quality is asked for. */
double csg_mesh_tries_tolerance(const csgm_field *field, const csgm_mesh_options *options,
                                const csg_mesh_share *share);

/* csg_mesh_build_field for options that ask for it. own: triangles to begin with, which are taken
 * over (csg_mesh_build_own); NULL: none. */
csgm_status csg_mesh_build_tries(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, const csg_mesh_share *share,
                                 csgm_mesh *own, csgm_mesh **out, csgm_mesh_stats *stats);

#endif
