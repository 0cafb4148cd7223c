/* SPDX-License-Identifier: MIT
 * Whether a brick's triangles cover the places of the surface that the hunt found in it (hunt.h):
 * the other side of their distance, from the surface to them.
 */
#ifndef CSG_MESH_ADAPTIVE_COVER_H
#define CSG_MESH_ADAPTIVE_COVER_H

#include "mesh/adaptive/hunt.h"

enum {
    CSG_BRICK_CELLS = CSG_BRICK_EDGE * CSG_BRICK_EDGE * CSG_BRICK_EDGE,
    CSG_COVER_MOST_TRIANGLES = 64 * CSG_BRICK_CELLS
};

/* Those of a brick's cells that are good, each cell's together. */
typedef struct csg_brick_triangles {
    csg_vec3 at[CSG_COVER_MOST_TRIANGLES][3];
    uint32_t count, first[CSG_BRICK_CELLS], end[CSG_BRICK_CELLS];
} csg_brick_triangles;

/* How the places lie to the triangles. */
typedef struct csg_cover {
    uint8_t uncovered; /* cells in which one is farther from them than the tolerance */
    int unsure_count;
    csg_vec3 unsure[CSG_HUNT_MOST]; /* so are these, but there may be triangles that are not there
                                       yet: beside other bricks, and beside cells not searched */
    uint8_t off;                    /* cells in which one is a part of it away, and in each the */
    csg_vec3 farthest[CSG_BRICK_CELLS]; /* farthest */
} csg_cover;

/* cells: those searched. */
void csg_cover_find(const csg_brick_triangles *triangles, const csg_bricks *bricks,
                    const csg_brick *brick, const csg_hunted *hunted, double tolerance,
                    uint8_t cells, csg_cover *out);

#endif
