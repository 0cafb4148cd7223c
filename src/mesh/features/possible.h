/* SPDX-License-Identifier: MIT
 * Blocks and cells that cannot have creases, told by what stands in their tapes.
 */
#ifndef CSG_MESH_FEATURES_POSSIBLE_H
#define CSG_MESH_FEATURES_POSSIBLE_H

#include "mesh/features/probe.h"

/* Which cells of the probe's block may. False: none, the gradient does not jump anywhere on the
 * surface in the block, and does not turn so fast that it would look like a jump. */
bool csg_feature_find_possible(csg_feature_probe *probe, csg_possible_cells *possible);

#endif
