/* SPDX-License-Identifier: MIT
 * The gradients of a formula over a box, by interval arithmetic; see cone.h.
 */
#ifndef CSG_FIELD_CONE_FORMULA_H
#define CSG_FIELD_CONE_FORMULA_H

#include "field/tape.h"

typedef struct csg_cone_box {
    float low[3], high[3];
} csg_cone_box;

struct range;

/* x, y, z in `at`, with their own derivatives in seeds; values: of all steps where gradients are
 * asked for (narrow_formula.h), or NULL: all over the box. False: nothing is known. *has_edges is
 * set where a minimum, maximum or absolute value may change sides. */
bool csg_cone_formula(const csg_tape *tape, const csg_tape_formula *formula, const csg_cone_box *at,
                      const csg_cone_box seeds[3], const struct range *values,
                      csg_cone_box *gradient, bool *has_edges);

#endif
