/* SPDX-License-Identifier: MIT
 * Values and gradients of the field at points in and around a block: by the tape of the block (or
 * of the part of it) that holds a point, else by one pruned for the place (around.h).
 */
#ifndef CSG_MESH_FEATURES_PROBE_H
#define CSG_MESH_FEATURES_PROBE_H

#include <math.h>

#include "mesh/features/features.h"

/* Beyond this many nodes the whole tape is too slow to ask or to prune: points outside the block
 * are not known then, pruned or not. */
enum { CSG_FEATURE_PROBE_MOST_NODES = 4096 };

typedef struct csg_feature_probe {
    const csg_marching *marching;
    const csg_block *block;
    csg_feature_around *around;
    csg_memory *memory;               /* for around */
    float line[3][CSG_BLOCK_SAMPLES]; /* the block's lattice coordinates */
    float *scratch;
    size_t scratch_floats;
    uint64_t evaluations;
} csg_feature_probe;

/* block NULL: points are anywhere. `around` is the caller's, and serves one probe at a time. */
csg_feature_probe csg_feature_probe_of(const csg_marching *marching, const csg_block *block,
                                       csg_feature_around *around, csg_memory *memory,
                                       float *scratch, size_t scratch_floats);

/* 1 - cos of 3 degrees: where gradients differ by less there is no crease. */
#define CSG_FEATURE_LEAST_JUMP 1.37e-3f

/* Of the angle between two gradients; 1 where one is 0: a critical point says nothing. */
static inline float csg_feature_cosine(const float *a, const float *b)
{
    float ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    float aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    float bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    float length = sqrtf(aa * bb);
    return length > 1e-12f ? ab / length : 1.0f;
}

/* f[i] and g[0..2][i] at count points; f is NaN where the field is not known. f may be NULL. */
void csg_feature_probe_points(csg_feature_probe *probe, const float *x, const float *y,
                              const float *z, size_t count, float *f, float *const g[3]);

#endif
