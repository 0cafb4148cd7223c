/* SPDX-License-Identifier: MIT
 * Where two parts of a solid touch in a plane and are flush there, as the halves of a herringbone
 * gear are: f = max(min(a, z), min(b, -z)), with a = b in the plane z = 0. In that plane f is zero
 * within the solid as well, and where the surface goes through it gradients have no direction in
 * common, however small the region. But f has the sign of
 *
 *     h = a where z > 0, b where z < 0
 *
 * but in the plane itself: for z > 0 min(b, -z) is negative, and min(a, z) has the sign of a. So
 * {h > 0} is the solid with its seam closed, h is continuous since a = b in the plane, and |f| <=
 * |h|: what is inside, or outside, by f is so by h. The same, turned around, of
 * min(max(a, -z), max(b, z)), two cavities that touch.
 *
 * That a = b in the plane is read off the tape: both are the same nodes with the same numbers, and
 * the frames that their leaves have, or the outermost warps above these, take the plane to the same
 * places. No value is compared: rounding is all that the parts differ by.
 */
#ifndef CSG_MESH_DISTANCE_TOUCHING_H
#define CSG_MESH_DISTANCE_TOUCHING_H

#include "base/geometry.h"
#include "field/kernels/kernel.h"

typedef struct csg_touching {
    const csg_tape *tape; /* the field */
    bool is_there;        /* h stands for it; else there is none, and the field is what it is */
    csg_tape halves[2];   /* a and b */
    csg_vec3 slope;       /* of the plane's value: a where it is positive */
    double value;         /* that at the tape's origin */
    double doubt;         /* a and b differ by no more in the plane */
} csg_touching;

/* Without h. */
csg_touching csg_touching_none(const csg_tape *tape);
/* In the ball around c. */
csg_touching csg_touching_find(const csg_kernel *kernel, const csg_tape *tape, csg_vec3 c,
                               double radius);

/* How far a place is on a's side of the plane, times the slope. */
static inline double csg_touching_side(const csg_touching *t, csg_vec3 at)
{
    return t->value + csg_vec3_dot(t->slope, at);
}

/* h, or the field, by the rules of csg_kernel's functions of these names. */
void csg_touching_values(const csg_touching *t, const csg_kernel *kernel, const float *x,
                         const float *y, const float *z, size_t count, float *out, float *scratch,
                         size_t scratch_floats);
void csg_touching_values_and_gradients(const csg_touching *t, const csg_kernel *kernel,
                                       const float *x, const float *y, const float *z, size_t count,
                                       float *out, float *gx, float *gy, float *gz, float *scratch,
                                       size_t scratch_floats);

#endif
