/* SPDX-License-Identifier: MIT
 * The octree walk: level by level from one cube down to blocks, dropping cubes that the field
 * proves free of surface and shortening the tape of the others. Each level is one parallel loop;
 * its results are joined in the order of their parents, so cells stay in Morton order for any
 * number of threads.
 */
#ifndef CSG_GRID_OCTREE_H
#define CSG_GRID_OCTREE_H

#include "grid/block.h"

typedef struct csg_octree_options {
    bool prune;
    /* Called on the calling thread; fraction of the walk done. May be NULL. */
    void (*progress)(void *user, double fraction);
    /* Any worker; true = stop. May be NULL. */
    bool (*cancelled)(void *user);
    void *user;
} csg_octree_options;

typedef struct csg_octree_stats {
    uint64_t visited, pruned_outside, pruned_inside, sampled_blocks;
    uint64_t interval_evaluations, point_evaluations, primitive_evaluations, tape_nodes_sampled;
} csg_octree_stats;

/* The blocks that the surface touches, in Morton order. */
typedef struct csg_octree {
    csgm_context *context;
    csg_block **blocks;
    size_t block_count;
    csg_arena *arenas; /* one a worker: blocks and their tapes */
    uint32_t arena_count;
    csg_octree_stats stats;
} csg_octree;

/* CSGM_OK, CSGM_CANCELLED or CSGM_ERR_MEMORY (reported). On failure *out is empty. */
csgm_status csg_octree_walk(csgm_context *context, const csgm_field *field,
                            const csg_lattice *lattice, const csg_octree_options *options,
                            csg_octree *out);
void csg_octree_release(csg_octree *octree);

#endif
