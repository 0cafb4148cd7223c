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
    /* Bounds over eight boxes low[i] .. high[i]; node: a CSG_OP_COMBINE. */
    void (*box_intervals)(const csg_tape *tape, const csg_tape_node *node,
                          const float *const low[3], const float *const high[3], float *out_low,
                          float *out_high);
} csg_formula_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_FORMULA_KERNEL CSG_CONCATENATE(csg_formula_kernel_, CSG_KERNEL)
extern const csg_formula_kernel CSG_THIS_FORMULA_KERNEL;
#endif

#endif
