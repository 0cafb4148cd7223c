/* SPDX-License-Identifier: MIT
 * A region of the plane as a field: exact distance to the segments of a clean outline (polygons.h),
 * by a tree of boxes; inside by the winding of a ray that is exact for shared corners.
 */
#ifndef CSG_SHAPE_REGION_H
#define CSG_SHAPE_REGION_H

#include "shape/shape.h"

/* `outline` is clean and is copied. */
csgm_status csg_region_create(csg_memory *memory, const csg_outline *outline, csg_shape **out);
/* What csg_shape_hash() has of the region of an outline. */
uint64_t csg_region_hash(const csg_outline *outline);
/* The clean outline again, valid as long as the shape. */
const csg_outline *csg_region_outline(const csg_shape *region);

#endif
