/* SPDX-License-Identifier: MIT
 * Joins of two operands over batches of points: what a build of join_kernel.c for one instruction
 * set offers to kernel.c. parameters: of the operator that joins. Counts are multiples of
 * CSG_OCTANTS and at most CSG_BATCH.
 */
#ifndef CSG_FIELD_JOIN_KERNEL_H
#define CSG_FIELD_JOIN_KERNEL_H

#include "field/kernel.h"

/* What several channels of each operand become: a's takes the place. */
typedef struct csg_channels {
    float *a[4], *b[4];
    int count;  /* how many in all */
    int colors; /* of them, the last ones: mixed by shares; the others are a gradient */
} csg_channels;

typedef struct csg_join_kernel {
    /* a = a op b. Not for TURNING joins. */
    void (*values)(const csg_tape_node *node, const float *parameters, float *a, const float *b,
                   size_t count);
    /* The same with channels. work: room for three arrays of count, `stride` floats apart. */
    void (*mixed)(const csg_tape_node *node, const float *parameters, float *a, const float *b,
                  const csg_channels *channels, size_t count, float *work, size_t stride);
    /* For eight intervals. */
    void (*intervals)(const csg_tape_node *node, const float *parameters, float *a_low,
                      float *a_high, const float *b_low, const float *b_high);
} csg_join_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_JOIN_KERNEL CSG_CONCATENATE(csg_join_kernel_, CSG_KERNEL)
extern const csg_join_kernel CSG_THIS_JOIN_KERNEL;
#endif

#endif
