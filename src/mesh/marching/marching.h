/* SPDX-License-Identifier: MIT
 * Marching cubes over blocks: counting before anything is made, then vertices and triangles
 * straight to their places. Numbers come from ranks and prefix sums: no hash of vertices, no weld.
 */
#ifndef CSG_MESH_MARCHING_MARCHING_H
#define CSG_MESH_MARCHING_MARCHING_H

#include "base/table.h"
#include "field/kernels/roots.h"
#include "grid/adaptive/bricks.h"
#include "grid/octree/octree.h"
#include "mesh/marching/tables.h"

/* Which block is where: an index of `blocks`. */
bool csg_block_index_make(csg_table *index, csg_memory *memory, csg_block *const *blocks,
                          size_t count);
/* NULL where there is none. */
const csg_block *csg_block_index_find(const csg_table *index, csg_block *const *blocks,
                                      const uint32_t at[3]);

/* The tables with each edge as the place of its vertex in csg_marching_room.vertex, relative to the
 * cell's own. */
typedef struct csg_marching_places {
    uint16_t place[256][CSG_CELL_MOST_INDICES];
} csg_marching_places;

void csg_marching_places_make(csg_marching_places *places, const csg_cell_tables *tables);

/* Triangles of the block's cells. */
uint32_t csg_marching_count(const csg_block *block, const csg_cell_tables *tables);

/* Where results go; positions relative to the mesh's origin. normals and colors may be NULL. */
typedef struct csg_marching_output {
    float *positions, *normals; /* of the block's first vertex */
    uint8_t *colors;
    uint32_t *indices;   /* of the block's first triangle */
    uint16_t *materials; /* may be NULL, as normals and colors */
} csg_marching_output;

enum { CSG_BLOCK_MOST_INDICES = 8 * 8 * 8 * CSG_CELL_MOST_INDICES };

/* The four rows of signs around a row of cells. */
typedef struct csg_cell_rows {
    unsigned r[4];  /* y + 2 z */
    unsigned mixed; /* bit x: the corners of cell x do not all agree */
} csg_cell_rows;

static inline csg_cell_rows csg_cell_rows_of(const csg_block *block, int j, int k)
{
    csg_cell_rows s = {{block->inside[k][j], block->inside[k][j + 1], block->inside[k + 1][j],
                        block->inside[k + 1][j + 1]},
                       0};
    unsigned any = s.r[0] | s.r[1] | s.r[2] | s.r[3], all = s.r[0] & s.r[1] & s.r[2] & s.r[3];
    s.mixed = (any | any >> 1) & ~(all & all >> 1) & 0xFF;
    return s;
}

static inline unsigned csg_cell_pattern(const csg_cell_rows *s, int i)
{
    return (s->r[0] >> i & 3) | (s->r[1] >> i & 3) << 2 | (s->r[2] >> i & 3) << 4 |
           (s->r[3] >> i & 3) << 6;
}

/* Vertices of a block by the slots of their edges, axis * CSG_BLOCK_POINTS + lower point, those of
 * the upper rim included. */
typedef struct csg_slots {
    uint32_t count;
    uint16_t slot[CSG_BLOCK_MOST_EDGES]; /* that are crossed, in no order */
    float at[3 * CSG_BLOCK_POINTS][3];
} csg_slots;

/* One thread's room. */
typedef struct csg_marching_room {
    csg_edges edges;
    float channels[4][CSG_BLOCK_MOST_EDGES];
    uint32_t vertex[3][CSG_BLOCK_POINTS]; /* of crossed edges only */
    uint32_t indices[CSG_BLOCK_MOST_INDICES + CSG_CELL_MOST_INDICES];
    csg_slots slots;
    float slopes[3 * CSG_BLOCK_POINTS][3]; /* gradients by slots, of a block that has kept them */
} csg_marching_room;

typedef struct csg_marching {
    const csg_kernel *kernel;
    const csgm_field *field;
    const csg_lattice *lattice;
    const csg_cell_tables *tables;
    const csg_marching_places *places;
    csg_block *const *blocks;
    const csg_table *index;
    const csg_bricks *bricks; /* in place of blocks: of a lattice that follows the shape */
    csg_vec3 shift;           /* field frame -> relative to the mesh's origin */
    float noise;              /* of the field's values: rounding */
    float unit;               /* in the last place of the mesh's largest coordinates */
    float end_distance;       /* of vertices from lattice points: a part of a cell */
} csg_marching;

static inline void csg_marching_shift(const csg_marching *m, const float at[3], float out[3])
{
    out[0] = (float)(m->shift.x + (double)at[0]);
    out[1] = (float)(m->shift.y + (double)at[1]);
    out[2] = (float)(m->shift.z + (double)at[2]);
}

/* All vertices of the block's cells, in the field's frame: those on the rim that belongs to upper
 * neighbours too, with the same bits, since every tape that covers an edge gives the same values on
 * it. Returns point evaluations made. */
uint64_t csg_marching_roots(const csg_marching *marching, const csg_block *block, csg_edges *edges,
                            csg_slots *slots, float *scratch, size_t scratch_floats);

/* Whether they are worth keeping for a second time: those of shapes, which are searched through for
 * each value, at four bytes a vertex. along: as many as slots, for block->along. */
bool csg_marching_keeps_roots(const csg_marching *marching);
void csg_marching_keep_roots(const csg_slots *slots, float *along);
/* Whether the gradients there are, too: where normals are of the field's own. By slots, to
 * block->slopes. */
bool csg_marching_keeps_slopes(const csg_marching *marching);
void csg_marching_keep_slopes(const csg_slots *slots, float (*by_slot)[3], float *slopes);

/* The same by the mesh's frame, in room->slots. */
uint64_t csg_marching_shifted_roots(const csg_marching *marching, const csg_block *block,
                                    csg_marching_room *room, float *scratch, size_t scratch_floats);

/* The gradients that normals are of, by a tape that is valid there: the true ones (kernel.h) where
 * the whole tape is not too long to be asked for them, so that no shortening shows. */
void csg_marching_gradients(const csg_marching *marching, const csg_tape *tape, const float *x,
                            const float *y, const float *z, size_t count, float *const out[3],
                            float *scratch, size_t scratch_floats);

/* Colours and materials at the points x, y, z of edges, to their ranks. */
void csg_marching_colors(const csg_marching *marching, const csg_tape *tape, const csg_edges *edges,
                         float *const channels[4], uint8_t *out, float *scratch,
                         size_t scratch_floats);
void csg_marching_materials(const csg_marching *marching, const csg_tape *tape,
                            const csg_edges *edges, float *const channels[4], uint16_t *out,
                            float *scratch, size_t scratch_floats);

/* Numbers of all vertices that the block's cells use, in room->vertex. */
void csg_marching_number(const csg_marching *marching, const csg_block *block,
                         csg_marching_room *room);

/* Vertices of one block. Returns point evaluations made. */
uint64_t csg_marching_vertices(const csg_marching *marching, const csg_block *block,
                               csg_marching_room *room, const csg_marching_output *out,
                               float *scratch, size_t scratch_floats);
void csg_marching_triangles(const csg_marching *marching, const csg_block *block,
                            csg_marching_room *room, const csg_marching_output *out);

/* The block's triangles as 9 floats each, without any neighbour's vertices. Returns point
 * evaluations made. */
uint64_t csg_marching_corners(const csg_marching *marching, const csg_block *block,
                              csg_marching_room *room, float *corners, float *scratch,
                              size_t scratch_floats);

#endif
