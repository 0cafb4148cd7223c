/* SPDX-License-Identifier: MIT
 * Formulas divided by how steep they are near a place. Where nothing looks at more than signs
 * (field/unit_slopes.h) the solid stays the same, and balls that are free of surface become as
 * large as the slopes around allow instead of those of the steepest place anywhere.
 */
#ifndef CSG_FIELD_NEAR_SLOPES_H
#define CSG_FIELD_NEAR_SLOPES_H

#include "field/tape.h"

/* Whether a tape has formulas that may be divided. */
bool csg_tape_has_near_slopes(const csg_tape *tape);

/* parameters: a copy of the tape's; its formulas' are made such that none is steeper than 1 in the
 * cube of that half edge around c, or left as they are. */
void csg_tape_set_near_slopes(const csg_tape *tape, const float c[3], double half,
                              float *parameters);

#endif
