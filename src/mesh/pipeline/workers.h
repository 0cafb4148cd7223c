/* SPDX-License-Identifier: MIT
 * What blocks are made with: the tables and constants that all threads read, and each thread's
 * room; the blocks at hand and how parallel loops share them out.
 */
#ifndef CSG_MESH_PIPELINE_WORKERS_H
#define CSG_MESH_PIPELINE_WORKERS_H

#include "mesh/features/features.h"
#include "mesh/pipeline/input.h"

/* A run on its way to a receiver. */
typedef struct csg_run_buffer {
    float *positions, *normals;
    uint8_t *colors;
    uint32_t *indices;
    float *corners;
    uint32_t *joined;
    size_t position_capacity, normal_capacity, color_capacity, index_capacity, corner_capacity,
        joined_capacity;
} csg_run_buffer;

/* One thread's part. */
typedef struct csg_mesh_worker {
    csg_marching_room *room;
    csg_feature_room *features; /* NULL: plain marching cubes */
    float *scratch;
    csg_run_buffer run;
    csg_box bounds; /* of the vertices made, where the solid is clipped */
    uint64_t point_evaluations, gradient_evaluations, primitive_evaluations;
} csg_mesh_worker;

typedef struct csg_mesh_workers {
    csgm_context *context;
    csg_cell_tables tables;
    csg_marching_places places;
    csg_marching marching; /* its blocks and their index are those of the slab at hand */
    csg_mesh_worker *each; /* NULL until they are created */
    uint32_t count;
    size_t scratch_floats;
} csg_mesh_workers;

/* The input has a lattice. Reports what fails (memory only); to be released all the same. */
csgm_status csg_mesh_workers_create(csg_mesh_workers *workers, const csg_mesh_input *input);
void csg_mesh_workers_release(csg_mesh_workers *workers);

/* The blocks at hand: those of one slab, in Morton order. */
typedef struct csg_mesh_blocks {
    csg_block *const *block;
    size_t count;
} csg_mesh_blocks;

enum { CSG_BLOCKS_PER_ITEM = 64 }; /* of parallel loops, and a receiver's run */

static inline size_t csg_mesh_item_count(const csg_mesh_blocks *blocks)
{
    return (blocks->count + CSG_BLOCKS_PER_ITEM - 1) / CSG_BLOCKS_PER_ITEM;
}
static inline size_t csg_mesh_item_end(const csg_mesh_blocks *blocks, size_t item)
{
    size_t end = (item + 1) * CSG_BLOCKS_PER_ITEM;
    return end < blocks->count ? end : blocks->count;
}

#endif
