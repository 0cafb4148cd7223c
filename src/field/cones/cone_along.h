/* SPDX-License-Identifier: MIT
 * How a field climbs along one direction, through operators of every kind; see cone.h.
 */
#ifndef CSG_FIELD_CONE_ALONG_H
#define CSG_FIELD_CONE_ALONG_H

#include "field/cones/cone.h"

/* The leaves' gradients in the ball, in the order of the tape. */
typedef struct csg_cone_leaves {
    csg_cone_balls balls;
    uint32_t first[CSG_CONE_MOST + 1]; /* of each leaf's balls */
    double corner[CSG_CONE_MOST];      /* of each leaf: csg_cone_balls.corner */
    uint32_t count;                    /* leaves */
} csg_cone_leaves;

/* Least and largest v . grad f, and the largest |grad f|. low, high: the nodes' values over the
 * ball, CSG_OCTANTS of them each, all alike, as csg_kernel.intervals gives them. False: an operator
 * without a bound, or too deep a tape. */
bool csg_cone_along(const csg_tape *tape, const csg_cone_leaves *leaves, const float *low,
                    const float *high, const double axis[3], double *least, double *most,
                    bool *has_edges);

/* The balls without those of operands that combine nodes hardly heed, as where a radius varies that
 * of the radius, and of two solids the one that is far below: all along which the others climb may
 * be a direction that these fall along. False: all are heeded, or none is. */
bool csg_cone_lighten(const csg_tape *tape, const csg_cone_leaves *leaves, const float *low,
                      const float *high, csg_cone_balls *heavy);

#endif
