/* SPDX-License-Identifier: MIT
 * More triangles where a thinned out mesh is not good enough: sides are cut, the new vertices
 * brought to the surface, until everything is proven or nothing helps.
 */
#ifndef CSG_MESH_RESHAPE_REFINE_H
#define CSG_MESH_RESHAPE_REFINE_H

#include "mesh/distance/check.h"
#include "mesh/reshape/far.h"

/* Brings vertices to the places that are far, then proves the distance and refines what stays open,
 * in a few rounds; *out is of the last one. */
csgm_status csg_refine_until_near(csg_remesh *remesh, double error, const csg_far_places *far,
                                  csg_distance_proof *out);

#endif
