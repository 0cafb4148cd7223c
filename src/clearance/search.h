/* SPDX-License-Identifier: MIT
 * One pair of parts: how far apart, or a point in both. Branch and bound over pairs of cubes.
 */
#ifndef CSG_CLEARANCE_SEARCH_H
#define CSG_CLEARANCE_SEARCH_H

#include <math.h>

#include "clearance/motion.h"
#include "clearance/tree.h"
#include "csgmesh/clearance.h"

typedef struct csg_clear_task {
    const csg_clear_part *a, *b;
    double tolerance;
    double share;         /* of the gap, within which it need not be known either */
    double enough;        /* a gap of which no more need be known than that it is no less */
    double min_gap;       /* > 0: on which side of it the gap is matters */
    double enough_volume; /* likewise of what they have in common, that it is no more */
    uint64_t most_pairs;
    const csg_motion *motion; /* of b, from the pose before; NULL: nothing of it is to be known */
    double apart;             /* > 0: they are so far apart, and motion alone matters */
    uint32_t worker;
    csg_mesh_watch *watch;
} csg_clear_task;

/* How closely a gap of this size is to be known. */
static inline double csg_clear_room(const csg_clear_task *task, double gap)
{
    return fmax(task->tolerance, task->share * gap);
}

/* False: stopped, or out of memory (then *out_of_memory); *out is what is proven by then in any
 * case. Fills state, gap, nearest, inside, volume, size, pairs, and with a motion gap_between: not
 * more than the gap on the way, where they are apart at its end, else 0; no more than half of the
 * gap need be known of it. */
bool csg_clear_search(const csg_clear_task *task, csgm_clear_pair *out, bool *out_of_memory);

#endif
