/* SPDX-License-Identifier: MIT
 * What is known of a cell of the lattice after looking into it.
 */
#ifndef CSG_GRID_CELL_KIND_H
#define CSG_GRID_CELL_KIND_H

typedef enum csg_cell_kind {
    CSG_CELL_EMPTY,
    CSG_CELL_CERTIFIED,  /* one smooth sheet: all gradients within a cone */
    CSG_CELL_CREASE,     /* the same with an edge or corner in it */
    CSG_CELL_REFINED,    /* looked at finely: nothing thicker than the promise hides */
    CSG_CELL_UNRESOLVED, /* the bounds are too loose, or the cell is too intricate, to tell */
    CSG_CELL_MISSED      /* a part of it is not in the mesh */
} csg_cell_kind;

enum { CSG_CELL_KINDS = CSG_CELL_MISSED + 1 };

#endif
