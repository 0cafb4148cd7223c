/* SPDX-License-Identifier: MIT
 * Values and gradients of the field at points in and around a block: by the tape of the block (or
 * of the part of it) that holds a point, else by one pruned for the place (around.h).
 */
#ifndef CSG_MESH_FEATURES_PROBE_H
#define CSG_MESH_FEATURES_PROBE_H

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

/* f[i] and g[0..2][i] at count points; f is NaN where the field is not known. f may be NULL. */
void csg_feature_probe_points(csg_feature_probe *probe, const float *x, const float *y,
                              const float *z, size_t count, float *f, float *const g[3]);

#endif
