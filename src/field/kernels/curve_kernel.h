/* SPDX-License-Identifier: MIT
 * Tubes along Bezier curves over batches of points: what a build of curve_kernel.c for one
 * instruction set offers to leaf_kernel.c. node: a CSG_OP_OF(QUADRATIC_TUBE) or
 * CSG_OP_OF(CUBIC_TUBE).
 */
#ifndef CSG_FIELD_CURVE_KERNEL_H
#define CSG_FIELD_CURVE_KERNEL_H

#include "field/kernels/batch.h"

typedef struct csg_curve_kernel {
    void (*values)(const csg_tape_node *node, const float *parameters, csg_points p, float *out);
    void (*gradients)(const csg_tape_node *node, const float *parameters, csg_points p, float *out,
                      float *gx, float *gy, float *gz);
} csg_curve_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_CURVE_KERNEL CSG_CONCATENATE(csg_curve_kernel_, CSG_KERNEL)
extern const csg_curve_kernel CSG_THIS_CURVE_KERNEL;
#endif

#endif
