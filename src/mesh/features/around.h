/* SPDX-License-Identifier: MIT
 * Short tapes for points that no block at hand covers: pruned for a cube around them, and kept
 * while the next points lie in it too. Within a cell's edge from the surface they give the bits of
 * the whole tape.
 */
#ifndef CSG_MESH_FEATURES_AROUND_H
#define CSG_MESH_FEATURES_AROUND_H

#include "field/prune/prune.h"
#include "mesh/marching/marching.h"

/* One thread's. All zero: nothing kept yet. */
typedef struct csg_feature_around {
    csg_memory *memory; /* NULL until it is used */
    csg_pruner pruner;
    csg_arena arena;
    csg_arena_mark empty;
    csg_tape tape;
    float center[3], half; /* half < 0: no tape */
    bool out_of_memory;    /* once: the whole tape has stood in */
} csg_feature_around;

/* Makes its pruner and arena ready, once. */
void csg_feature_around_begin(csg_feature_around *around, csg_memory *memory,
                              const csg_marching *marching);
void csg_feature_around_release(csg_feature_around *around);

bool csg_feature_around_holds(const csg_feature_around *around, float x, float y, float z);

/* Keeps the tape of the cube that holds all points nearer than `half` to the centre along every
 * axis. Where memory does not suffice it is the whole tape. */
void csg_feature_around_move(csg_feature_around *around, csg_memory *memory,
                             const csg_marching *marching, const float center[3], float half);

#endif
