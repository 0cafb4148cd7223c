/* SPDX-License-Identifier: MIT
 * Expression fields over batches of points: what a build of formula_kernel.c for one instruction
 * set offers to kernel.c. Arrays as there; node: a CSG_OP_FIELD of the tape.
 */
#ifndef CSG_FIELD_FORMULA_KERNEL_H
#define CSG_FIELD_FORMULA_KERNEL_H

#include "field/kernels/batch.h"

typedef struct csg_formula_kernel {
    /* count: a multiple of CSG_OCTANTS. */
    void (*values)(const csg_tape *tape, const csg_tape_node *node, const float *x, const float *y,
                   const float *z, size_t count, float *out);
    void (*gradients)(const csg_tape *tape, const csg_tape_node *node, const float *x,
                      const float *y, const float *z, size_t count, float *out, float *gx,
                      float *gy, float *gz);
    /* Bounds over eight cubes by centre and half diagonal: interval arithmetic met with the
     * Lipschitz constant, every rounding included. */
    void (*intervals)(const csg_tape *tape, const csg_tape_node *node, const float *cx,
                      const float *cy, const float *cz, float radius, float *low, float *high);
    /* The others: of a CSG_OP_COMBINE, whose operands are arrays `stride` apart. */
    void (*combined)(const csg_tape *tape, const csg_tape_node *node, const float *operands,
                     size_t stride, size_t count, float *out);
    /* Partial derivatives by operands 3 group, 3 group + 1 and 3 group + 2. */
    void (*partials)(const csg_tape *tape, const csg_tape_node *node, const float *operands,
                     size_t stride, size_t count, uint32_t group, float *out,
                     float *const partial[3]);
    /* Bounds over eight boxes. */
    void (*box_intervals)(const csg_tape *tape, const csg_tape_node *node, const float *low,
                          const float *high, size_t stride, float *out_low, float *out_high);
} csg_formula_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_FORMULA_KERNEL CSG_CONCATENATE(csg_formula_kernel_, CSG_KERNEL)
extern const csg_formula_kernel CSG_THIS_FORMULA_KERNEL;
#endif

#endif
