/* SPDX-License-Identifier: MIT
 * The cells of one block, each with its kind; between certify.c, which walks over the blocks, and
 * certify_block.c, which divides one.
 */
#ifndef CSG_GRID_CERTIFY_BLOCK_H
#define CSG_GRID_CERTIFY_BLOCK_H

#include "grid/certify/cell_kind.h"
#include "grid/certify/certify_reach.h"
#include "grid/octree/octree.h"

enum {
    CSG_CERTIFY_MARGIN = 7, /* cells around a block where its tape is valid */
    CSG_CELLS_PER_BLOCK = CSG_BLOCK_EDGE * CSG_BLOCK_EDGE * CSG_BLOCK_EDGE
};

/* A cell that is missed or unresolved. */
typedef struct csg_certify_finding {
    uint32_t cell[3]; /* in the lattice */
    uint8_t kind;
    bool is_gap;
    double at[3], thickness;
} csg_certify_finding;

/* A cube still to be looked at. */
typedef struct csg_certify_cube {
    double c[3], half;
    const csg_tape_node *nodes;
    uint32_t node_count;
    csg_arena_mark mark; /* behind its tape and its siblings' */
    uint32_t cell;       /* of the block's, where it is a cell or less; else CSG_CELLS_PER_BLOCK */
} csg_certify_cube;

/* One thread's room. */
typedef struct csg_certify_worker {
    csgm_context *context;
    const csg_lattice *lattice;
    double size;                /* where dividing ends */
    uint32_t most_block_visits; /* of cubes, a block */
    bool has_formulas;
    csg_pruner plain, wide, cones;
    csg_arena tapes;
    csg_reach reach, local; /* the whole margin of the block; around the cell at hand */
    float *near;            /* parameters with slopes near the cube at hand, or NULL: there are no
                               others than the tape's */
    csg_tape local_tape;
    csg_reach_trail trail; /* of the cell at hand */
    csg_block block;
    csg_block_samples *samples;
    csg_certify_cube *stack;
    size_t stack_count, stack_capacity;
    uint8_t kinds[CSG_CELLS_PER_BLOCK];
    uint32_t visits[CSG_CELLS_PER_BLOCK], block_visits;
    bool looked[CSG_CELLS_PER_BLOCK]; /* from its centre */
    csg_certify_finding *findings;    /* of all blocks so far */
    size_t finding_count, finding_capacity;
    uint64_t cells[CSG_CELL_KINDS], cubes;
    bool reached_size, out_of_memory;
    bool (*cancelled)(void *user); /* asked before each cube: one may take long; or NULL */
    void *user;
    bool is_stopped; /* it said yes */
} csg_certify_worker;

/* Looks at all cells of a block, with a tape valid in it and CSG_CERTIFY_MARGIN cells around it.
 * False: out of memory, or stopped. */
bool csg_certify_block(csg_certify_worker *worker, const uint32_t at[3], const csg_tape *tape);

#endif
