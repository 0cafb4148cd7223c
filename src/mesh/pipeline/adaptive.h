/* SPDX-License-Identifier: MIT
 * Meshes of a lattice that follows the shape: chosen, refined, cut into triangles, thinned out.
 */
#ifndef CSG_MESH_PIPELINE_ADAPTIVE_H
#define CSG_MESH_PIPELINE_ADAPTIVE_H

#include "mesh/pipeline/build.h"

/* Without -r and -s cells follow the shape; to certify takes equal ones. This is the one place that
 * says which options mean which lattice. */
static inline bool csg_mesh_is_adaptive(const csgm_mesh_options *options)
{
    return !options->resolution && !(options->cell_size > 0) && !options->certify;
}

/* The solid's box within the bounds, which may be generous; the bounds where it has no size. */
csg_box csg_mesh_box_within(csg_box bounds, csg_box solid);
/* The tolerance of a quality, for a box to mesh; 0 where that has no size, or no end. */
double csg_mesh_quality_tolerance(csgm_quality quality, csg_box bounds);

/* csg_mesh_build_field for options that ask for it, towards a goal with an error. */
csgm_status csg_mesh_build_adaptive(csgm_context *context, const csgm_field *field,
                                    const csgm_mesh_options *options, const csg_mesh_share *share,
                                    csg_mesh_goal *goal, csgm_mesh **out, csgm_mesh_stats *stats);

#endif
