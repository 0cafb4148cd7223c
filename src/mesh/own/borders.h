/* SPDX-License-Identifier: MIT
 * Where triangles of different looks lie side by side in one plane.
 */
#ifndef CSG_MESH_OWN_BORDERS_H
#define CSG_MESH_OWN_BORDERS_H

#include "mesh/own/units.h"
#include "shape/polyhedra/booleans.h"

/* Whether each such border is one of the units: beside it, not both looks are there. Where faces of
 * two looks coincide, the library takes pieces of both, which nobody has drawn; that is not clear.
 * joined: what is left of the units, its marks are numbers of looks. false: no memory. */
bool csg_own_borders_are_clear(const csg_own_units *units, const csg_marked_triangles *joined,
                               bool *clear);

#endif
