/* SPDX-License-Identifier: MIT
 * Boxes of single primitives under affine maps, from their support functions: as tight as a box
 * can be, turned or not.
 */
#ifndef CSG_SCENE_PRIMITIVE_BOX_H
#define CSG_SCENE_PRIMITIVE_BOX_H

#include "scene/scene.h"

/* Largest n . p over the solid {f >= 0}; INFINITY where it is unbounded. n need not be unit. */
double csg_primitive_support(csg_node_kind kind, const double *parameters, csg_vec3 n);

/* Box of the image under `map` of {f >= -level}. */
csg_box csg_primitive_box(csg_node_kind kind, const double *parameters, const csg_affine *map,
                          double level);

#endif
