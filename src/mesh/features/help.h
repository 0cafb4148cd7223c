/* SPDX-License-Identifier: MIT
 * Polygons without a crease that make room for the corner next door.
 */
#ifndef CSG_MESH_FEATURES_HELP_H
#define CSG_MESH_FEATURES_HELP_H

#include "mesh/features/probe.h"

/* Where the apex of one of the block's features, those from `first` on, lies beyond a side that no
 * crease crosses: the polygon there gets an apex too, within its sheet, so that the side between
 * both can be flipped. Puts the features in order. False: out of memory. */
bool csg_feature_help(csg_feature_room *room, size_t first, csg_feature_probe *probe);

/* Puts the apex of a polygon of one sheet on the surface near a point; false where that does not
 * succeed, or its fan folds over. */
bool csg_feature_place_within(csg_feature *feature, csg_vec3 near, csg_feature_probe *probe);

#endif
