/* SPDX-License-Identifier: MIT
 * The derivatives of rules (operators.def) over ranges of what they are functions of: of the two
 * operands of a join, of the value below a soft node, of the sum that a set operator brings back to
 * 0..1. For who follows gradients through the tape (field/cones/cone_along.h,
 * mesh/distance/slopes.h).
 *
 * Homogeneous joins (RICCI, SCALE_SET, ARC) are convex or concave, so their partial derivatives
 * rise with one operand and fall with the other, and their second derivatives are one number times
 * y^2, -x y, x^2: that of a conic is the determinant of its matrix over the cube of half of its
 * derivative by the value.
 */
#ifndef CSG_FIELD_RULE_SLOPES_H
#define CSG_FIELD_RULE_SLOPES_H

#include "field/tape.h"

typedef struct csg_rule_range {
    double low, high;
} csg_rule_range;

/* Of a join of x and y. */
typedef struct csg_join_slopes {
    csg_rule_range by[2];
    double bend[3]; /* sizes of the second derivatives xx, xy, yy; INFINITY: not known */
} csg_join_slopes;

/* Of fields, x and y, which are nowhere below 0; node: the child that joins. False: nothing is
 * known (a join that turns with its operands' gradients). */
bool csg_join_find_slopes(const csg_tape *tape, const csg_tape_node *node, csg_rule_range x,
                          csg_rule_range y, csg_join_slopes *out);
/* What it makes of two fields. */
double csg_join_value(const csg_tape *tape, const csg_tape_node *node, double x, double y);

/* Of a function of one value. */
typedef struct csg_curve_slopes {
    double least, most;
    double bend; /* size of the second derivative; INFINITY: not known */
} csg_curve_slopes;

/* What a SOFTEN node or an operator on fields delivers, by the value below or by what its joins
 * have made, in `at`. */
void csg_deliver_find_slopes(const csg_tape *tape, const csg_tape_node *node, csg_rule_range at,
                             csg_curve_slopes *out);
double csg_deliver_value(const csg_tape *tape, const csg_tape_node *node, double at);

#endif
