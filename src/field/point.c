/* SPDX-License-Identifier: MIT
 * See point.h.
 */
#include "field/point.h"

typedef struct batch {
    float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES];
} batch;

static batch batch_of(csg_vec3 at)
{
    batch b;
    for (int i = 0; i < CSG_LANES; i++) {
        b.x[i] = (float)at.x;
        b.y[i] = (float)at.y;
        b.z[i] = (float)at.z;
    }
    return b;
}

double csg_tape_value_at(const csg_kernel *kernel, const csg_tape *tape, csg_vec3 at,
                         float *scratch, size_t scratch_floats)
{
    batch b = batch_of(at);
    float f[CSG_LANES];
    kernel->values(tape, b.x, b.y, b.z, 1, f, scratch, scratch_floats);
    return (double)f[0];
}

csg_vec3 csg_tape_gradient_at(const csg_kernel *kernel, const csg_tape *tape, csg_vec3 at,
                              float *scratch, size_t scratch_floats)
{
    batch b = batch_of(at);
    float g[3][CSG_LANES];
    kernel->gradients(tape, b.x, b.y, b.z, 1, g[0], g[1], g[2], scratch, scratch_floats);
    return csg_vec3_make((double)g[0][0], (double)g[1][0], (double)g[2][0]);
}
