/* SPDX-License-Identifier: MIT
 * The report on what the lattice may have missed, for csgm_mesh_stats and as warnings.
 */
#ifndef CSG_MESH_CERTIFY_H
#define CSG_MESH_CERTIFY_H

#include "grid/adaptive/bricks.h"
#include "grid/certify/certify.h"
#include "mesh/pipeline/input.h"
#include "mesh/watch.h"

typedef struct csg_mesh_doubts {
    csgm_certify certify;
    uint64_t unresolved_cells;
} csg_mesh_doubts;

/* After the octree was made and sampled (NULL: there was nothing to mesh): certifies, or follows
 * the doubts of its scan; warns. CSGM_OK, or why it stopped (reported). */
csgm_status csg_mesh_look_for_missed(const csg_mesh_input *input, csg_octree *octree,
                                     csg_mesh_watch *watch, csg_mesh_doubts *doubts);
/* The same for cells that follow the shape: what a scan of few equal cells doubts and the leaves do
 * not have is lost, as what is thinner than the tolerance may be. raised: the tolerance is not the
 * one that was asked for; what is thinner counts as lost then even where leaves have some of it. */
csgm_status csg_mesh_look_for_lost(const csg_mesh_input *input, const csg_bricks *bricks,
                                   double tolerance, bool raised, csg_mesh_watch *watch);
/* The reports of parts as one. */
void csg_mesh_add_certify(csgm_certify *sum, const csgm_certify *part);

#endif
