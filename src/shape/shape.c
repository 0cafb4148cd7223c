/* SPDX-License-Identifier: MIT
 * What all shapes share: counting references, and the way to each kind's own functions.
 */
#include "shape/shape.h"

void csg_shape_retain(csg_shape *shape)
{
    atomic_fetch_add(&shape->references, 1);
}

void csg_shape_release(csg_shape *shape)
{
    if (shape && atomic_fetch_sub(&shape->references, 1) == 1)
        shape->operations->destroy(shape);
}

double csg_shape_sample(const csg_shape *shape, csg_vec3 p, csg_vec3 *gradient)
{
    return shape->operations->sample(shape, p, gradient);
}

void csg_shape_values(const csg_shape *shape, const float *x, const float *y, const float *z,
                      size_t count, float *out)
{
    shape->operations->values(shape, x, y, z, count, out);
}

void csg_shape_gradients(const csg_shape *shape, const float *x, const float *y, const float *z,
                         size_t count, float *out, float *gx, float *gy, float *gz)
{
    shape->operations->gradients(shape, x, y, z, count, out, gx, gy, gz);
}

uint64_t csg_shape_hash(const csg_shape *shape)
{
    return shape->operations->hash(shape);
}
