/* SPDX-License-Identifier: MIT
 * Fans of which no two triangles meet: most apexes of a crease have one. What it takes is a view in
 * which all triangles around the apex are seen from one side and go round it once.
 */
#ifndef CSG_MESH_FEATURES_FAN_H
#define CSG_MESH_FEATURES_FAN_H

#include "mesh/features/features.h"

/* Whether no two of all triangles at a feature's apex, in the mesh's frame, meet but in vertices
 * and edges that both have. In double, with a margin larger than all rounding; false says nothing.
 */
bool csg_fan_is_clear(const csg_feature_store *store, const csg_marching *marching,
                      uint32_t feature);

#endif
