/* SPDX-License-Identifier: MIT
 * The largest distance from one mesh to the other (a one-sided Hausdorff distance) between proven
 * bounds.
 */
#ifndef CSG_DIFF_MAXIMUM_H
#define CSG_DIFF_MAXIMUM_H

#include "diff/side.h"

/* Which points count: those that the other mesh does not hold, those that it does. */
typedef enum csg_diff_wanted {
    CSG_DIFF_ALL_POINTS,
    CSG_DIFF_POINTS_OUTSIDE,
    CSG_DIFF_POINTS_INSIDE
} csg_diff_wanted;

typedef struct csg_diff_maximum {
    int from; /* the side whose points are looked at */
    csg_diff_wanted wanted;
    double tolerance;  /* frame units: below it nothing needs to be known better */
    double floor;      /* the same, whatever the tolerance */
    bool verdict_only; /* stop when the maximum is known to be above the tolerance */
    /* Results in frame units, without slack. lower may begin above 0 with its place: a distance
     * that is known. */
    double lower, upper;
    csg_vec3 at;
    bool is_found; /* `at` is a place */
    bool is_refined;
    csg_box differing; /* holds every triangle that may be farther away than the precision */
} csg_diff_maximum;

/* Both sides have trees and distances of their points. */
csgm_status csg_diff_find_maximum(csg_diff_pair *pair, csg_diff_maximum *search);

#endif
