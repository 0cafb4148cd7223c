/* SPDX-License-Identifier: MIT
 * Leaves over batches of points: what a build of leaf_kernel.c for one instruction set offers to
 * kernel.c.
 */
#ifndef CSG_FIELD_LEAF_KERNEL_H
#define CSG_FIELD_LEAF_KERNEL_H

#include "field/kernels/batch.h"

typedef struct csg_leaf_kernel {
    void (*values)(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out);
    /* p.count <= CSG_BATCH */
    void (*gradients)(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out,
                      float *gx, float *gy, float *gz);
    /* Bounds over eight cubes by centre and half diagonal. */
    void (*intervals)(const csg_tape *tape, const csg_tape_node *node, csg_points p, float radius,
                      float *low, float *high);
} csg_leaf_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_LEAF_KERNEL CSG_CONCATENATE(csg_leaf_kernel_, CSG_KERNEL)
extern const csg_leaf_kernel CSG_THIS_LEAF_KERNEL;
#endif

#endif
