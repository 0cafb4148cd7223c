/* SPDX-License-Identifier: MIT
 * Batches of points: what every kernel works on, and the names of the kernels' builds. kernel.h
 * has what a whole build offers.
 */
#ifndef CSG_FIELD_BATCH_H
#define CSG_FIELD_BATCH_H

#include "field/tape.h"

enum {
    CSG_BATCH = 256, /* points a slot holds at most */
    CSG_LANES = 16,  /* counts are rounded up to this: arrays must have room for it */
    CSG_OCTANTS = 8
};

typedef struct csg_points {
    const float *x, *y, *z;
    size_t count; /* a multiple of CSG_OCTANTS */
} csg_points;

/* Inside the builds: names that end in the build's own. */
#ifdef CSG_KERNEL
#define CSG_CONCATENATE_(a, b) a##b
#define CSG_CONCATENATE(a, b) CSG_CONCATENATE_(a, b)

/* Points that batches are rounded up to in this build: its vectors hold so many, or fewer. */
#ifdef __AVX512F__
enum { CSG_VECTOR = CSG_LANES };
#else
enum { CSG_VECTOR = CSG_OCTANTS };
#endif
#endif

#endif
