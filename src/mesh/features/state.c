/* SPDX-License-Identifier: MIT
 * The transitions between the states of a feature; README.md says who makes them, and why.
 */
#include <assert.h>

#include "mesh/features/features.h"

enum {
    UNSOLVED = 1 << CSG_FEATURE_UNSOLVED,
    FOLDED = 1 << CSG_FEATURE_FOLDED,
    SOLVED = 1 << CSG_FEATURE_SOLVED,
    BARE = 1 << CSG_FEATURE_BARE,
    GIVEN_UP = 1 << CSG_FEATURE_GIVEN_UP
};

bool csg_feature_may_enter(csg_feature_state from, csg_feature_state to)
{
    static const uint8_t follows[] = {
        [CSG_FEATURE_NEW] = UNSOLVED | FOLDED | SOLVED | BARE | GIVEN_UP,
        [CSG_FEATURE_UNSOLVED] = FOLDED | SOLVED | GIVEN_UP,
        [CSG_FEATURE_FOLDED] = FOLDED | SOLVED | GIVEN_UP,
        [CSG_FEATURE_SOLVED] = FOLDED | SOLVED | GIVEN_UP,
        [CSG_FEATURE_BARE] = 0,
        [CSG_FEATURE_GIVEN_UP] = 0,
    };
    return follows[from] >> to & 1;
}

void csg_feature_enter(csg_feature *f, csg_feature_state state)
{
    assert(csg_feature_may_enter(f->state, state));
    f->state = (uint8_t)state;
}
