/* SPDX-License-Identifier: MIT
 * The field at any point near the surface: each point is sent through the pruned tape of the block
 * it lies in, points of one block together; where there is no block, through the whole tape. What
 * comes back has the right sign everywhere and is exact within the band of pruning, |f| <= tau.
 * Points are in the field's frame. One thread's tool.
 */
#ifndef CSG_MESH_REMESH_PROBE_H
#define CSG_MESH_REMESH_PROBE_H

#include "mesh/marching/marching.h"

enum { CSG_PROBE_MOST = 1024 /* points of one call */ };

typedef struct csg_probe {
    const csg_marching *marching;
    csg_memory *memory;
    float tau;   /* half the band's width */
    float noise; /* of values: rounding */
    float *scratch;
    size_t scratch_floats;
    struct csg_probe_room *room;
    uint64_t evaluations;
} csg_probe;

/* marching has its blocks and their index at hand. False: out of memory, nothing to release. */
bool csg_probe_make(csg_probe *probe, const csg_marching *marching, csg_memory *memory);
void csg_probe_release(csg_probe *probe);

/* Up to CSG_PROBE_MOST points. */
void csg_probe_values(csg_probe *probe, const float (*at)[3], size_t count, float *out);
void csg_probe_gradients(csg_probe *probe, const float (*at)[3], size_t count, float (*out)[3]);
/* Both, for little more than the gradients. */
void csg_probe_values_and_gradients(csg_probe *probe, const float (*at)[3], size_t count, float *f,
                                    float (*g)[3]);
/* The gradients of the values, which those above are not where the angle between operands matters
 * (kernel.h): for normals. */
void csg_probe_true_gradients(csg_probe *probe, const float (*at)[3], size_t count,
                              float (*out)[3]);
/* As a block's vertices get them; each of the two may be NULL. */
void csg_probe_looks(csg_probe *probe, const float (*at)[3], size_t count, uint8_t (*colors)[4],
                     uint16_t (*materials)[2]);

#endif
