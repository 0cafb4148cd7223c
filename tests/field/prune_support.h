/* SPDX-License-Identifier: MIT
 * Cells of a scene, pruned again and again, and what must hold in each: what test_prune.c and
 * test_rules.c share.
 */
#ifndef TEST_PRUNE_SUPPORT_H
#define TEST_PRUNE_SUPPORT_H

#include "field/field_support.h"
#include "field/prune/prune.h"

typedef struct cube {
    csg_vec3 center; /* field frame */
    double half;
} cube;

/* Everything one scene needs. */
typedef struct walk {
    test_subject subject;
    const csg_kernel *kernel;
    csg_pruner pruner;
    csg_arena arena;
    double rounding; /* as the octree chooses it */
    uint64_t cells, outside, inside, shortened, in_band;
} walk;

/* After the subject is compiled; end also ends the subject. */
void walk_begin(walk *w, double extent);
void walk_end(walk *w);

cube child_of(cube parent, int octant);
void prune_children(walk *w, const csg_tape *tape, cube parent);
/* Same bits in the band, same sign outside; keeps only the band's results for the comparison. */
size_t keep_band(test_results *full, test_results *other, size_t count, double tau,
                 const char *what);
/* Down from `at` to smaller and smaller cells on the surface; the tape is shortened again at each
 * level. */
void descend(walk *w, csg_random *random, cube at, double tau, const char *what);

#endif
