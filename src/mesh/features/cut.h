/* SPDX-License-Identifier: MIT
 * The triangles of a polygon with an apex.
 */
#ifndef CSG_MESH_FEATURES_CUT_H
#define CSG_MESH_FEATURES_CUT_H

#include "mesh/features/features.h"

/* Cuts the feature's polygon as its flips ask for (features: the store's, may be NULL where nothing
 * is flipped): writes side_count triangles. False where one of them would fold over: they are then
 * those of the plain fan. */
bool csg_feature_cut(const csg_feature *features, const csg_cell_tables *tables,
                     const csg_feature *feature, uint8_t (*triangles)[3]);

/* What csg_feature_cut says, without the triangles. */
bool csg_feature_is_cut(const csg_feature *features, const csg_cell_tables *tables,
                        const csg_feature *feature);

/* Whether the piece behind a creased side can be cut so that nothing folds over. takes: stands for
 * the feature's takes_next. */
bool csg_feature_is_cut_behind(const csg_feature *features, const csg_cell_tables *tables,
                               const csg_feature *feature, int side, unsigned takes);

/* The same of the two pieces that meet at a creased side. */
bool csg_feature_cuts_at(const csg_feature *features, const csg_cell_tables *tables,
                         const csg_feature *feature, int side, unsigned takes);

#endif
