/* SPDX-License-Identifier: MIT
 * The frame in which a polyhedron is kept: its box fills [-1, 1] and every coordinate is a multiple
 * of 2^-39. So differences of coordinates are exact in double, and the signs of 2 x 2 and 3 x 3
 * determinants are exact in integers of 128 bits: 2^40 cubed, three times, stays below 2^123.
 */
#ifndef CSG_SHAPE_FRAME_H
#define CSG_SHAPE_FRAME_H

#include <stdint.h>

#include "base/geometry.h"
#include "base/int128.h"

typedef struct csg_triangle_frame {
    csg_vec3 center;
    double scale, unscale; /* powers of two */
} csg_triangle_frame;

/* Frame units to steps of the lattice. */
#define CSG_FRAME_STEPS 0x1p39

/* False: the box is too large or too small for a frame (sides above 1e150 or all below 1e-150). */
bool csg_triangle_frame_make(csg_box box, csg_triangle_frame *out);

static inline csg_vec3 csg_triangle_frame_enter(const csg_triangle_frame *frame, csg_vec3 p)
{
    return csg_vec3_scale(csg_vec3_sub(p, frame->center), frame->scale);
}
static inline csg_vec3 csg_triangle_frame_leave(const csg_triangle_frame *frame, csg_vec3 p)
{
    return csg_vec3_add(csg_vec3_scale(p, frame->unscale), frame->center);
}

/* To the nearest lattice point, for |x| < 2^12: the sum's last bit is worth a step. */
static inline double csg_triangle_frame_round(double x)
{
    return (x + 0x1.8p13) - 0x1.8p13;
}

/* The same for a point. */
static inline csg_vec3 csg_triangle_frame_round_point(csg_vec3 p)
{
    return csg_vec3_make(csg_triangle_frame_round(p.x), csg_triangle_frame_round(p.y),
                         csg_triangle_frame_round(p.z));
}

/* Of a coordinate on the lattice. */
static inline int64_t csg_triangle_frame_steps(double x)
{
    return (int64_t)(x * CSG_FRAME_STEPS);
}

#endif
