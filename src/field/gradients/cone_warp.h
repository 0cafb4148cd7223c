/* SPDX-License-Identifier: MIT
 * Balls on their way through warps, and gradients on their way back; see cone.h.
 */
#ifndef CSG_FIELD_CONE_WARP_H
#define CSG_FIELD_CONE_WARP_H

#include "field/tape.h"
#include "scene/primitives/cone_ball.h"

/* One warp: the derivative at the ball's centre, transposed, and how far it changes in the ball. */
typedef struct csg_cone_turn {
    double back[3][3];  /* gradient below the warp -> above it */
    double other[3][3]; /* the same beyond a kink, where is_kinked */
    double change[3];   /* of each column */
    double bend[3];     /* the same per length between any two points; INFINITY: not known */
    double norm;        /* of the derivative, at most */
    bool is_kinked;
} csg_cone_turn;

typedef struct csg_cone_way {
    csg_cone_turn turns[CSG_MOST_WARPS];
    uint32_t count;
} csg_cone_way;

/* Sends the ball through the warps down to number `warp`: what comes out contains its image. False:
 * the ball reaches where a warp is not regular. */
bool csg_cone_warp(const csg_tape *tape, uint32_t warp, double c[3], double *radius,
                   csg_cone_way *way);
/* Takes the balls of vectors from number `first` on back, those of the leaf added last, with their
 * bend. False: too many. */
bool csg_cone_unwarp(const csg_cone_way *way, csg_cone_balls *balls, uint32_t first);

/* A bound on the largest singular value of a matrix of 3 x 3, row by row. */
double csg_cone_norm(const float *m);

#endif
