/* SPDX-License-Identifier: MIT
 * How far a solid in a cube can reach along a direction: the solid as a union of pieces, each the
 * cube cut by the planes that it is proven to lie within.
 */
#ifndef CSG_CLEARANCE_SUPPORT_H
#define CSG_CLEARANCE_SUPPORT_H

#include "measure/halves.h"

enum { CSG_PIECES_MOST = 16 };

/* {y : value + slope . y >= 0}, y from the cube's centre, slope of length 1. */
typedef struct csg_clear_plane {
    double value, slope[3];
} csg_clear_plane;

typedef struct csg_clear_pieces {
    csg_clear_plane planes[CSG_HALVES_MOST];
    uint8_t masks[CSG_PIECES_MOST]; /* of each piece: its planes; 0: the whole cube */
    uint8_t plane_count, count;
} csg_clear_pieces;

/* What contains the solid that the planes enclose, their errors and rounding included. */
void csg_clear_pieces_find(const csg_halves *halves, double half, csg_clear_pieces *out);

/* The largest direction . y over the pieces in the cube |y_k| <= half, or more: by the dual of the
 * linear program, of which every point is a bound. NULL: the whole cube. */
double csg_clear_reach(const csg_clear_pieces *pieces, double half, const double direction[3]);

#endif
