/* SPDX-License-Identifier: MIT
 * How fast the gradient of a formula turns in a box, by interval arithmetic on second derivatives.
 */
#ifndef CSG_FIELD_BEND_FORMULA_H
#define CSG_FIELD_BEND_FORMULA_H

#include "field/gradients/cone_formula.h"

/* x, y, z in `at`, of which the formula is a function all over. *bend: no less than the norm of the
 * matrix of second derivatives anywhere in the box. False: nothing is known, as where a minimum or
 * an absolute value may change sides. */
bool csg_bend_formula(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                      double *bend);

enum { CSG_MOST_KINKS = 8 };

/* Where the gradient of a formula may jump: where the operand of an absolute value is zero, or
 * those of a minimum or a maximum are the same. */
typedef struct csg_kink {
    uint32_t step; /* of the formula, from its first one on */
    double slope;  /* how fast the operand, or the difference of both, changes at most */
    double size;   /* of operands, at most */
} csg_kink;

/* A formula in a box, between its kinks there. */
typedef struct csg_formula_pieces {
    double bend; /* no less than the norm of the matrix of second derivatives anywhere but there */
    uint32_t kink_count;
    csg_kink kinks[CSG_MOST_KINKS];
} csg_formula_pieces;

/* False: nothing is known, or there are too many kinks. */
bool csg_bend_pieces(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                     csg_formula_pieces *out);

#endif
