/* SPDX-License-Identifier: MIT
 * Vertices on lattice edges that make way for a corner of the solid.
 */
#ifndef CSG_MESH_FEATURES_SHIFT_H
#define CSG_MESH_FEATURES_SHIFT_H

#include "mesh/features/probe.h"

/* Where a feature cannot be joined to its neighbours, or to `other` (may be NONE), because its apex
 * lies beyond vertices of its polygon: moves one of these along its sheet, so that all triangles
 * around it look out; the nearest place that has not been tried before. False: there is none,
 * nothing has changed. */
bool csg_feature_shift(csg_feature_store *store, const csg_cell_tables *tables, uint32_t index,
                       uint32_t other, csg_feature_probe *probe);

/* Whether vertices of it, or for it, have moved. */
static inline bool csg_feature_is_shifted(const csg_feature *feature)
{
    return feature->moved || feature->made_way;
}

/* Puts these back. */
void csg_feature_shift_back(csg_feature_store *store, const csg_cell_tables *tables,
                            csg_feature *feature);

#endif
