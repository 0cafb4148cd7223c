/* SPDX-License-Identifier: MIT
 * The same solid by leaves that are no steeper than 1. Sharp operators take the largest or the
 * smallest of values, so of their signs nothing changes where a leaf is divided by a number above
 * 0. Beside a steep formula the field is flat along the faces of whatever else there is, and balls
 * free of surface are smaller there by its Lipschitz constant than they could be: with every leaf
 * divided by its own constant they are not.
 */
#ifndef CSG_FIELD_UNIT_SLOPES_H
#define CSG_FIELD_UNIT_SLOPES_H

#include "field/tape.h"

/* *out: a field of the same sign everywhere, which borrows all but what differs; that is the
 * arena's. The field itself where that is as good already, or where something looks at more than
 * signs (blends, rules, offsets of formulas). False: out of memory. */
bool csg_field_with_unit_slopes(const csgm_field *field, csg_arena *arena, csgm_field *out);

/* Whether nothing looks at more than the signs of leaves that may be divided. */
bool csg_tape_is_by_signs(const csg_tape *tape);

/* A leaf's values divided by a number above 0, in a copy of the tape's parameters: they are rounded
 * once more, which leaves their signs. */
void csg_leaf_divide(const csg_tape *tape, const csg_tape_node *leaf, float by, float *parameters);

#endif
