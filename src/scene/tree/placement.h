/* SPDX-License-Identifier: MIT
 * What a part is but for where it is: parts of two scenes that differ by a rigid motion only are
 * recognised, and the motion is found.
 */
#ifndef CSG_SCENE_PLACEMENT_H
#define CSG_SCENE_PLACEMENT_H

#include "scene/tree/parts.h"

typedef struct csg_placed_frame {
    csg_affine map; /* from the node's frame to the scene's */
    bool is_operator;
} csg_placed_frame;

/* The part's nodes in the order of the tree, without the transforms between them: as a digest of
 * their text, and as the frames that they stand in. */
typedef struct csg_placement {
    csg_memory *memory;
    csg_placed_frame *frames;
    size_t count, room;
    uint64_t digest[2];
    bool is_known; /* false: it has too many frames */
} csg_placement;

/* CSGM_OK or CSGM_ERR_MEMORY (not reported); release it in any case. What it held is replaced. */
csgm_status csg_placement_take(csg_placement *placement, const csg_parts *parts, size_t index);
void csg_placement_release(csg_placement *placement);

/* The rotation and translation that takes the part from one place to the other. False: it is not
 * known to be the same but for one. The image of a point p is off by CSG_MOTION_ROUNDING times
 * |p| + the reach of both at most. */
bool csg_placement_motion(const csg_placement *from, const csg_placement *to, csg_affine *motion);

/* Whether it is where it was, to the bit. */
bool csg_placement_is_same(const csg_placement *a, const csg_placement *b);

#define CSG_MOTION_ROUNDING 1e-10
/* The most that one of the frames' origins is away from the scene's. */
double csg_placement_reach(const csg_placement *placement);

#endif
