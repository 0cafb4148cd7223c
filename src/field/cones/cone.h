/* SPDX-License-Identifier: MIT
 * Cones of gradients: is there one direction in which the field climbs everywhere in a ball?
 *
 * The gradient of a union, intersection or blend is a combination of its operands' gradients with
 * weights >= 0 that add up to 1 (operators.md 0) or more (orthogonal). So a direction v with
 * v . g >= m for the gradients g of all leaves of a pruned tape has v . grad f >= m there. Each
 * leaf states the gradients it can have in the ball: a few balls of vectors, their radius from how
 * fast the gradient of that primitive can turn (cone_leaf.c). Other operators have bounds of their
 * own on the climb along a direction (cone_along.c).
 */
#ifndef CSG_FIELD_CONE_H
#define CSG_FIELD_CONE_H

#include "field/gradients/cone_leaf.h"
#include "field/prune/prune.h"

typedef struct csg_cone {
    double axis[3];     /* v, unit length */
    double least;       /* m > 0 */
    double most;        /* |grad f| is no larger; INFINITY where there is no cone */
    double steep;       /* |grad f| is no more than this times v . grad f */
    double lean;        /* |df/dx| + |df/dy| + |df/dz| is no more than this times v . grad f */
    bool fills_cube;    /* it holds in all of a region's cube, within its ball or not */
    bool is_crease;     /* a sharp operator or an edge of a primitive is there */
    bool out_of_memory; /* so none was found */
} csg_cone;

/* Over the ball around c, for a tape that is valid there. False: there is none, or none could be
 * shown. room: for the intervals that some operators need; NULL: these have no bound then. */
bool csg_cone_find(csg_pruner *room, const csg_tape *tape, const float c[3], double radius,
                   csg_cone *out);

/* The same in a region, with the axis that suits directions, however long the gradients are. Its
 * band counts where all operators are sharp: only of the field within it is then spoken. */
bool csg_cone_find_in(csg_pruner *room, const csg_tape *tape, const csg_cone_region *region,
                      csg_cone *out);

/* ---- cone.c -----------------------------------------------------------------------------------
 */

/* Axis and least climb of a cone that holds the balls' convex hull. False: none was found. */
bool csg_cone_find_axis(const csg_cone_balls *balls, csg_cone *out);

#endif
