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

/* Largest absolute coordinate of a lattice point in the field's frame. */
double csg_lattice_extent(const csg_lattice *lattice);

#endif
