/* SPDX-License-Identifier: MIT
 * The lattice of sample points: integer indices, cubic cells, blocks of 8^3 cells. A coordinate is
 * computed from its global index, never accumulated, so neighbours see the same bits.
 */
#ifndef CSG_GRID_LATTICE_H
#define CSG_GRID_LATTICE_H

#include "base/context.h"
#include "base/geometry.h"

enum {
    CSG_BLOCK_EDGE = 8,                     /* cells */
    CSG_BLOCK_SAMPLES = CSG_BLOCK_EDGE + 1, /* points along an edge: shared with the neighbours */
    CSG_LATTICE_MOST_CELLS = 1 << 20        /* along an axis: 17 bits of block index */
};

typedef struct csg_lattice {
    csg_vec3 origin; /* of point (0, 0, 0), relative to the field's centre */
    double cell_size;
    uint32_t cells[3];  /* points 0 .. cells; the outermost are outside by decree */
    uint32_t blocks[3]; /* ceil(cells / 8) */
} csg_lattice;

/* A lattice around finite, not empty bounds (scene units) with at least one and a half cells to
 * spare, centred, so that faces at the bounds fall between lattice points and not on them.
 * resolution: cells along the longest side; used when cell_size is 0. False when there would be
 * more than CSG_LATTICE_MOST_CELLS cells along an axis, or a side is not a positive number. */
bool csg_lattice_make(csg_box bounds, csg_vec3 center, double cell_size, uint32_t resolution,
                      csg_lattice *out);

static inline float csg_lattice_coordinate(const csg_lattice *lattice, int axis, uint32_t index)
{
    const double origin[3] = {lattice->origin.x, lattice->origin.y, lattice->origin.z};
    return (float)(origin[axis] + (double)index * lattice->cell_size);
}

/* The cell that a point of the field's frame lies in. False: beyond the lattice, or no number. */
static inline bool csg_lattice_cell_of(const csg_lattice *lattice, const float at[3],
                                       uint32_t cell[3])
{
    const double origin[3] = {lattice->origin.x, lattice->origin.y, lattice->origin.z};
    for (int axis = 0; axis < 3; axis++) {
        double place = floor(((double)at[axis] - origin[axis]) / lattice->cell_size);
        if (!(place >= 0 && place < lattice->cells[axis]))
            return false;
        cell[axis] = (uint32_t)place;
    }
    return true;
}

/* A hash for tables of blocks by their coordinates. */
static inline uint64_t csg_lattice_hash(const uint32_t block[3])
{
    return (uint64_t)block[0] | (uint64_t)block[1] << 21 | (uint64_t)block[2] << 42;
}

/* Morton order with x in the lowest bits: negative where a comes before b, 0 where they are one.
 * The axis of the highest differing bit decides, the later axis among equals (Chan 2002). */
int csg_lattice_compare_morton(const uint32_t a[3], const uint32_t b[3]);

/* One of the eight cubes that a cube consists of, in cubes of its size: bit `axis` of the octant.
 */
static inline void csg_lattice_octant(const uint32_t parent[3], int octant, uint32_t at[3])
{
    for (int axis = 0; axis < 3; axis++)
        at[axis] = 2 * parent[axis] + (uint32_t)(octant >> axis & 1);
}

/* Of the ball around a cube of 2 * half cells along an edge and a margin, rounded up. */
float csg_lattice_ball_radius(const csg_lattice *lattice, double margin, uint32_t half);

/* Largest absolute coordinate of a lattice point in the field's frame. */
double csg_lattice_extent(const csg_lattice *lattice);

#endif
