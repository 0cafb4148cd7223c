/* SPDX-License-Identifier: MIT
 * What the signed distance from an outline is nowhere less than, over a triangle of the plane; see
 * csg_shape_beside.
 */
#ifndef CSG_SHAPE_REGION_BESIDE_H
#define CSG_SHAPE_REGION_BESIDE_H

#include "shape/plane/region_sign.h"
#include "shape/plane/region_tree.h"
#include "shape/shape.h"

/* c: the corners' middle, of which `nearest` is the nearest segment and `value` the signed
 * distance. at: turn times the distances of the corners, and then what csg_shape_beside gives. */
csg_beside csg_region_beside(const csg_segment_tree *tree, const csg_segment_sides *sides,
                             const csg_vec2 corners[3], csg_vec2 c, uint32_t nearest, double value,
                             double turn, double at[3]);

#endif
