/* SPDX-License-Identifier: MIT
 * A field in a ball in which it is one of several smooth functions (tape_taylor.h), as where a
 * blend begins: a Taylor model of each, and where it is the field.
 */
#ifndef CSG_FIELD_PIECES_H
#define CSG_FIELD_PIECES_H

#include "base/taylor.h"

enum { CSG_TAYLOR_PIECES = 16, CSG_TAYLOR_CONDITIONS = 6 };

/* The field, wherever none of the conditions is negative; is_partial: there are more of them than
 * there was room for, and it may be another one there, too. */
typedef struct csg_taylor_piece {
    csg_taylor f, conditions[CSG_TAYLOR_CONDITIONS];
    int condition_count;
    bool is_partial;
} csg_taylor_piece;

/* At each point of the ball the field is one of these. */
typedef struct csg_taylor_pieces {
    csg_taylor_piece of[CSG_TAYLOR_PIECES];
    int count;
} csg_taylor_pieces;

#endif
