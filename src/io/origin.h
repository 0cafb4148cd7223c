/* SPDX-License-Identifier: MIT
 * Where a mesh that is read has its origin, for floats around it to say where its vertices are.
 */
#ifndef CSG_IO_ORIGIN_H
#define CSG_IO_ORIGIN_H

#include <math.h>
#include <stdbool.h>

#include "csgmesh/csgmesh.h"

typedef struct csg_origin_choice {
    double low[3], high[3];
    bool is_exact; /* every position is a float */
} csg_origin_choice;

static inline csg_origin_choice csg_origin_begin(void)
{
    return (csg_origin_choice){
        {INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, true};
}

static inline void csg_origin_add(csg_origin_choice *choice, const double position[3])
{
    for (int k = 0; k < 3; k++) {
        choice->is_exact &= (double)(float)position[k] == position[k];
        choice->low[k] = fmin(choice->low[k], position[k]);
        choice->high[k] = fmax(choice->high[k], position[k]);
    }
}

/* Zero when every position is a float already, or when the mesh is at least 1/16 as large as it is
 * far away: rounding then costs less than a millionth of its size. */
static inline csgm_vec3 csg_origin_choose(const csg_origin_choice *choice)
{
    double size = 0, distance = 0, center[3];
    for (int k = 0; k < 3; k++) {
        center[k] = (double)(float)(choice->low[k] / 2 + choice->high[k] / 2);
        size = fmax(size, choice->high[k] - choice->low[k]);
        distance = fmax(distance, fabs(center[k]));
    }
    if (choice->is_exact || !(distance > 16 * size))
        return (csgm_vec3){0, 0, 0};
    return (csgm_vec3){center[0], center[1], center[2]};
}

/* Beyond this a coordinate is refused, so that differences of two are floats still. */
static inline bool csg_origin_is_near(double coordinate)
{
    const double FARTHEST = 1e38;
    return fabs(coordinate) <= FARTHEST;
}

#endif
