/* SPDX-License-Identifier: MIT
 * Sums over a solid by cubes, round by round. A cube is divided while it leaves more open than a
 * share that is the same for all of them, which costs the fewest cubes; where the sum is too much
 * still, the share is made smaller and the frontier's cubes are walked again. Each round is proven
 * by itself, and each cube of the frontier keeps its latest. Of cubes that are images of each other
 * one is looked at.
 */
#ifndef CSG_MEASURE_ROUNDS_H
#define CSG_MEASURE_ROUNDS_H

#include "measure/walk.h"

/* Of all cubes that were looked at. */
typedef struct csg_rounds_counts {
    uint64_t cubes;   /* in all rounds */
    uint64_t longest; /* of the latest one: below one cube of the frontier, and the frontier's */
} csg_rounds_counts;

/* An account is what a cube comes to, of so many bytes. */
typedef struct csg_rounds_job {
    size_t account_bytes;
    double share; /* to begin with */
    void *user;
    /* Of a cube that is inside or outside. */
    void (*settle_plain)(const void *user, const csg_measure_cube *q, void *account);
    /* Of a cube of which nothing is known. */
    void (*leave_open)(const void *user, const csg_measure_cube *q, void *account);
    /* Of one that the surface may run through; it may turn out to be inside or outside. Returns
     * what it leaves open; INFINITY: more than any share. */
    double (*settle)(const void *user, const csg_measure_walk *walk, csg_measure_worker *worker,
                     csg_measure_cube *q, void *account);
    /* Of the image of a cube that comes to `from`. */
    void (*turn)(const csg_symmetry *by, const void *from, void *account);
    /* What is measured is the same after it; NULL: after all symmetries of the solid. */
    bool (*is_kept)(const void *user, const csg_symmetry *by);
    /* Of all octants, in their order. */
    void (*combine)(const void *user, const void *octants, void *account);
    /* After a round: the root's account. Returns the ratio of what is wanted to what is open, 1 or
     * more: it is enough. */
    double (*conclude)(void *user, const void *root, const csg_rounds_counts *counts);
} csg_rounds_job;

/* Until it is enough, two rounds in a row make it no better, or most_cubes have been looked at.
 * CSGM_OK, or why it was stopped (reported); the last call of `conclude` has what is known by then.
 * The same for any number of threads. */
csgm_status csg_measure_rounds(csg_measure_walk *walk, const csg_rounds_job *job,
                               uint64_t most_cubes);

#endif
