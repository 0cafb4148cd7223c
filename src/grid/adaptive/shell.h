/* SPDX-License-Identifier: MIT
 * The leaves of a brick with what finer leaves, of other bricks or in place of its own divided
 * cells, have on common faces and edges: there they have points between their own.
 *
 * Points of the shell are counted in half cells along each axis. Balance sees to it that
 * there are none in between.
 */
#ifndef CSG_GRID_ADAPTIVE_SHELL_H
#define CSG_GRID_ADAPTIVE_SHELL_H

#include "grid/adaptive/bricks.h"

enum { CSG_SHELL_SAMPLES = 2 * CSG_BRICK_EDGE + 1 };

typedef struct csg_shell {
    const csg_brick *brick;
    uint32_t number;                    /* of the brick */
    uint32_t around[CSG_BRICKS_AROUND]; /* csg_bricks_around */
    uint8_t pierced_beyond;             /* cells at which finer leaves have pierced edges, bits as
                                           csg_brick_cell has them */
    bool has_finer; /* finer leaves touch the brick; else what follows says nothing */
    uint16_t inside[CSG_SHELL_SAMPLES][CSG_SHELL_SAMPLES]; /* [z][y]: bit x */
    /* Edges of the brick's cells that finer leaves divide: [axis][z][y]: bit x, by lower point. */
    uint8_t divided_edges[3][CSG_BRICK_SAMPLES][CSG_BRICK_SAMPLES];
    /* Faces of the brick's cells beyond which leaves are finer: the same, by lowest point. */
    uint8_t divided_faces[3][CSG_BRICK_SAMPLES][CSG_BRICK_SAMPLES];
} csg_shell;

void csg_shell_make(csg_shell *shell, const csg_bricks *bricks, uint32_t number);

/* One cell of it. Corners, middles of edges and of faces are the points (x, y, z), each 0 .. 2, of
 * 3 x 3 x 3; bits x + 3 y + 9 z. */
typedef struct csg_shell_cell {
    uint32_t inside; /* of the points in between only those count that are there */
    /* The edge whose middle is this point is divided, the face likewise. */
    uint32_t divided;
    uint32_t pierced; /* of the divided edges those that no finer leaf divides: the point in between
                         is where the brick's surface has its sheets meet */
} csg_shell_cell;

csg_shell_cell csg_shell_cell_of(const csg_shell *shell, unsigned i, unsigned j, unsigned k);

/* Whether a brick has an edge, or a face, for its own among those of the same level that touch in
 * it: the lowest number has, so bricks that are made later take none away, and add none. around: as
 * csg_bricks_around has it. low: the edge's lower point, the face's lowest, in cells. */
bool csg_brick_owns_edge(const uint32_t around[CSG_BRICKS_AROUND], int axis, const unsigned low[3]);
bool csg_brick_owns_face(const uint32_t around[CSG_BRICKS_AROUND], int axis, const unsigned low[3]);

#endif
