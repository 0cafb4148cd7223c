/* SPDX-License-Identifier: MIT
 * From a polygon with creases to its feature.
 */
#ifndef CSG_MESH_FEATURES_SOLVE_H
#define CSG_MESH_FEATURES_SOLVE_H

#include "mesh/features/probe.h"

/* Adds the feature of a loop, none where no apex holds good. False: out of memory. */
bool csg_feature_solve(csg_feature_room *room, const csg_found_loop *loop, csg_feature_probe *probe,
                       csg_memory *memory);

#endif
