/* SPDX-License-Identifier: MIT
 * How far the operands of a fillet turn from each other in a ball, from the gradients that each can
 * have there: what bounds its values (scene/operators/fillet.h) and its gradient.
 */
#ifndef CSG_FIELD_CONE_FILLET_H
#define CSG_FIELD_CONE_FILLET_H

#include "field/tape.h"

/* Of any two operands: 1 - cos of the angle between their gradients, 0..2. */
typedef struct csg_fillet_turns {
    float least, most;
} csg_fillet_turns;

/* node: of the tape, a fillet. */
csg_fillet_turns csg_fillet_find_turns(const csg_tape *tape, const csg_tape_node *node,
                                       const float c[3], double radius);

/* The gradient of the fillet in the ball lies within *stray of the convex hull of its operands'
 * (and its planes'): they turn, and the blend with them, the less the farther two operands' values
 * are `apart`. False: no bound. */
bool csg_fillet_find_stray(const csg_tape *tape, const csg_tape_node *node, const float c[3],
                           double radius, double apart, double *stray);

#endif
