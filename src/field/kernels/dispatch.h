/* SPDX-License-Identifier: MIT
 * Which build of the kernels this processor runs. All builds give the same bits.
 */
#ifndef CSG_FIELD_DISPATCH_H
#define CSG_FIELD_DISPATCH_H

#include "field/kernels/kernel.h"

/* `wanted` where this build and processor have it, else (and for AUTO) the widest they have. */
csgm_isa csg_cpu_best_isa(csgm_isa wanted);
/* isa as csg_cpu_best_isa returned it. */
const csg_kernel *csg_kernel_for(csgm_isa isa);
const char *csg_isa_name(csgm_isa isa); /* "avx2"; static storage */

#endif
