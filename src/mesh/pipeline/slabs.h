/* SPDX-License-Identifier: MIT
 * Blocks in slabs: stretches of the octree's frontier whose blocks are in memory at one time.
 * Ordinarily there is one. Where the memory limit asks for several, each is sampled twice: once to
 * count, once, from the last to the first, to make its triangles; between them only the rim blocks
 * that earlier slabs refer to (the halo) are kept. The mesh is the same for any number of slabs.
 */
#ifndef CSG_MESH_PIPELINE_SLABS_H
#define CSG_MESH_PIPELINE_SLABS_H

#include "mesh/pipeline/creases.h"

/* A stretch of the octree's frontier, with what comes before it in the numbering. */
typedef struct csg_slab {
    size_t first_cell, end_cell;
    uint64_t vertices, triangles;
    size_t first_block; /* of those with features, as they were found */
} csg_slab;

/* Blocks of slabs already made that slabs still to be made touch from below. Behind them stand
 * those that are not needed any more, to be used again: a halo takes no more than its largest. */
typedef struct csg_halo {
    csg_arena arena;
    csg_block **blocks;
    size_t count, with_spare, capacity;
} csg_halo;

/* Of a frontier cube; and of all before it. */
typedef struct csg_cell_count {
    uint32_t vertices, triangles;
} csg_cell_count;
typedef struct csg_cell_sum {
    uint64_t vertices, triangles;
} csg_cell_sum;

struct csg_mesh_slabs;
struct csg_mesh_output;

/* Who keeps what is finished for a later process (keep.h). */
typedef struct csg_slab_keeper {
    /* Takes slab i as if it were counted now; what is at hand is another one's. False: it is not
     * there, or *status says what fails (reported). */
    bool (*load)(struct csg_mesh_slabs *slabs, size_t i, csgm_status *status);
    /* Slab i is counted; it is made, and where its bytes belong. */
    csgm_status (*counted)(struct csg_mesh_slabs *slabs, size_t i);
    csgm_status (*made)(struct csg_mesh_output *output, const struct csg_mesh_slabs *slabs,
                        size_t i);
} csg_slab_keeper;

typedef struct csg_mesh_slabs {
    /* taken: whose features are counted with the blocks; workers->marching is told the blocks */
    csg_mesh_watch *watch;
    csg_mesh_workers *workers;
    csg_mesh_creases *creases;
    /* made */
    csg_octree *octree;          /* NULL when there is nothing to mesh */
    size_t first_cell, end_cell; /* of the frontier: what this process meshes */
    bool is_whole;               /* all of it on each rank: the mesh is reshaped, by all blocks */
    csg_slab *slabs;
    size_t count;
    size_t to_make;          /* of them, the first: the others are made (keep.h) */
    size_t cells_per_slab;   /* 0: as memory allows */
    csg_mesh_blocks at_hand; /* of one slab */
    bool is_at_hand;         /* the last one, since it was counted */
    uint64_t vertex_count, triangle_count;
    csg_halo halo;
    csg_block **reachable; /* the slab's blocks and the halo's, where there are several slabs */
    size_t reachable_capacity;
    csg_table index;
    /* where other ranks have the rest of the frontier (ranks.h); else NULL and 0 */
    csg_cell_count *counts; /* of each cube from first_cell on */
    size_t counts_bytes;
    csg_cell_sum *before; /* each cube of the frontier, and its end */
    size_t *halo_cells;   /* behind end_cell: those of the first halo */
    size_t halo_count, halo_capacity;
    const csg_slab_keeper *keeper; /* NULL: nobody */
} csg_mesh_slabs;

/* The octree of the input's lattice. */
csgm_status csg_mesh_walk_octree(csg_mesh_slabs *slabs, const csg_mesh_input *input);
/* How many cubes of the frontier a slab may have now for its blocks to fit into the memory limit.
 */
size_t csg_mesh_cells_per_slab(const csg_mesh_slabs *slabs);
/* Divides what this process meshes so that a slab's blocks fit into the memory limit. */
csgm_status csg_mesh_divide_slabs(csg_mesh_slabs *slabs);
/* Divides, counts every slab with its features and numbers its blocks, from 0; leaves the last
 * one's blocks at hand. */
csgm_status csg_mesh_count_slabs(csg_mesh_slabs *slabs);
/* Whether indices can number all vertices; else it is reported. */
csgm_status csg_mesh_check_numbers(csg_mesh_slabs *slabs);
/* Samples halo_cells: all their blocks become the halo of the last slab, counted without features
 * and not numbered. Forgets what is at hand. */
csgm_status csg_mesh_sample_halo(csg_mesh_slabs *slabs);
/* Has the blocks of slab i at hand, numbered, and all that their cells refer to in the index of
 * workers->marching. To be taken from the last to the first: a block's upper neighbours come after
 * it in Morton order, so their numbers are known by then. */
csgm_status csg_mesh_take_slab(csg_mesh_slabs *slabs, size_t i);
/* After slab i is made: keeps what the slabs before it refer to. */
csgm_status csg_mesh_leave_slab(csg_mesh_slabs *slabs, size_t i);
void csg_mesh_slabs_release(csg_mesh_slabs *slabs);

#endif
