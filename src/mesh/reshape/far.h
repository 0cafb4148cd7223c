/* SPDX-License-Identifier: MIT
 * Places of the surface that a thinned out mesh is too far from: those that the first mesh did not
 * come near enough to, either. Refining brings vertices there (refine.h).
 */
#ifndef CSG_MESH_RESHAPE_FAR_H
#define CSG_MESH_RESHAPE_FAR_H

#include "mesh/remesh/triangle_tree.h"

typedef struct csg_far_places {
    csg_vec3 *at;
    size_t count, capacity;
} csg_far_places;

bool csg_far_places_add(csg_far_places *places, csg_memory *memory, csg_vec3 at);
void csg_far_places_release(csg_far_places *places, csg_memory *memory);
/* The largest distance of these from a mesh, as it is now; `most` where one is farther. */
double csg_far_places_distance(const csg_far_places *places, const csg_triangle_tree *tree,
                               double most);

#endif
