/* SPDX-License-Identifier: MIT
 * Which segments are looked for in a field, and how closely: walls run inside the solid, gaps
 * outside.
 */
#ifndef CSG_WALLS_SIDE_H
#define CSG_WALLS_SIDE_H

#include "measure/walk.h"
#include "walls/normals.h"

/* One worker's. */
typedef struct csg_wall_side {
    const csg_measure_walk *walk;
    csg_measure_worker *worker;
    double turn; /* 1: gaps, between what is inside; -1: walls, between what is outside */
    csg_wall_angles angles;
    double tolerance;    /* a length */
    double finest;       /* shorter segments are looked for only where normals are known closely */
    bool *out_of_memory; /* set where that is why something was not found */
} csg_wall_side;

#endif
