/* SPDX-License-Identifier: MIT
 * Features that do not hold where they are.
 */
#ifndef CSG_MESH_FEATURES_SETTLE_H
#define CSG_MESH_FEATURES_SETTLE_H

#include "mesh/features/probe.h"

/* Looks for another place for features that do not hold, and makes those smooth again that have
 * none; how many changed. To be called until there are none; not in parallel. */
size_t csg_feature_settle(csg_feature_store *store, const csg_cell_tables *tables,
                          csg_feature_probe *probe);

#endif
