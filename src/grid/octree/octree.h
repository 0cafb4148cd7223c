/* SPDX-License-Identifier: MIT
 * The octree walk: level by level from one cube down to blocks, dropping cubes that the field
 * proves free of surface and shortening the tape of the others. Each level is one parallel loop;
 * its results are joined in the order of their parents, so cells stay in Morton order for any
 * number of threads.
 */
#ifndef CSG_GRID_OCTREE_H
#define CSG_GRID_OCTREE_H

#include "grid/octree/block.h"

typedef struct csg_octree_options {
    bool prune;
    /* Tapes and states hold also for what is this far, in scene units, from a cube's faces; values
     * in a band twice as wide. For certify.c, which looks around. 0: the cubes alone. */
    double margin;
    bool beads; /* give beads of tips the other sign: bead.h */
    bool scan;  /* look at the samples for thin parts: csg_octree_doubts */
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

/* The walk's result: the frontier, cubes of 2^3 blocks that the surface may touch, in Morton order,
 * with their tapes; and the blocks of the part of it that was sampled last. The frontier takes a
 * twentieth of the memory of all blocks, so a caller who must save memory samples part by part. */
typedef struct csg_octree csg_octree;

/* CSGM_OK, CSGM_CANCELLED or CSGM_ERR_MEMORY (reported). */
csgm_status csg_octree_create(csgm_context *context, const csgm_field *field,
                              const csg_lattice *lattice, const csg_octree_options *options,
                              csg_octree **out);
void csg_octree_destroy(csg_octree *octree); /* NULL is a no-op */

size_t csg_octree_frontier_count(const csg_octree *octree);
/* The tape of a frontier cube, and its place in cubes of 2^3 blocks. */
csg_tape csg_octree_frontier_tape(const csg_octree *octree, size_t index, uint32_t at[3]);
const uint32_t *csg_octree_frontier_at(const csg_octree *octree, size_t index);
/* Slack of lengths for pruners of this walk's tapes. */
float csg_octree_rounding(const csg_lattice *lattice);
/* Tapes for the eight parts of the block at `at`, in the arena, as a walk with that margin gives
 * them to blocks of long tapes. False: out of memory. */
bool csg_octree_split(csg_pruner *pruner, const csg_lattice *lattice, double margin,
                      const uint32_t at[3], const csg_tape *tape, csg_arena *arena,
                      csg_block_part parts[CSG_OCTANTS]);
/* Samples the blocks of frontier cubes [first, end) and forgets those of the call before. */
csgm_status csg_octree_sample(csg_octree *octree, size_t first, size_t end);
/* The same for the frontier cubes picked[0], picked[1] ..., which nobody looks at for thin parts;
 * what is before frontier cube `first_sampled` is then before what was sampled. */
csgm_status csg_octree_sample_picked(csg_octree *octree, const size_t *picked, size_t count,
                                     size_t first_sampled);
/* The frontier cube at this place; csg_octree_frontier_count: there is none. */
size_t csg_octree_find(const csg_octree *octree, const uint32_t at[3]);
/* The blocks, in Morton order, that the surface touches. */
csg_block *const *csg_octree_blocks(const csg_octree *octree, size_t *count);
/* Whether a block at this place comes, in Morton order, before all of the range sampled last. */
bool csg_octree_is_before_sampled(const csg_octree *octree, const uint32_t at[3]);
/* The most doubtful edge of each doubtful block sampled so far, in an order of their own; *edges:
 * of how many doubtful edges. NULL and *count > 0: out of memory. */
const csg_scan *csg_octree_doubts(csg_octree *octree, size_t *count, uint64_t *edges);
/* From here on samples are not looked at for thin parts. */
void csg_octree_end_scan(csg_octree *octree);
/* Of all doubts those of several walks over one frontier, instead of this walk's own. False: out of
 * memory. */
bool csg_octree_adopt_doubts(csg_octree *octree, const csg_scan *doubts, size_t count);
/* Work done so far. */
csg_octree_stats csg_octree_get_stats(const csg_octree *octree);

#endif
