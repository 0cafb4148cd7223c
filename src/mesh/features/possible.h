/* SPDX-License-Identifier: MIT
 * Blocks that cannot have creases, told by what stands in their tapes.
 */
#ifndef CSG_MESH_FEATURES_POSSIBLE_H
#define CSG_MESH_FEATURES_POSSIBLE_H

#include "mesh/features/probe.h"

/* False: the gradient does not jump anywhere on the surface in the probe's block, and does not turn
 * so fast that it would look like a jump. */
bool csg_feature_is_possible(const csg_feature_probe *probe);

#endif
