/* SPDX-License-Identifier: MIT
 * Features whose triangles meet others in more than what they share become smooth again, one after
 * another, until none do: smooth ones alone never meet (marching/tables.c).
 *
 * Blocks are tested in parallel and mended one after another. A round looks again only where
 * something has changed since the round before.
 */
#ifndef CSG_MESH_FEATURES_CROSS_H
#define CSG_MESH_FEATURES_CROSS_H

#include "mesh/features/near.h"

typedef struct csg_feature_cross {
    csg_near near;
    csg_near_room *rooms; /* one per worker, the caller's */
    uint32_t room_count;
    struct csg_cross_state *states; /* one a feature */
    uint8_t *triangles;             /* of all features, in the last round */
    size_t *starts;                 /* of each block in these, and the end of the last */
    uint8_t *blocks;                /* what is known of each: a test changes its block's alone */
    uint32_t search;                /* number of the one that mends */
    bool has_changed;               /* something, in that */
} csg_feature_cross;

/* near is set but for its boxes, and so are the rooms. False: out of memory; to be ended all the
 * same. */
bool csg_feature_cross_begin(csg_feature_cross *cross);
void csg_feature_cross_end(csg_feature_cross *cross);

/* A round, once flips are done: the first for all blocks, any thread; then the second, one thread;
 * then the third for all blocks, any thread, and the fourth; then the last, one thread: how many
 * features have changed, whose flips are to be done again. False: out of memory. */
void csg_feature_cross_look(csg_feature_cross *cross, size_t block);
void csg_feature_cross_wake(csg_feature_cross *cross);
void csg_feature_cross_measure(csg_feature_cross *cross, size_t block);
/* Whether it is to be tested in this round: others need not. */
bool csg_feature_cross_is_awake(const csg_feature_cross *cross, size_t block);
bool csg_feature_cross_test(csg_feature_cross *cross, uint32_t worker, size_t block);
bool csg_feature_cross_mend(csg_feature_cross *cross, size_t *changed);

#endif
