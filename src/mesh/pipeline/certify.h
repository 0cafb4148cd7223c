/* SPDX-License-Identifier: MIT
 * The report on what the lattice may have missed, for csgm_mesh_stats and as warnings.
 */
#ifndef CSG_MESH_CERTIFY_H
#define CSG_MESH_CERTIFY_H

#include "grid/certify/certify.h"
#include "mesh/work.h"

/* After the octree was made and sampled: certifies, or follows the doubts of its scan; warns and
 * fills the report of `work`. CSGM_OK, or why it stopped (reported). */
csgm_status csg_mesh_look_for_missed(csg_mesh_work *work);
/* The reports of parts as one. */
void csg_mesh_add_certify(csgm_certify *sum, const csgm_certify *part);

#endif
