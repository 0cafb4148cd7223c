/* SPDX-License-Identifier: MIT
 * What of the shapes is built once per instruction set: searches for several points at once. All
 * builds find the same, to the bit.
 */
#ifndef CSG_SHAPE_KERNEL_H
#define CSG_SHAPE_KERNEL_H

#include "shape/plane/region_tree.h"

enum { CSG_SHAPE_LANES = 8 };

typedef struct csg_shape_kernel {
    /* hits[l] is csg_segment_nearest_of(tree, list, x[l], y[l]) for each of CSG_SHAPE_LANES points.
     */
    void (*nearest_segments)(const csg_segment_tree *tree, csg_segment_list list, const double *x,
                             const double *y, csg_segment_hit *hits);
} csg_shape_kernel;

extern const csg_shape_kernel csg_shape_kernel_scalar;

#endif
