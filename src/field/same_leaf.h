/* SPDX-License-Identifier: MIT
 * Leaves of a tape that are one figure in one place.
 */
#ifndef CSG_FIELD_SAME_LEAF_H
#define CSG_FIELD_SAME_LEAF_H

#include "field/tape.h"

/* Of the same kind, numbers, frame and warps: what is added to their values, and their sides, may
 * differ. */
bool csg_tape_is_same_leaf(const csg_tape *tape, const csg_tape_node *a, const csg_tape_node *b);

#endif
