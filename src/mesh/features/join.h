/* SPDX-License-Identifier: MIT
 * How features hang together.
 */
#ifndef CSG_MESH_FEATURES_JOIN_H
#define CSG_MESH_FEATURES_JOIN_H

#include "mesh/features/probe.h"

/* Whether the feature can be cut and joined to all its neighbours where it is; may change who has
 * which half of a flipped segment. */
bool csg_feature_holds(csg_feature_store *store, const csg_cell_tables *tables,
                       csg_feature *feature);

/* Makes the neighbours' shares of flipped segments fit those of the feature. */
void csg_feature_agree(csg_feature_store *store, csg_feature *feature);

/* Looks for another place for features that do not hold, and makes those smooth again that have
 * none; how many changed. To be called until there are none; not in parallel. */
size_t csg_feature_settle(csg_feature_store *store, const csg_cell_tables *tables,
                          csg_feature_probe *probe);

#endif
