/* SPDX-License-Identifier: MIT
 * From polygons with creases to their features.
 */
#ifndef CSG_MESH_FEATURES_SOLVE_H
#define CSG_MESH_FEATURES_SOLVE_H

#include "mesh/features/probe.h"

/* Adds the features of the room's loops, none where no apex holds good. False: out of memory. */
bool csg_feature_solve(csg_feature_room *room, csg_feature_probe *probe);

#endif
