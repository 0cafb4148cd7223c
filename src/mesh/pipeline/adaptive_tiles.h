/* SPDX-License-Identifier: MIT
 * A mesh of cells that follow the shape whose triangles, as they are before they are thinned out,
 * are too many for the memory: they are made and thinned out tile by tile. What is left is joined.
 */
#ifndef CSG_MESH_PIPELINE_ADAPTIVE_TILES_H
#define CSG_MESH_PIPELINE_ADAPTIVE_TILES_H

#include "mesh/adaptive/extraction.h"
#include "mesh/pipeline/input.h"
#include "mesh/reshape/tolerance.h"

/* Bricks that a tile may have at most; 0: the mesh is made as a whole. Depends on the lattice, the
 * goal and the limit of memory alone. */
size_t csg_mesh_tile_bricks(const csg_bricks *bricks, const csg_mesh_goal *goal,
                            uint64_t limit_bytes);

/* Tiles of at most so many bricks, joined: what goal->joined points to, which is empty before, for
 * csg_joined_write. *any: places of the surface were found that are not near the mesh;
 * the cells there are wanted divided, and there is no mesh. CSGM_OK or why it was stopped
 * (reported). */
csgm_status csg_mesh_make_tiles(const csg_mesh_input *input, const csg_marching *marching,
                                const csg_mesh_goal *goal, csg_extraction *extraction,
                                size_t most_bricks, bool *any);

#endif
