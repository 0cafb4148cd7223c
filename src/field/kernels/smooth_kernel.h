/* SPDX-License-Identifier: MIT
 * Joins by smooth unit steps (EXTERIOR, INTERIOR; operators.md 7) over batches of points: what a
 * build of smooth_kernel.c for one instruction set offers to kernel.c.
 */
#ifndef CSG_FIELD_SMOOTH_KERNEL_H
#define CSG_FIELD_SMOOTH_KERNEL_H

#include "field/kernels/batch.h"

/* As the functions of joins.h; count <= CSG_BATCH. A share may lie outside of 0..1. */
typedef struct csg_smooth_kernel {
    void (*values)(const csg_tape_node *node, const float *parameters, float *a, const float *b,
                   size_t count);
    void (*shares)(const csg_tape_node *node, const float *parameters, const float *a,
                   const float *b, float *share, size_t count);
    void (*intervals)(const csg_tape_node *node, const float *parameters, float *a_low,
                      float *a_high, const float *b_low, const float *b_high);
} csg_smooth_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_SMOOTH_KERNEL CSG_CONCATENATE(csg_smooth_kernel_, CSG_KERNEL)
extern const csg_smooth_kernel CSG_THIS_SMOOTH_KERNEL;
#endif

#endif
