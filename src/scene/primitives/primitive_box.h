/* SPDX-License-Identifier: MIT
 * Boxes of single primitives under affine maps, from their support functions: as tight as a box
 * can be, turned or not.
 */
#ifndef CSG_SCENE_PRIMITIVE_BOX_H
#define CSG_SCENE_PRIMITIVE_BOX_H

#include "scene/scene.h"

/* Box of the image under `map` of {f >= -level}. */
csg_box csg_primitive_box(csg_primitive_kind kind, const double *parameters, const csg_affine *map,
                          double level);

#endif
