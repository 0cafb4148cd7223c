/* SPDX-License-Identifier: MIT
 * Bounds on the gradients of formulas over a cube; see near_slopes.h.
 */
#include "field/cones/near_slopes.h"

#include <math.h>

#include "field/gradients/cone_leaf.h"
#include "field/point.h"
#include "field/unit_slopes.h"

/* What raises a formula is rounded, and its zero would be another one. */
static bool is_divided(const csg_tape *tape, const csg_tape_node *node)
{
    return node->op == CSG_OP_FIELD && tape->parameters[node->parameters + CSG_LEAF_RAISE] == 0;
}

bool csg_tape_has_near_slopes(const csg_tape *tape)
{
    bool any = false;
    for (uint32_t i = 0; i < tape->count && !any; i++)
        any = is_divided(tape, &tape->nodes[i]);
    return any && csg_tape_is_by_signs(tape);
}

/* The formula's slope in the region, at most; 1: that, or nothing better is known. */
static double slope_in(const csg_tape *tape, const csg_tape_node *leaf,
                       const csg_cone_region *region)
{
    const double least = 1.0 / 64; /* so that roundings stay small */
    csg_cone_balls balls = {.count = 0};
    double most = 0;
    if (!csg_cone_add_leaf_in(&balls, tape, leaf, region))
        return 1;
    for (uint32_t i = 0; i < balls.count; i++)
        most = fmax(most, csg_norm3(balls.items[i].at) + balls.items[i].spread);
    return fmin(fmax(most * (1 + 0x1p-12), least), 1);
}

void csg_tape_set_near_slopes(const csg_tape *tape, const float c[3], double half,
                              float *parameters)
{
    const csg_cone_region cube = {{c[0], c[1], c[2]}, 1.7320508076 * half, half, INFINITY};
    for (uint32_t i = 0; i < tape->count; i++)
        if (is_divided(tape, &tape->nodes[i]))
            csg_leaf_divide(tape, &tape->nodes[i], (float)slope_in(tape, &tape->nodes[i], &cube),
                            parameters);
}
