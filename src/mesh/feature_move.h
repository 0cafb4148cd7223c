/* SPDX-License-Identifier: MIT
 * The order of apexes along a crease.
 */
#ifndef CSG_MESH_FEATURE_MOVE_H
#define CSG_MESH_FEATURE_MOVE_H

#include "mesh/feature_probe.h"

/* Where feature `index` lies on a crease and not between its neighbours: *out is the same between
 * them. False: it stays. Writes nothing of the store. */
bool csg_feature_move(const csg_feature_store *store, uint32_t index, csg_feature_probe *probe,
                      csg_feature *out);

#endif
