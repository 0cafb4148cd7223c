/* SPDX-License-Identifier: MIT
 * A block of 8^3 cells: its pruned tape, the signs of its 9^3 points and the lattice edges that the
 * surface crosses. Of the samples only those at the ends of such edges are kept, and only of
 * shapes, where each is a search.
 *
 * A lattice edge belongs to the block of its lower point. Edge (axis, x, y, z) of a block, each
 * coordinate in 0..7, is bit 8 y + x of crossed[axis][z]; its vertex is the block's first vertex
 * plus the edge's rank: the number of crossed edges before it in the order of axis, z, bit.
 */
#ifndef CSG_GRID_BLOCK_H
#define CSG_GRID_BLOCK_H

#include "field/prune/prune.h"
#include "grid/octree/bead.h"
#include "grid/octree/lattice.h"
#include "grid/octree/scan.h"

/* An eighth of a block, 4^3 cells, with its own tape: used where the block's tape is long. */
typedef struct csg_block_part {
    const csg_tape_node *nodes;
    uint32_t node_count;
    csg_cell_state state;
} csg_block_part;

typedef struct csg_block {
    uint64_t crossed[3][CSG_BLOCK_EDGE];
    uint16_t rank[3][CSG_BLOCK_EDGE];                      /* crossed edges before that word */
    uint16_t inside[CSG_BLOCK_SAMPLES][CSG_BLOCK_SAMPLES]; /* [z][y]: bit x set where f >= 0 */
    uint32_t at[3];                                        /* in blocks */
    uint32_t node_count;
    const csg_tape_node *nodes;  /* of the pruned tape */
    const csg_block_part *parts; /* eight, or NULL: the block has one tape */
    const float *along; /* of vertices, in the order of csg_marching_roots: their places along their
                           edges' axes; NULL: not known, as after sampling */
    const float *slopes; /* gradients there, three floats each; NULL: not all known */
    const float *ends;   /* values at the ends of crossed edges, point after point
                            (csg_block_unpack_ends); NULL: not kept */
    uint32_t vertex_count, triangle_count;
    uint32_t first_vertex;
    uint64_t first_triangle;
} csg_block;

enum {
    CSG_PART_EDGE = CSG_BLOCK_EDGE / 2,
    CSG_BLOCK_POINTS = CSG_BLOCK_SAMPLES * CSG_BLOCK_SAMPLES * CSG_BLOCK_SAMPLES,
    CSG_BLOCK_POINTS_PADDED = (CSG_BLOCK_POINTS + CSG_LANES - 1) / CSG_LANES * CSG_LANES
};

/* Gives a tape of the block's field the nodes that hold in one of its cells, which the surface
 * crosses. */
static inline void csg_block_choose_tape(const csg_block *block, const int cell[3], csg_tape *tape)
{
    unsigned octant = 0;
    for (int axis = 0; axis < 3; axis++)
        octant |= (unsigned)(cell[axis] >= CSG_PART_EDGE) << axis;
    tape->nodes = block->parts ? block->parts[octant].nodes : block->nodes;
    tape->count = block->parts ? block->parts[octant].node_count : block->node_count;
}

/* One thread's room for sampling: coordinates and values, x fastest; a part has 5^3 points. */
typedef struct csg_block_samples {
    float x[CSG_BLOCK_POINTS_PADDED], y[CSG_BLOCK_POINTS_PADDED], z[CSG_BLOCK_POINTS_PADDED];
    float f[CSG_BLOCK_POINTS_PADDED];
    float values[CSG_BLOCK_POINTS]; /* of the whole block, if it keeps ends; NAN where nobody has
                                       asked */
    uint8_t inside[CSG_BLOCK_POINTS_PADDED];
    csg_scan *scan; /* looks at the values before they are forgotten; NULL = nobody does */
} csg_block_samples;

/* Fills everything but the triangle and first_* members; block->parts is set already. beads looks
 * for beads of tips; NULL: they stay. False: no lattice edge is crossed. */
bool csg_block_sample(csg_block *block, const csg_kernel *kernel, const csg_tape *tape,
                      const csg_lattice *lattice, const uint32_t at[3], csg_beads *beads,
                      csg_block_samples *samples, float *scratch, size_t scratch_floats);

/* Whether blocks of a tape keep values: where each is a search, as of shapes. */
static inline bool csg_block_keeps_ends(const csg_tape *tape)
{
    return tape->shapes != NULL;
}

/* Keeps the values at the ends of crossed edges, if all are known as the field has them: they are
 * asked for again where roots are looked for. False: out of memory.
 */
bool csg_block_keep_ends(csg_block *block, const csg_block_samples *samples, csg_arena *arena);
/* Of a block that has them: values by points. */
void csg_block_unpack_ends(const csg_block *block, float values[CSG_BLOCK_POINTS]);

#endif
