/* SPDX-License-Identifier: MIT
 * One mesh by several processes (base/ranks.h). Each walks the whole octree, which is a thousandth
 * of the work, and has a stretch of its frontier, with the blocks above it that its cells refer to:
 * a halo that it samples again. Counts of all frontier cubes are exchanged, so each knows the
 * numbers of its vertices and of the halo's; features are found by the rank that has their block
 * and settled by all alike, in the order of one process. So the mesh is that of one process.
 *
 * Meshes that are reshaped, and those of cells that follow the shape, are whole on every rank:
 * there the loops over cells and cubes of space are shared out (base/rank_loop.h).
 */
#ifndef CSG_MESH_PIPELINE_RANKS_H
#define CSG_MESH_PIPELINE_RANKS_H

#include "mesh/pipeline/output.h"

/* After the walk, before anything is sampled, or after `own` has ended it: this rank's stretch, by
 * the work that tapes promise, and the halo of it. A process alone has all. */
csgm_status csg_mesh_ranks_share(csg_mesh_slabs *slabs, csgm_status own);
/* After the stretch is counted, or `own` has ended it: numbers for all ranks' blocks, features and
 * halos; the totals are those of the whole mesh. Where one rank would have too much to make, the
 * frontier is shared out again by what was counted. */
csgm_status csg_mesh_ranks_number(csg_mesh_slabs *slabs, csgm_status own);
/* Once the output has begun: what of this rank's stretch an earlier job has made is left out, and
 * the halo is that of the rest. */
csgm_status csg_mesh_ranks_resume(csg_mesh_output *output, csg_mesh_slabs *slabs);
/* After all is made, or `own` has ended it: the box of all clipped vertices, and, where the mesh is
 * not for a receiver, the whole mesh on the first rank and an empty one on the others. */
csgm_status csg_mesh_ranks_join(csg_mesh_output *output, csg_mesh_slabs *slabs, csgm_status own);
/* Whether all have the same bytes, which say what they are about to make: else it is refused, and
 * reported by the first. Only with ranks. */
csgm_status csg_mesh_ranks_compare(csgm_context *context, const void *own, size_t bytes);
/* A mesh that is complete on this rank, or `own` has ended it: only if it is on all. It stays with
 * the first, the others get one without triangles. */
csgm_status csg_mesh_ranks_settle(csgm_context *context, csgm_status own, csgm_mesh **mesh);

#endif
