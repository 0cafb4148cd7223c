/* SPDX-License-Identifier: MIT
 * Vertices on lattice edges that make way for a corner of the solid.
 */
#ifndef CSG_MESH_FEATURE_SHIFT_H
#define CSG_MESH_FEATURE_SHIFT_H

#include "mesh/feature_probe.h"

/* Where a corner cannot be joined to its neighbours because it lies beyond vertices of its polygon:
 * moves one of these along its sheet, so that all triangles around it look out. False: there is no
 * such place, nothing has changed. */
bool csg_feature_shift(csg_feature_store *store, const csg_cell_tables *tables, uint32_t index,
                       csg_feature_probe *probe);

/* Puts what has moved of the feature's vertices back. */
void csg_feature_shift_back(csg_feature_store *store, const csg_cell_tables *tables,
                            csg_feature *feature);

#endif
