/* SPDX-License-Identifier: MIT
 * A ball's points on their way through warps, as Taylor models (base/taylor.h): revolutions, slices
 * and elbows, where they are smooth.
 */
#ifndef CSG_FIELD_WARP_TAYLOR_H
#define CSG_FIELD_WARP_TAYLOR_H

#include "field/tape.h"
#include "scene/primitives/smooth.h"

/* Fills l->p with where the points of the ball of l->radius around c are below warp number `warp`
 * (0: none); they may be off by *off because the warps' numbers are floats. False: another warp is
 * on the way, or it is not smooth there. */
bool csg_taylor_warped(const csg_tape *tape, uint32_t warp, const double c[3], csg_smooth_leaf *l,
                       double *off);

/* The same of the ball's own points, placed by the frame as below. */
void csg_taylor_place_points(const double frame[12], const double c[3], csg_smooth_leaf *l);

/* l->p by an affine map: rows of a matrix, then what is added. */
void csg_taylor_placed(const double frame[12], csg_smooth_leaf *l);

#endif
