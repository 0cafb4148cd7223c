/* SPDX-License-Identifier: MIT
 * How far apart what two cubes hold of two parts is.
 */
#ifndef CSG_CLEARANCE_BETWEEN_H
#define CSG_CLEARANCE_BETWEEN_H

#include "clearance/motion.h"
#include "clearance/tree.h"

/* At least; negative: how thin what they have in common is at most. More than `enough` need not be
 * known exactly. line: a direction that may tell; zero: none. *overlap: whether the cubes do.
 * motion: how b moves, and it is all the way that they are so far apart; NULL: it does not. */
double csg_clear_between(const csg_clear_tree *a, uint32_t cube_a, const csg_clear_tree *b,
                         uint32_t cube_b, const csg_motion *motion, csg_vec3 line, double enough,
                         bool *overlap);

#endif
