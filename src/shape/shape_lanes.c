/* SPDX-License-Identifier: MIT
 * The table of one instruction set: what plane/region_lanes.c and polyhedra/tree_lanes.c make.
 */
#include "shape/shape_kernel.h"

extern const csg_shape_kernel CSG_SHAPE_BUILD(csg_shape_kernel);
const csg_shape_kernel CSG_SHAPE_BUILD(csg_shape_kernel) = {CSG_SHAPE_BUILD(csg_nearest_segments),
                                                            CSG_SHAPE_BUILD(csg_nearest_triangles)};
