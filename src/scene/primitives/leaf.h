/* SPDX-License-Identifier: MIT
 * A primitive on its way into the tape (field/compile/compile_leaf.h): its place and its own
 * parameters in float formulas. The primitives' own files pack the latter.
 */
#ifndef CSG_SCENE_LEAF_H
#define CSG_SCENE_LEAF_H

#include <stdint.h>

#include "base/geometry.h"

/* Where a leaf's own frame is: q = p - t, or q = m p + t. */
typedef enum csg_leaf_frame { CSG_FRAME_OFFSET, CSG_FRAME_AFFINE } csg_leaf_frame;

enum { CSG_LEAF_MOST_OWN = 19 };

typedef struct csg_leaf {
    uint8_t op; /* csg_op */
    csg_leaf_frame frame;
    double sigma, raise;
    csg_affine to_own; /* field frame -> own frame; OFFSET: q = p - offset */
    csg_vec3 offset;
    double own[CSG_LEAF_MOST_OWN];
    int own_count;
    double magnitude;     /* largest length that takes part in its arithmetic */
    double own_magnitude; /* and of those, in its own frame */
} csg_leaf;

#endif
