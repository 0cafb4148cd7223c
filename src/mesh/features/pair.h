/* SPDX-License-Identifier: MIT
 * Faces of cells whose inside corners lie on a diagonal: marching cubes cuts each of them off.
 * Where a thin wedge runs through such a face both belong to one piece, and its two sheets are what
 * the segments should follow.
 */
#ifndef CSG_MESH_FEATURES_PAIR_H
#define CSG_MESH_FEATURES_PAIR_H

#include "mesh/features/probe.h"

/* Whether the block has such faces. */
bool csg_feature_has_pairs(const csg_block *block);

/* Sets room->joined; vertices and gradients are known. Both blocks at a face decide alike. Whether
 * any face is joined. */
bool csg_feature_pair(csg_feature_room *room, csg_feature_probe *probe);

/* The polygons of a cell of the room's block (8 z + y) 8 + x. */
csg_cell_loops csg_feature_loops(const csg_feature_room *room, const csg_cell_tables *tables,
                                 unsigned cell, unsigned pattern);

#endif
