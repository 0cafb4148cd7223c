/* SPDX-License-Identifier: MIT
 * See shapes.h. Memory that cannot be had ends the test.
 */
#include "diff/shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"

static void *take(uint64_t count, size_t size)
{
    void *memory = malloc((size_t)(count + 1) * size);
    if (!memory)
        abort();
    return memory;
}

static diff_shape make(uint64_t vertex_count, uint64_t triangle_count)
{
    return (diff_shape){take(3 * vertex_count, sizeof(float)),
                        take(3 * triangle_count, sizeof(uint32_t)), vertex_count, triangle_count};
}

static void set_vertex(diff_shape *shape, uint64_t vertex, double x, double y, double z)
{
    shape->positions[3 * vertex] = (float)x;
    shape->positions[3 * vertex + 1] = (float)y;
    shape->positions[3 * vertex + 2] = (float)z;
}

static uint32_t *put_triangle(uint32_t *at, uint32_t a, uint32_t b, uint32_t c)
{
    at[0] = a;
    at[1] = b;
    at[2] = c;
    return at + 3;
}

diff_shape diff_ball(uint32_t columns, uint32_t rows, double radius, csgm_vec3 center)
{
    const double pi = acos(-1);
    uint32_t rings = rows - 1, south = rings * columns, north = south + 1;
    diff_shape ball = make(north + 1, 2 * (uint64_t)columns * (rows - 1));
    for (uint32_t i = 0; i < south; i++) {
        double t = pi * (i / columns + 1) / rows, u = 2 * pi * (i % columns) / columns;
        set_vertex(&ball, i, center.x + radius * sin(t) * cos(u),
                   center.y + radius * sin(t) * sin(u), center.z - radius * cos(t));
    }
    set_vertex(&ball, south, center.x, center.y, center.z - radius);
    set_vertex(&ball, north, center.x, center.y, center.z + radius);
    uint32_t *at = ball.indices;
    for (uint32_t j = 0; j < columns; j++) {
        uint32_t k = (j + 1) % columns, top = (rings - 1) * columns;
        at = put_triangle(at, south, k, j);
        at = put_triangle(at, north, top + j, top + k);
        for (uint32_t i = 0; i + 1 < rings; i++) {
            uint32_t low = i * columns, high = low + columns;
            at = put_triangle(at, low + j, low + k, high + k);
            at = put_triangle(at, low + j, high + k, high + j);
        }
    }
    return ball;
}

/* One face: corner and two edges whose cross product points outwards. */
static void put_face(diff_shape *box, uint64_t face, uint32_t n, const double *corner,
                     const double *right, const double *up)
{
    uint64_t base = face * (n + 1) * (n + 1);
    for (uint32_t i = 0; i <= n; i++)
        for (uint32_t j = 0; j <= n; j++) {
            double p[3], u = (double)j / n, v = (double)i / n;
            for (int k = 0; k < 3; k++)
                p[k] = corner[k] + u * right[k] + v * up[k];
            set_vertex(box, base + i * (n + 1) + j, p[0], p[1], p[2]);
        }
    uint32_t *at = box->indices + 6 * face * n * n;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = 0; j < n; j++) {
            uint32_t a = (uint32_t)base + i * (n + 1) + j, b = a + 1, c = a + n + 1, d = c + 1;
            at = put_triangle(at, a, b, d);
            at = put_triangle(at, a, d, c);
        }
}

diff_shape diff_box(csgm_vec3 low, csgm_vec3 high, uint32_t n)
{
    const double a[3] = {low.x, low.y, low.z},
                 size[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
    diff_shape box = make(6 * (uint64_t)(n + 1) * (n + 1), 12 * (uint64_t)n * n);
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            double corner[3] = {a[0], a[1], a[2]}, right[3] = {0}, up[3] = {0};
            int first = (axis + 1) % 3, second = (axis + 2) % 3;
            corner[axis] += side ? size[axis] : 0;
            right[side ? first : second] = size[side ? first : second];
            up[side ? second : first] = size[side ? second : first];
            put_face(&box, (uint64_t)(2 * axis + side), n, corner, right, up);
        }
    return box;
}

void diff_shape_append(diff_shape *to, const diff_shape *more)
{
    diff_shape sum =
        make(to->vertex_count + more->vertex_count, to->triangle_count + more->triangle_count);
    memcpy(sum.positions, to->positions, 3 * to->vertex_count * sizeof(float));
    memcpy(sum.positions + 3 * to->vertex_count, more->positions,
           3 * more->vertex_count * sizeof(float));
    memcpy(sum.indices, to->indices, 3 * to->triangle_count * sizeof(uint32_t));
    for (uint64_t i = 0; i < 3 * more->triangle_count; i++)
        sum.indices[3 * to->triangle_count + i] = more->indices[i] + (uint32_t)to->vertex_count;
    diff_shape_release(to);
    *to = sum;
}

void diff_shape_shuffle(diff_shape *shape, uint64_t seed)
{
    csg_random random = {seed};
    uint32_t count = (uint32_t)shape->vertex_count;
    uint32_t *place = take(count, sizeof *place);
    float *positions = take(3 * shape->vertex_count, sizeof *positions);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t j = csg_random_below(&random, i + 1);
        place[i] = place[j];
        place[j] = i;
    }
    for (uint32_t i = 0; i < count; i++)
        memcpy(positions + 3 * (size_t)place[i], shape->positions + 3 * (size_t)i, 12);
    for (uint64_t i = 0; i < 3 * shape->triangle_count; i++)
        shape->indices[i] = place[shape->indices[i]];
    for (uint32_t i = (uint32_t)shape->triangle_count; i-- > 1;) {
        uint32_t j = csg_random_below(&random, i + 1), turn = csg_random_below(&random, 3), t[3];
        memcpy(t, shape->indices + 3 * (size_t)i, sizeof t);
        memcpy(shape->indices + 3 * (size_t)i, shape->indices + 3 * (size_t)j, sizeof t);
        for (uint32_t k = 0; k < 3; k++)
            shape->indices[3 * (size_t)j + k] = t[(k + turn) % 3];
    }
    free(shape->positions);
    free(place);
    shape->positions = positions;
}

void diff_shape_loosen(diff_shape *shape)
{
    diff_shape loose = make(3 * shape->triangle_count, shape->triangle_count);
    for (uint64_t i = 0; i < 3 * shape->triangle_count; i++) {
        memcpy(loose.positions + 3 * i, shape->positions + 3 * (size_t)shape->indices[i], 12);
        loose.indices[i] = (uint32_t)i;
    }
    diff_shape_release(shape);
    *shape = loose;
}

void diff_shape_release(diff_shape *shape)
{
    free(shape->positions);
    free(shape->indices);
}

csgm_mesh_view diff_view(const diff_shape *shape)
{
    return (csgm_mesh_view){.positions = shape->positions,
                            .indices = shape->indices,
                            .vertex_count = shape->vertex_count,
                            .triangle_count = shape->triangle_count};
}
