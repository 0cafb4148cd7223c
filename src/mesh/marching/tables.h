/* SPDX-License-Identifier: MIT
 * Marching cubes: the triangles of a cell for each of the 256 sign patterns of its corners, derived
 * from one face rule instead of a copied table.
 *
 * Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e = 4 * axis + u + 2 * v: u and
 * v are the edge's coordinates on the other two axes in increasing order.
 */
#ifndef CSG_MESH_MARCHING_TABLES_H
#define CSG_MESH_MARCHING_TABLES_H

#include <stdbool.h>
#include <stdint.h>

enum {
    CSG_CELL_EDGES = 12,
    CSG_CELL_MOST_LOOPS = 4,
    CSG_CELL_MOST_TRIANGLES = 5,
    CSG_CELL_MOST_INDICES = 3 * CSG_CELL_MOST_TRIANGLES
};

typedef struct csg_cell_tables {
    uint8_t count[256];                       /* triangles; bit c of a pattern: corner c inside */
    uint8_t edge[256][CSG_CELL_MOST_INDICES]; /* three edges per triangle, counter-clockwise
                                                       from outside */
    uint8_t offset[CSG_CELL_EDGES][3];        /* lower point of each edge, relative to the cell */
    /* The polygons that the triangles are cut from: those of a loop follow one another, two fewer
     * than it has sides. A loop starts with its lowest edge; counter-clockwise from outside. */
    uint8_t loop_count[256];
    uint8_t loop_sides[256][CSG_CELL_MOST_LOOPS];
    uint8_t loop_edge[256][CSG_CELL_MOST_LOOPS][CSG_CELL_EDGES];
    uint8_t faces[CSG_CELL_EDGES]; /* bit 2 axis + side: the edge lies in that face of the cell */
} csg_cell_tables;

void csg_cell_tables_make(csg_cell_tables *tables);

/* The polygons of a cell, as in the tables. */
typedef struct csg_cell_loops {
    uint8_t count;
    uint8_t sides[CSG_CELL_MOST_LOOPS];
    uint8_t edge[CSG_CELL_MOST_LOOPS][CSG_CELL_EDGES];
} csg_cell_loops;

/* Where a face's inside corners lie on a diagonal they may be joined through the face instead of
 * being cut off each, if both cells do so. joined: those faces, bit 2 axis + side. */
csg_cell_loops csg_cell_loops_of(unsigned pattern, unsigned joined);

/* Cuts a loop into triangles, two fewer than it has sides, as the tables do: three edges each.
 * False: there is no cut without a diagonal in a face. */
bool csg_cell_cut(const uint8_t *edge, int sides, uint8_t *triangles);

#endif
