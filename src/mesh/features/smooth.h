/* SPDX-License-Identifier: MIT
 * Polygons that have been given up: the triangles of marching cubes with one vertex more.
 */
#ifndef CSG_MESH_FEATURES_SMOOTH_H
#define CSG_MESH_FEATURES_SMOOTH_H

#include "mesh/features/features.h"

/* Gives the feature these triangles and its apex a place in one of them; attempt 0 is the best
 * place, others are for where it will not do. False: no more places. */
bool csg_feature_divide(csg_feature *feature, const csg_cell_tables *tables, unsigned attempt);

/* Gives it these triangles alone. */
void csg_feature_leave_plain(csg_feature *feature, const csg_cell_tables *tables);

#endif
