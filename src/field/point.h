/* SPDX-License-Identifier: MIT
 * A tape at one point, for what goes from one point to the next: a batch is filled with it. Where
 * several points are known at once, ask the kernel for all of them.
 */
#ifndef CSG_FIELD_POINT_H
#define CSG_FIELD_POINT_H

#include "field/kernels/kernel.h"

/* In the tape's frame; scratch as for the kernel's own functions. */
double csg_tape_value_at(const csg_kernel *kernel, const csg_tape *tape, csg_vec3 at,
                         float *scratch, size_t scratch_floats);
csg_vec3 csg_tape_gradient_at(const csg_kernel *kernel, const csg_tape *tape, csg_vec3 at,
                              float *scratch, size_t scratch_floats);

#endif
