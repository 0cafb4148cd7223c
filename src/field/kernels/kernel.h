/* SPDX-License-Identifier: MIT
 * What a build of kernel.c for one instruction set offers. One operation runs over a whole batch
 * of points before the next, so that dispatch costs nothing.
 */
#ifndef CSG_FIELD_KERNEL_H
#define CSG_FIELD_KERNEL_H

#include "field/kernels/batch.h"

/* Arrays of one batch that a walk over a tape of this depth needs: values, up to six channels, and
 * the round operator's work (its operands again and six more). */
static inline size_t csg_kernel_arrays(uint32_t depth)
{
    return (size_t)depth * 8 + 8;
}
/* True gradients need a walk's arrays, again for operands at places nearby, and as many once more
 * for what these are kept in. */
enum { CSG_KERNEL_WALKS = 3 };

/* Floats of scratch for every function below: whole batches for ordinary depths, smaller ones for
 * tapes that would need megabytes. */
size_t csg_kernel_scratch_floats(uint32_t depth);

typedef struct csg_edges csg_edges; /* roots.h */

typedef struct csg_kernel {
    const char *name;

    /* out[i] = f(x[i], y[i], z[i]) in the tape's frame for i < count, count <= any; arrays have
     * room for count rounded up to CSG_LANES. */
    void (*values)(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *out, float *scratch, size_t scratch_floats);

    /* Gradients (forward mode), same rules. Zero at critical points. */
    void (*gradients)(const csg_tape *tape, const float *x, const float *y, const float *z,
                      size_t count, float *gx, float *gy, float *gz, float *scratch,
                      size_t scratch_floats);

    /* Both by one walk: the same values and gradients. */
    void (*values_and_gradients)(const csg_tape *tape, const float *x, const float *y,
                                 const float *z, size_t count, float *out, float *gx, float *gy,
                                 float *gz, float *scratch, size_t scratch_floats);

    /* Gradients of the values as they are: with what a fillet or a turning join gains as its
     * operands' gradients turn from place to place, which `gradients` leaves out. For a tape that
     * is valid everywhere: operands are asked for nearby, where one that is shortened keeps its
     * value but not theirs. Seven gradients of operands each where they blend. */
    void (*true_gradients)(const csg_tape *tape, const float *x, const float *y, const float *z,
                           size_t count, float *gx, float *gy, float *gz, float *scratch,
                           size_t scratch_floats);

    /* Colours: the leaves' in the proportions of the operators' partial derivatives; rgba[4]
     * arrays of count. */
    void (*colors)(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *const rgba[4], float *scratch, size_t scratch_floats);

    /* Intervals of every node's value (before its join) over eight cubes, given by the balls
     * around them: low[8 * i + o] <= value of node i over cube o <= high[8 * i + o], rounding of
     * the leaves included. turns: of node i, a fillet, in cube o the least and the most that two of
     * its operands turn from each other, turns[16 * i + 2 * o] and the next (cone_fillet.h); NULL:
     * by anything. */
    void (*intervals)(const csg_tape *tape, const float cx[CSG_OCTANTS],
                      const float cy[CSG_OCTANTS], const float cz[CSG_OCTANTS], float radius,
                      const float *turns, float *low, float *high, float *scratch);

    /* Values of the leaves alone, each joined with nothing: out[count * i + k] of node i at point
     * k; what stands there of other nodes is left as it is. count: a multiple of CSG_OCTANTS, at
     * most CSG_BATCH. */
    void (*leaves)(const csg_tape *tape, const float *x, const float *y, const float *z,
                   size_t count, float *out);

    /* Points through all warps from the outermost to number `warp`, as a leaf below has them;
     * count <= CSG_BATCH. */
    void (*warped)(const csg_tape *tape, uint32_t warp, float *x, float *y, float *z, size_t count);

    /* One join alone, a = a op b, for benchmarks: node is a child that joins, count a multiple of
     * CSG_LANES and at most CSG_BATCH. Not one that turns with gradients. */
    void (*join)(const csg_tape *tape, const csg_tape_node *node, float *a, const float *b,
                 size_t count);

    /* Fills x, y, z of edges with ends of different signs. noise: the
     * field's rounding error, below which no value is better than another.
     * Returns point evaluations made. */
    uint64_t (*roots)(const csg_tape *tape, csg_edges *edges, float noise, float *scratch,
                      size_t scratch_floats);
} csg_kernel;

/* ---- inside the builds: names that end in the build's own ---------------------------------- */

#ifdef CSG_KERNEL
#define CSG_THIS_KERNEL CSG_CONCATENATE(csg_kernel_, CSG_KERNEL)
#define CSG_THIS_ROOTS CSG_CONCATENATE(csg_roots_, CSG_KERNEL)

extern const csg_kernel CSG_THIS_KERNEL;
uint64_t CSG_THIS_ROOTS(const csg_tape *tape, csg_edges *edges, float noise, float *scratch,
                        size_t scratch_floats);
#endif

#endif
