/* SPDX-License-Identifier: MIT
 * Whether all of a flat piece is inside of the surface a step to one side of it, and outside a step
 * to the other, from values at some places: those between are as the values at the corners of a
 * small triangle around them say, but for what gradients can stray by over it (slopes.h). The piece
 * is cut in four, and in four again, where that says too little and nowhere else: on the side of
 * the surface, and where it is nearest to that.
 */
#ifndef CSG_MESH_DISTANCE_STEPS_H
#define CSG_MESH_DISTANCE_STEPS_H

#include "base/geometry.h"
#include "mesh/distance/touching.h"

enum { CSG_STEPS_MOST_CUTS = 16 /* of a side: gradients may stray so much more than a value is */ };

typedef struct csg_steps {
    csg_vec3 at[3], step; /* inwards */
    double stray;         /* gradients' over the piece, times its radius */
    double kink, sag;     /* csg_gradients' */
    double excess;        /* out, where it fails: by what factor they stray too much, or INFINITY */
    bool fails;           /* out */
} csg_steps;

/* What a value between the corners can be off by, of a piece whose sides are cut so often. */
static inline double csg_steps_off(const csg_steps *piece, double cuts)
{
    double off = piece->kink / cuts + piece->sag / (cuts * cuts);
    return off < piece->stray / cuts ? off : piece->stray / cuts;
}

/* Up to CSG_OCTANTS pieces for which one tape holds, and what stands for it, of which their
 * gradients are: a walk over it costs the same for sixteen
 * places as for six. slack: rounding of values. scratch: as the kernel needs it. */
void csg_steps_settle(const csg_kernel *kernel, const csg_touching *field, double slack,
                      float *scratch, size_t scratch_floats, csg_steps *pieces, size_t count);

#endif
