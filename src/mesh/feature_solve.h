/* SPDX-License-Identifier: MIT
 * From a polygon with creases to its apex.
 */
#ifndef CSG_MESH_FEATURE_SOLVE_H
#define CSG_MESH_FEATURE_SOLVE_H

#include "mesh/feature_probe.h"

/* Where f would be 0 if it went on as it does at a point: g . x = d. */
typedef struct csg_plane {
    double g[3], d;
} csg_plane;

csg_plane csg_plane_at(float x, float y, float z, float f, float gx, float gy, float gz);

/* Moves x to the point nearest to it where the planes meet: on two, their line; on three and more,
 * the point of least squares. False: they do not meet in a line (a point). */
bool csg_planes_meet(const csg_plane *planes, int count, double x[3]);

/* Adds the features of a loop, none where no apex holds good. False: out of memory. */
bool csg_feature_solve(csg_feature_room *room, const csg_found_loop *loop, csg_feature_probe *probe,
                       csg_memory *memory);

/* Where feature `index` lies on a crease and not between its neighbours: *out is the same between
 * them. False: it stays. Writes nothing of the store. */
bool csg_feature_move(const csg_feature_store *store, uint32_t index, csg_feature_probe *probe,
                      csg_feature *out);

#endif
