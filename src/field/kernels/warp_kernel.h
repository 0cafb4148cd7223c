/* SPDX-License-Identifier: MIT
 * Warps over batches of points: what a build of warp_kernel.c for one instruction set offers to
 * kernel.c. Definitions in double: scene/primitives/warp.c.
 */
#ifndef CSG_FIELD_WARP_KERNEL_H
#define CSG_FIELD_WARP_KERNEL_H

#include "field/kernels/batch.h"

/* A warp's parameters in float, angles in radians. */
void csg_warp_pack(const csg_warp *warp, float own[CSG_WARP_PARAMETERS]);
/* Largest length whose rounding moves the image of a point at most `extent` away. */
double csg_warp_magnitude(const csg_warp *warp, double extent);

/* How a single warp leads on at some points: the columns of its derivative, one after the other. */
typedef struct csg_warp_slopes {
    uint32_t warp; /* as csg_tape_node.warp; 0: none are here */
    float column[3 * 3][CSG_BATCH];
} csg_warp_slopes;

typedef struct csg_warp_kernel {
    /* x, y, z, count <= CSG_BATCH of them, through all warps from the outermost to number `warp`
     * (index + 1), in place. */
    void (*points)(const csg_tape *tape, uint32_t warp, float *x, float *y, float *z, size_t count);
    /* Gradients in the frame below warp number `warp`, of points x, y, z in the tape's own frame,
     * become gradients in that frame. kept: of these points, or none; where there is a single warp
     * on the way, its slopes are left there for the next call. */
    void (*gradients)(const csg_tape *tape, uint32_t warp, const float *x, const float *y,
                      const float *z, size_t count, float *gx, float *gy, float *gz,
                      csg_warp_slopes *kept);
} csg_warp_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_WARP_KERNEL CSG_CONCATENATE(csg_warp_kernel_, CSG_KERNEL)
extern const csg_warp_kernel CSG_THIS_WARP_KERNEL;
#endif

#endif
