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

/* The parts of that: whether what folds over by itself can be cut after all, and whether the
 * feature can be joined to the one beyond a creased side, or ends there without folding over. An
 * apex that is not known yet stands in nobody's way. */
bool csg_feature_unfolds(csg_feature_store *store, const csg_cell_tables *tables,
                         csg_feature *feature);
bool csg_feature_side_holds(csg_feature_store *store, const csg_cell_tables *tables,
                            csg_feature *feature, int side);

/* False: it does not hold, since a triangle across a crease that is not flipped looks inwards. */
bool csg_feature_stays_outward(const csg_feature *feature);

/* False: it does not hold wherever the vertex at one of its corners goes. In little time. */
bool csg_feature_may_hold(const csg_feature_store *store, const csg_feature *feature, int corner);

#endif
