/* SPDX-License-Identifier: MIT
 * How a part moves in relation to another one from a pose to the next: by the screw that leads from
 * the one place to the other (Chasles), of the two the one that turns by no more than 180 degrees.
 */
#ifndef CSG_CLEARANCE_MOTION_H
#define CSG_CLEARANCE_MOTION_H

#include "base/geometry.h"

/* Backwards: from where the mover is at a pose to where it was at the pose before, seen from the
 * other part as it stands at the later pose. */
typedef struct csg_motion {
    csg_affine back;
    double turn; /* |back.m - 1|: 2 sin(angle / 2), or a little more */
    double
        bend; /* no point of a way is farther from its chord than this times the chord's length */
    double slack; /* by which the images may be off; scene units */
} csg_motion;

/* mover_back: from the mover's place at the later pose to that at the earlier one
 * (csg_placement_motion), other_forth: of the other part, the other way; reach: of both placements
 * and of all points that will be asked for, the largest distance from the origin. */
csg_motion csg_motion_between(const csg_affine *mover_back, const csg_affine *other_forth,
                              double reach);

/* The most that a point of the ball is moved. */
double csg_motion_most(const csg_motion *motion, csg_vec3 center, double radius);

#endif
