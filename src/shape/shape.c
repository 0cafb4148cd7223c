/* SPDX-License-Identifier: MIT
 * What all shapes share: counting references, and the way to each kind's own functions.
 */
#include "shape/shape.h"

#include <string.h>

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

static bool is_same(const float *a, const float *b)
{
    return memcmp(a, b, sizeof *a) == 0; /* two zeros are not */
}

/* Vector code fills its lanes with copies of the first point, and most batches are of one point:
 * how many come before the copies. */
static size_t count_distinct(const float *x, const float *y, const float *z, size_t count)
{
    while (count > 1 && is_same(&x[count - 1], x) && is_same(&y[count - 1], y) &&
           is_same(&z[count - 1], z))
        count--;
    return count;
}

static void copy_first(float *array, size_t from, size_t count)
{
    for (size_t i = from; i < count; i++)
        array[i] = array[0];
}

void csg_shape_values(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                      const csg_shape_near *near, const float *x, const float *y, const float *z,
                      size_t count, float *out)
{
    size_t distinct = count_distinct(x, y, z, count);
    shape->operations->values(shape, kernel, near, x, y, z, distinct, out);
    copy_first(out, distinct, count);
}

void csg_shape_gradients(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                         const csg_shape_near *near, const float *x, const float *y, const float *z,
                         size_t count, float *out, float *gx, float *gy, float *gz)
{
    size_t distinct = count_distinct(x, y, z, count);
    shape->operations->gradients(shape, kernel, near, x, y, z, distinct, out, gx, gy, gz);
    copy_first(out, distinct, count);
    copy_first(gx, distinct, count);
    copy_first(gy, distinct, count);
    copy_first(gz, distinct, count);
}

uint32_t csg_shape_narrow(const csg_shape *shape, const csg_shape_near *among,
                          const csg_shape_cell *cell, uint32_t *items)
{
    return shape->operations->narrow(shape, among, cell, items);
}

csg_beside csg_shape_beside(const csg_shape *shape, const csg_vec3 triangle[3], double turn,
                            double at[3])
{
    if (!shape->operations->beside)
        return CSG_BESIDE_UNKNOWN;
    return shape->operations->beside(shape, triangle, turn, at);
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

void csg_shape_creases(const csg_shape *shape, const csg_shape_crease *crease,
                       csg_shape_balls *balls)
{
    memset(balls->may_crease, false, sizeof balls->may_crease);
    shape->operations->creases(shape, crease, balls);
}
