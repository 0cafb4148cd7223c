/* SPDX-License-Identifier: MIT
 * What several meshes that become one took together.
 */
#ifndef CSG_MESH_PIPELINE_STATS_H
#define CSG_MESH_PIPELINE_STATS_H

#include "csgmesh/csgmesh.h"

/* Counts add up; the lattice is the same; the tape's mean is weighted. */
void csg_mesh_add_stats(csgm_mesh_stats *sum, const csgm_mesh_stats *part);

#endif
