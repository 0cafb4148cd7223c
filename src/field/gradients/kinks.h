/* SPDX-License-Identifier: MIT
 * Where a formula has kinks.
 */
#ifndef CSG_FIELD_KINKS_H
#define CSG_FIELD_KINKS_H

#include "field/gradients/bend_formula.h"
#include "field/kernels/kernel.h"

/* What is zero at a kink of a formula, which is alone on its tape, at `count` points; x, y, z, out
 * and room have room for whole vectors. */
void csg_kink_values(const csg_kernel *kernel, const csg_tape *leaf, const csg_kink *kink,
                     const float *x, const float *y, const float *z, size_t count, float *out,
                     float *room, float *scratch, size_t scratch_floats);

#endif
