/* SPDX-License-Identifier: MIT
 * What the leaves of a brick have: vertices on their edges and in their faces, polygons, and fans
 * around a point of each.
 */
#ifndef CSG_MESH_ADAPTIVE_CELLS_H
#define CSG_MESH_ADAPTIVE_CELLS_H

#include "mesh/adaptive/cell_loop.h"

/* Vertices on edges and in faces of the bricks listed, to be found by their places. before, amount:
 * of the stage's progress. CSGM_OK or why it was stopped (reported). */
csgm_status csg_cells_find_vertices(csg_cell_loop *loop, double before, double amount);
/* The same of the bricks that are marked CSG_MARK_AROUND, whose shells are kept: then the
 * leaves that they were marked around can be listed, and all that these need is there. */
csgm_status csg_cells_find_vertices_around(csg_cell_loop *loop, const uint8_t *marks, double before,
                                           double amount);

/* A cell that has a polygon. */
typedef struct csg_cell_at_hand {
    csg_cell_loop *loop;
    uint32_t worker;
    const csg_shell *shell;
    unsigned at[3];
    bool is_whole;  /* none of its edges and faces is divided */
    bool is_border; /* finer leaves divide some of them: the judge has not seen it like that */
    csg_cell_polygons polygons;
    csg_sheet_probe *probe;
} csg_cell_at_hand;

typedef bool csg_visit_cell(csg_cell_at_hand *cell);

/* Calls visit for each cell that has one. */
bool csg_cells_each(csg_cell_loop *loop, uint32_t worker, const csg_shell *shell,
                    csg_visit_cell *visit);
/* Its bit. */
static inline unsigned csg_cells_bit(const csg_cell_at_hand *cell)
{
    return csg_brick_cell(cell->at[0], cell->at[1], cell->at[2]);
}
/* Vertices of one of the cell's polygons, crease points between them. False: one is missing, or
 * there are too many, which cannot be: the loop is broken. */
bool csg_cells_gather(csg_cell_at_hand *cell, unsigned polygon, csg_polygon *out);
/* The loop is broken: false. */
bool csg_cells_is_missing(const csg_cell_at_hand *cell);
/* Sets a polygon of a cell aside, in the judge's room for pieces, whose fan is to be found: at most
 * CSG_JUDGED_MOST_APEXES. NULL: one of its vertices is missing. */
csg_cut_polygon *csg_cells_set_aside(csg_cell_at_hand *cell, unsigned polygon);
/* The points in the middle of those that were set aside. */
void csg_cells_find_apexes(csg_cell_loop *loop, uint32_t worker, const csg_shell *shell);

#endif
