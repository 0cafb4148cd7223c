/* SPDX-License-Identifier: MIT
 * Looking for what lies between the points of a brick: parts and gaps thinner than a cell.
 *
 * Where the gradients of a brick are within a cone there is one sheet, and nothing to look for.
 * Elsewhere the points half way between its own are asked, and from each of them a step is made to
 * where the surface should be and a little beyond: if the sign is another one there, in a cell
 * whose corners agree, something was missed. What is thicker than a cell of the finest level is
 * then found by dividing.
 */
#ifndef CSG_MESH_ADAPTIVE_HUNT_H
#define CSG_MESH_ADAPTIVE_HUNT_H

#include "grid/adaptive/bricks.h"
#include "mesh/adaptive/sheets.h"

enum {
    CSG_HUNT_POINTS =
        (2 * CSG_BRICK_EDGE + 1) * (2 * CSG_BRICK_EDGE + 1) * (2 * CSG_BRICK_EDGE + 1),
    CSG_HUNT_LEAF_POINTS = 192,
    CSG_HUNT_MOST = CSG_HUNT_POINTS + CSG_HUNT_LEAF_POINTS
};

/* Places of the surface in cells that it crosses, to be held against their polygons. */
typedef struct csg_hunted {
    int count;
    csg_vec3 at[CSG_HUNT_MOST];
    uint8_t cell[CSG_HUNT_MOST];
} csg_hunted;

/* Those of the cells (bits as csg_brick_cell has them) in which something lies that their corners
 * do not show, deeper than a part of the tolerance. f: values at the brick's points. */
uint8_t csg_hunt(csg_sheet_probe *probe, const csg_bricks *bricks, const csg_brick *brick,
                 double tolerance, const float *f, uint8_t cells, csg_hunted *out);

/* The same of what single leaves of the tape put there (hunt_leaves.c); adds places to `out`. */
uint8_t csg_hunt_leaves(csg_sheet_probe *probe, const csg_bricks *bricks, const csg_brick *brick,
                        double tolerance, uint8_t cells, csg_hunted *out);

#endif
