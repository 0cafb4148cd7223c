/* SPDX-License-Identifier: MIT
 * Polyhedra that a figure of the plane sweeps out: up, turning and growing on the way, or around z.
 */
#ifndef CSG_SOLID_SWEEPS_H
#define CSG_SOLID_SWEEPS_H

#include "solid/solid.h"

typedef struct csg_sweep {
    double height, twist, scale[2]; /* at the top; twist in degrees, clockwise going up */
    uint32_t slices;                /* 0: one without twist, else as many as smoothness needs */
    bool smooth;                    /* long edges are divided too, so that a twist looks round */
} csg_sweep;

csg_node_id csg_sweep_up(csg_solid_job *job, csg_node_id flat, const csg_sweep *sweep);
/* `outline` is clean, on one side of its y axis, which becomes z, and is released. */
csg_node_id csg_sweep_around(csg_solid_job *job, csg_outline *outline, double angle, double start,
                             uint32_t steps);

#endif
