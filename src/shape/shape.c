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

/* Why combinations: let the nearest point to p be v, on an edge or corner, and p outside (inside it
 * is the same with the complement). The half-spaces behind the faces that meet in v have an
 * intersection H, and near v all of H is solid: its interior meets no face, and a way from there to
 * a face comes to it from behind. Were p - v no combination of the faces' outward normals, some w
 * in H would have w . (p - v) > 0 (Farkas), and v + e w would be nearer to p than v. Those faces
 * are as near to p as v is, so they are among the ones given. If H has no interior, some
 * combination of the normals is 0, and no direction climbs along all of them. */
bool csg_shape_normals(const csg_shape *shape, csg_vec3 c, double radius,
                       csg_shape_take_normal *take, void *user)
{
    return shape->operations->normals(shape, c, radius, take, user);
}
