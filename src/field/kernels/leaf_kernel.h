/* SPDX-License-Identifier: MIT
 * Leaves over batches of points: what a build of leaf_kernel.c for one instruction set offers to
 * kernel.c.
 */
#ifndef CSG_FIELD_LEAF_KERNEL_H
#define CSG_FIELD_LEAF_KERNEL_H

#include "field/kernels/warp_kernel.h"

/* A walk's points as they are below a warp: leaves below one warp stand together, and all but the
 * first find them here. */
typedef struct csg_warped_points {
    uint32_t warp; /* as csg_tape_node.warp; 0: none are here */
    float x[CSG_BATCH], y[CSG_BATCH], z[CSG_BATCH];
    csg_warp_slopes slopes; /* of that warp or another one, for gradients */
} csg_warped_points;

/* Of a walk that begins; the rest need not be filled. */
static inline void csg_warped_points_begin(csg_warped_points *warped)
{
    warped->warp = 0;
    warped->slopes.warp = 0;
}

typedef struct csg_leaf_kernel {
    /* `warped`: of these points, or none; with p.count <= CSG_BATCH kept for other leaves. */
    void (*values)(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out,
                   csg_warped_points *warped);
    /* p.count <= CSG_BATCH */
    void (*gradients)(const csg_tape *tape, const csg_tape_node *node, csg_points p, float *out,
                      float *gx, float *gy, float *gz, csg_warped_points *warped);
    /* Bounds over eight cubes by centre and half diagonal. */
    void (*intervals)(const csg_tape *tape, const csg_tape_node *node, csg_points p, float radius,
                      float *low, float *high, csg_warped_points *warped);
} csg_leaf_kernel;

#ifdef CSG_KERNEL
#define CSG_THIS_LEAF_KERNEL CSG_CONCATENATE(csg_leaf_kernel_, CSG_KERNEL)
extern const csg_leaf_kernel CSG_THIS_LEAF_KERNEL;
#endif

#endif
