/* SPDX-License-Identifier: MIT
 * A lattice whose cells have different sizes: an octree of bricks, each 2^3 cells that are sampled,
 * judged and kept together. A cell is a leaf, or divided: then a brick of the next level is in its
 * place, or nothing where the field proves it free of surface. Leaves that share an edge or a side
 * which the surface crosses differ by one level at most; the mesh is made of them.
 *
 * Level 0 is one cube around everything; a brick of level l has cells of 2^(finest - l) cells of
 * the finest lattice, so every point has one index, and one coordinate, at all levels. Which cells
 * are divided depends on the field and the lattice alone: no more than the judge, who makes the
 * mesh and the balance ask for.
 */
#ifndef CSG_GRID_ADAPTIVE_BRICKS_H
#define CSG_GRID_ADAPTIVE_BRICKS_H

#include "base/rank_loop.h"
#include "base/table.h"
#include "field/prune/prune.h"
#include "grid/octree/lattice.h"

enum {
    CSG_BRICK_EDGE = 2, /* cells */
    CSG_BRICKS_AROUND = 27,
    CSG_BRICK_SAMPLES = CSG_BRICK_EDGE + 1,
    CSG_BRICK_POINTS = CSG_BRICK_SAMPLES * CSG_BRICK_SAMPLES * CSG_BRICK_SAMPLES,
    CSG_BRICK_POINTS_PADDED = (CSG_BRICK_POINTS + CSG_LANES - 1) / CSG_LANES * CSG_LANES
};

#define CSG_BRICK_NONE UINT32_MAX
#define CSG_BRICK_ALL_CELLS UINT8_C(0xFF)
_Static_assert(CSG_BRICK_EDGE == 2, "cells are octants, a byte has a bit for each");

typedef struct csg_brick {
    const csg_tape_node *nodes; /* of the tape that holds in it */
    uint32_t node_count;
    uint32_t at[3]; /* in bricks of its level */
    uint8_t level;
    /* Cells, bits as csg_brick_cell has them: */
    uint8_t divided;  /* no leaves */
    uint8_t wanted;   /* to be divided */
    uint8_t searched; /* nothing is hidden between their points; of a cell it holds for all in it */
    uint8_t crossed;  /* their corners do not all agree */
    uint8_t flat;     /* their polygon is cut into triangles without a point inside */
    uint8_t several;  /* with several polygons: they are small enough for them */
    uint8_t inside[CSG_BRICK_SAMPLES][CSG_BRICK_SAMPLES]; /* [z][y]: bit x set where f >= 0 */
    uint64_t pierced; /* edges that the surface crosses twice: bits as csg_brick_edge has them */
    const struct csg_judged *judged; /* what the judge keeps of it for himself */
} csg_brick;

/* Some of its cells are not divided. */
static inline bool csg_brick_has_leaves(const csg_brick *brick)
{
    return brick->divided != CSG_BRICK_ALL_CELLS;
}

typedef struct csg_bricks csg_bricks;

/* Sets which cells of a brick, sampled and all leaves, are `wanted`; it may set the brick's `flat`,
 * `several`, `searched`, `judged` and `pierced`, and what is crossed because of it. f: values at
 * the brick's points, x fastest. False: out of memory. Any worker. */
typedef bool csg_brick_judge(void *user, uint32_t worker, const csg_bricks *bricks,
                             csg_brick *brick, const float *f);

/* Bricks from `first` on are in their places, with their neighbours; those that come later have
 * higher numbers. False: out of memory. The calling thread. */
typedef bool csg_bricks_joined(void *user, csg_bricks *bricks, size_t first);

/* What the judge has found of a brick that others have to know (base/rank_loop.h): beyond the
 * brick's own members, `judged`. False: out of memory. The calling thread. */
typedef bool csg_brick_tell(void *user, const csg_brick *brick, csg_records *records);
typedef bool csg_brick_hear(void *user, csg_brick *brick, csg_record_reader *reader, size_t item);

typedef struct csg_bricks_options {
    bool prune;      /* false: values come from the whole tape; what is divided stays the same */
    uint32_t coarse; /* the level of the largest leaves */
    size_t most;     /* bricks: beyond them refinement ends */
    csg_brick_judge *judge;
    csg_bricks_joined *joined; /* these three are NULL where the judge keeps nothing */
    csg_brick_tell *tell;
    csg_brick_hear *hear;
    void *judge_user;
    void (*progress)(void *user, double fraction); /* calling thread; may be NULL */
    bool (*cancelled)(void *user);                 /* any worker; may be NULL */
    csgm_status (*why)(void *user); /* it was cancelled, reported; NULL: CSGM_CANCELLED */
    void *user;
} csg_bricks_options;

typedef struct csg_bricks_stats {
    uint64_t visited, pruned_outside, pruned_inside, sampled;
    uint64_t interval_evaluations, point_evaluations, primitive_evaluations;
} csg_bricks_stats;

struct csg_bricks {
    csgm_context *context;
    const csgm_field *field;
    const csg_kernel *kernel;
    const csg_lattice *lattice; /* the finest */
    uint32_t finest;            /* its level */
    csg_bricks_options options;
    csg_brick *items;
    size_t count, capacity;
    double reported; /* progress: it never falls */
    size_t balanced; /* bricks before this one are, among themselves */
    csg_table index;
    struct csg_bricks_worker *workers;
    uint32_t worker_count;
    csg_bricks_stats stats;
};

/* The root alone. lattice: of the finest cells, its origin where every level has its points.
 * CSGM_OK or CSGM_ERR_MEMORY (reported). */
csgm_status csg_bricks_create(csgm_context *context, const csgm_field *field,
                              const csg_lattice *lattice, const csg_bricks_options *options,
                              csg_bricks *out);
void csg_bricks_destroy(csg_bricks *bricks);

/* Divides what the judge wants, then what the balance wants, until nobody wants anything. Cells
 * that are `wanted` already are divided, too. CSGM_OK; CSGM_ERR_LIMIT where there are too many, not
 * reported; why it was cancelled; CSGM_ERR_MEMORY (reported); or as csg_ranks_exchange has it. */
csgm_status csg_bricks_refine(csg_bricks *bricks);

/* The brick at a place of a level, CSG_BRICK_NONE where there is none. */
uint32_t csg_bricks_find(const csg_bricks *bricks, uint32_t level, const uint32_t at[3]);
/* A brick and those of its level around it: 1 + x + 3 (1 + y) + 9 (1 + z) by steps of -1 to 1;
 * CSG_BRICK_NONE where there is none. */
void csg_bricks_around(const csg_bricks *bricks, uint32_t number,
                       uint32_t around[CSG_BRICKS_AROUND]);
/* The brick whose leaf holds a point of the field's frame, CSG_BRICK_NONE where none does. */
uint32_t csg_bricks_leaf_at(const csg_bricks *bricks, const float at[3]);
/* Whether the leaf at a point of the field's frame has anything of this sign: a corner, or a
 * surface through it. True where there is no leaf. */
bool csg_bricks_have(const csg_bricks *bricks, const float at[3], bool inside);
/* Bricks that have leaves, in Morton order: an array of *count numbers, to be released by the
 * caller. False: out of memory. */
bool csg_bricks_leaves(const csg_bricks *bricks, uint32_t **out, size_t *count);

/* The tape that values of a brick come from. */
csg_tape csg_bricks_tape(const csg_bricks *bricks, const csg_brick *brick);
/* The one that holds in it, for bounds. */
csg_tape csg_bricks_short_tape(const csg_bricks *bricks, const csg_brick *brick);
/* By how much f can change across a cell of this level, and more: the band where values hold. */
float csg_bricks_band(const csg_bricks *bricks, uint32_t level);

/* Cells of the finest lattice along an edge of a cell of this level. */
static inline uint32_t csg_bricks_cell(const csg_bricks *bricks, uint32_t level)
{
    return 1u << (bricks->finest - level);
}

/* The index of a brick's point in the finest lattice. */
static inline uint32_t csg_brick_point(const csg_bricks *bricks, const csg_brick *brick, int axis,
                                       uint32_t i)
{
    return (brick->at[axis] * CSG_BRICK_EDGE + i) << (bricks->finest - brick->level);
}

static inline float csg_brick_coordinate(const csg_bricks *bricks, const csg_brick *brick, int axis,
                                         uint32_t i)
{
    return csg_lattice_coordinate(bricks->lattice, axis, csg_brick_point(bricks, brick, axis, i));
}

/* The bit of a cell. */
static inline unsigned csg_brick_cell(unsigned i, unsigned j, unsigned k)
{
    return i + CSG_BRICK_EDGE * (j + CSG_BRICK_EDGE * k);
}

/* The cell of a bit. */
static inline void csg_brick_cell_place(unsigned cell, unsigned at[3])
{
    at[0] = cell % CSG_BRICK_EDGE;
    at[1] = cell / CSG_BRICK_EDGE % CSG_BRICK_EDGE;
    at[2] = cell / (CSG_BRICK_EDGE * CSG_BRICK_EDGE);
}

/* The bit of a cell that is the octant of its brick at a place, counted in cells. */
static inline unsigned csg_brick_octant(const uint32_t cell[3])
{
    return csg_brick_cell(cell[0] & 1, cell[1] & 1, cell[2] & 1);
}

/* The bit of the edge from a point (low[axis] < CSG_BRICK_EDGE) along an axis. */
static inline unsigned csg_brick_edge(int axis, const unsigned low[3])
{
    const unsigned u = axis == 0 ? low[1] : low[0], v = axis == 2 ? low[1] : low[2];
    enum { PER_AXIS = CSG_BRICK_EDGE * CSG_BRICK_SAMPLES * CSG_BRICK_SAMPLES };
    return (unsigned)axis * PER_AXIS + low[axis] + CSG_BRICK_EDGE * (u + CSG_BRICK_SAMPLES * v);
}

/* The cells that hold a box, an edge or a point: from one place to another, in half cells. */
uint8_t csg_brick_cells_at(const int from[3], const int to[3]);
/* Where bricks of one level less touch the cube that a brick is an octant of, on the brick's own
 * sides: `part`, of CSG_OCTANTS, says on which axes it lies beyond; 0 is the cube itself. A place
 * below 0 is one that no brick has. */
void csg_brick_beside(const csg_brick *brick, unsigned part, uint32_t at[3]);

/* Whether an edge in the box from one of the brick's points to another is pierced. */
bool csg_brick_is_pierced(const csg_brick *brick, const unsigned from[3], const unsigned to[3]);

/* Corner c of cell (i, j, k), at (c & 1, c >> 1 & 1, c >> 2): bit c of the pattern. */
static inline unsigned csg_brick_pattern(const csg_brick *brick, unsigned i, unsigned j, unsigned k)
{
    return (brick->inside[k][j] >> i & 3u) | (brick->inside[k][j + 1] >> i & 3u) << 2 |
           (brick->inside[k + 1][j] >> i & 3u) << 4 | (brick->inside[k + 1][j + 1] >> i & 3u) << 6;
}

/* Whether the surface crosses the edge from a point (low[axis] < CSG_BRICK_EDGE) along an axis. */
static inline bool csg_brick_is_crossed(const csg_brick *brick, int axis, const unsigned low[3])
{
    const unsigned x = low[0] + (axis == 0), y = low[1] + (axis == 1), z = low[2] + (axis == 2);
    return ((brick->inside[low[2]][low[1]] >> low[0] ^ brick->inside[z][y] >> x) & 1) != 0;
}

#endif
