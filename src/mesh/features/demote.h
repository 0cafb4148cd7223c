/* SPDX-License-Identifier: MIT
 * Giving a feature up.
 */
#ifndef CSG_MESH_FEATURES_DEMOTE_H
#define CSG_MESH_FEATURES_DEMOTE_H

#include "mesh/features/features.h"

/* The polygon is as plain marching cubes makes it, but for a vertex in one of its triangles where
 * the apex was: the numbers of everything stay. Vertices that have moved for it go back, and its
 * neighbours are not joined to it any more. */
void csg_feature_demote(csg_feature_store *store, const csg_cell_tables *tables,
                        csg_feature *feature);

#endif
