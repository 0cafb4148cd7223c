/* SPDX-License-Identifier: MIT
 * The order of apexes along a crease.
 */
#ifndef CSG_MESH_FEATURES_MOVE_H
#define CSG_MESH_FEATURES_MOVE_H

#include "mesh/features/probe.h"

/* Where feature `index` lies on a crease and not between its neighbours: *out is the same between
 * them. False: it stays. Writes nothing of the store. */
bool csg_feature_move(const csg_feature_store *store, uint32_t index, csg_feature_probe *probe,
                      csg_feature_whole *out);

/* Looks for a place where the feature holds (join.h), from what its neighbours know. False:
 * there is none, nothing has changed, but that an apex that was not found goes to a likely place.
 * *is_in_vain (NULL: not told): no apex was found in any; so it is while no vertex moves. */
bool csg_feature_replace(csg_feature_store *store, const csg_cell_tables *tables, uint32_t index,
                         csg_feature_probe *probe, bool *is_in_vain);

#endif
