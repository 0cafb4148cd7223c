/* SPDX-License-Identifier: MIT
 * The leaves of a refined lattice in tiles: cubes of it that hold few enough of them. Each cell is
 * of one tile, so triangles of two tiles meet at their common side only.
 */
#ifndef CSG_MESH_ADAPTIVE_TILES_H
#define CSG_MESH_ADAPTIVE_TILES_H

#include "grid/adaptive/bricks.h"

typedef struct csg_tile {
    size_t first, count; /* in csg_tiles.leaves */
    csg_box box; /* field frame; empty: one brick with others in the place of some of its cells */
} csg_tile;

typedef struct csg_tiles {
    csg_memory *memory;
    uint32_t *leaves; /* bricks, in Morton order */
    csg_tile *items;
    size_t leaf_count, count, capacity;
} csg_tiles;

/* Tiles of at most so many bricks. False: out of memory; to be released all the same. */
bool csg_tiles_make(const csg_bricks *bricks, size_t most, csg_tiles *out);
void csg_tiles_release(csg_tiles *tiles);

#endif
