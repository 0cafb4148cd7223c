/* SPDX-License-Identifier: MIT
 * Points into a leaf's own frame and gradients back, for the kernels (csg_leaf_frame).
 */
#ifndef CSG_FIELD_FRAMES_H
#define CSG_FIELD_FRAMES_H

#include "scene/primitives/point.h"

static inline point offset_frame(const float *t, float x, float y, float z)
{
    return (point){x - t[0], y - t[1], z - t[2]};
}

static inline point affine_frame(const float *m, float x, float y, float z)
{
    return (point){m[0] * x + m[1] * y + m[2] * z + m[9], m[3] * x + m[4] * y + m[5] * z + m[10],
                   m[6] * x + m[7] * y + m[8] * z + m[11]};
}

/* transpose(m) g */
static inline point affine_back(const float *m, point g)
{
    return (point){m[0] * g.x + m[3] * g.y + m[6] * g.z, m[1] * g.x + m[4] * g.y + m[7] * g.z,
                   m[2] * g.x + m[5] * g.y + m[8] * g.z};
}

#endif
