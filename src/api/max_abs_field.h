/* SPDX-License-Identifier: MIT
 * How far vertices of a mesh are from where the field is zero: which of them are looked at, and how
 * one is.
 */
#ifndef CSG_API_MAX_ABS_FIELD_H
#define CSG_API_MAX_ABS_FIELD_H

#include "base/geometry.h"
#include "csgmesh/csgmesh.h"

typedef struct csg_max_abs {
    double largest; /* NaN: not known */
    uint64_t measured;
} csg_max_abs;

/* Every step-th of so many vertices is looked at: what that costs grows with the mesh, a small part
 * of what making it does, between some milliseconds and a second. */
uint64_t csg_max_abs_step(const csgm_scene *scene, uint64_t vertex_count);
/* One more vertex, 3 floats about origin. */
void csg_max_abs_look(csg_max_abs *known, const csgm_scene *scene, csgm_vec3 origin,
                      const float *at);
void csg_max_abs_add(csg_max_abs *known, const csg_max_abs *other);

#endif
