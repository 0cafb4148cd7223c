/* SPDX-License-Identifier: MIT
 * Soft nodes and operators on fields over batches of points: what a build of rule_kernel.c for one
 * instruction set offers to kernel.c. Counts are multiples of CSG_OCTANTS and at
 * most CSG_BATCH.
 */
#ifndef CSG_FIELD_RULE_KERNEL_H
#define CSG_FIELD_RULE_KERNEL_H

#include "field/kernels/batch.h"

typedef struct csg_rule_kernel {
    /* In place, of a SOFTEN node or of an operator on fields (its children joined): what it
     * delivers. slope: its derivative, but for the delivery's scale, flat: 1 where F has reached 0
     * or 1, else 0; both or NULL. */
    void (*deliver)(const csg_tape *tape, const csg_tape_node *node, float *values, float *slope,
                    float *flat, size_t count);
    /* The same for eight intervals, rounding included. */
    void (*deliver_intervals)(const csg_tape *tape, const csg_tape_node *node, float *low,
                              float *high);
    /* The join of node with parameters of its operator: a = a op b. */
    void (*join)(const csg_tape_node *node, const float *parameters, float *a, const float *b,
                 size_t count);
    /* Its partial derivatives; changes neither a nor b. */
    void (*partials)(const csg_tape_node *node, const float *parameters, const float *a,
                     const float *b, float *by_a, float *by_b, size_t count);
    /* For colours: a's share, from the partial derivatives (in by_a; overwritten) and what each
     * operand adds to the result: an operand that may be dropped has none. */
    void (*shares)(const csg_tape_node *node, const float *a, const float *b, float *by_a,
                   const float *by_b, size_t count);
    /* A TURNING join: a = N_S(B(a, b)) and its partial derivatives for gradients ga and gb. */
    void (*turn)(const float *parameters, float *a, const float *b, float *const ga[3],
                 float *const gb[3], float *by_a, float *by_b, size_t count);
    /* a = a op b for eight intervals, rounding included. */
    void (*join_intervals)(const csg_tape_node *node, const float *parameters, float *a_low,
                           float *a_high, const float *b_low, const float *b_high);
} csg_rule_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_RULE_KERNEL CSG_CONCATENATE(csg_rule_kernel_, CSG_KERNEL)
extern const csg_rule_kernel CSG_THIS_RULE_KERNEL;
#endif

#endif
