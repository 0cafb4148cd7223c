/* SPDX-License-Identifier: MIT
 * See solid_support.h.
 */
#include "shape/solid_support.h"

static uint32_t add_point(csg_triangles *t, double x, double y, double z)
{
    assert_true(csg_triangles_add_point(t, csg_vec3_make(x, y, z)));
    return (uint32_t)t->point_count - 1;
}

static void add_triangle(csg_triangles *t, uint32_t a, uint32_t b, uint32_t c)
{
    assert_true(csg_triangles_add(t, a, b, c));
}

void solid_add_box(csg_triangles *t, csg_vec3 low, csg_vec3 high, bool inwards)
{
    static const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    uint32_t first = (uint32_t)t->point_count;
    for (uint32_t i = 0; i < 8; i++)
        add_point(t, i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (int f = 0; f < 6; f++) {
        uint32_t corners[4];
        for (int k = 0; k < 4; k++)
            corners[k] = first + faces[f][inwards ? 3 - k : k];
        assert_true(csg_triangles_add_face(t, corners, 4));
    }
}

void solid_add_fine_box(csg_triangles *t, csg_vec3 low, csg_vec3 high, uint32_t n)
{
    csg_vec3 size = csg_vec3_sub(high, low);
    const double from[3] = {low.x, low.y, low.z}, length[3] = {size.x, size.y, size.z};
    for (int axis = 0; axis < 3; axis++) {
        for (int end = 0; end < 2; end++) {
            uint32_t first = (uint32_t)t->point_count;
            for (uint32_t i = 0; i <= n; i++)
                for (uint32_t j = 0; j <= n; j++) {
                    double at[3];
                    int u = (axis + 1) % 3, v = (axis + 2) % 3;
                    at[axis] = from[axis] + (end ? length[axis] : 0);
                    at[u] = from[u] + length[u] * i / n;
                    at[v] = from[v] + length[v] * j / n;
                    add_point(t, at[0], at[1], at[2]);
                }
            for (uint32_t i = 0; i < n; i++)
                for (uint32_t j = 0; j < n; j++) {
                    uint32_t a = first + i * (n + 1) + j, b = a + n + 1;
                    add_triangle(t, a, end ? b : b + 1, end ? b + 1 : b);
                    add_triangle(t, a, end ? b + 1 : a + 1, end ? a + 1 : b + 1);
                }
        }
    }
}

void solid_add_ball(csg_triangles *t, csg_vec3 center, double radius, uint32_t columns,
                    uint32_t rows, double bumps)
{
    uint32_t first = (uint32_t)t->point_count;
    for (uint32_t i = 1; i < rows; i++)
        for (uint32_t j = 0; j < columns; j++) {
            double polar = M_PI * i / rows, around = 2 * M_PI * j / columns;
            double r = radius * (1 + bumps * sin(5 * polar) * cos(3 * around));
            add_point(t, center.x + r * sin(polar) * cos(around),
                      center.y + r * sin(polar) * sin(around), center.z + r * cos(polar));
        }
    uint32_t top = add_point(t, center.x, center.y, center.z + radius);
    uint32_t bottom = add_point(t, center.x, center.y, center.z - radius);
    for (uint32_t j = 0; j < columns; j++) {
        uint32_t next = (j + 1) % columns, last = first + (rows - 2) * columns;
        add_triangle(t, top, first + j, first + next);
        add_triangle(t, bottom, last + next, last + j);
        for (uint32_t i = 0; i + 2 < rows; i++) {
            uint32_t a = first + i * columns + j, b = first + i * columns + next;
            add_triangle(t, a, a + columns, b + columns);
            add_triangle(t, a, b + columns, b);
        }
    }
}

void solid_add_copy(csg_triangles *t, const csg_triangles *from)
{
    uint32_t first = (uint32_t)t->point_count;
    for (size_t i = 0; i < from->point_count; i++)
        assert_true(csg_triangles_add_point(t, from->points[i]));
    for (size_t i = 0; i < from->count; i++)
        add_triangle(t, first + from->corners[i][0], first + from->corners[i][1],
                     first + from->corners[i][2]);
}

void solid_remove(csg_triangles *t, size_t triangle)
{
    t->count--;
    for (int k = 0; k < 3; k++)
        t->corners[triangle][k] = t->corners[t->count][k];
}

void solid_flip(csg_triangles *t, size_t triangle)
{
    uint32_t corner = t->corners[triangle][0];
    t->corners[triangle][0] = t->corners[triangle][1];
    t->corners[triangle][1] = corner;
}

double solid_volume(const csg_triangles *t)
{
    double sum = 0;
    for (size_t i = 0; i < t->count; i++)
        sum +=
            csg_vec3_dot(t->points[t->corners[i][0]],
                         csg_vec3_cross(t->points[t->corners[i][1]], t->points[t->corners[i][2]]));
    return sum / 6;
}

static csg_vec3 along(csg_vec3 a, csg_vec3 b, double t)
{
    return csg_vec3_add(a, csg_vec3_scale(csg_vec3_sub(b, a), t));
}

static csg_vec3 nearest_point(csg_vec3 a, csg_vec3 b, csg_vec3 c, csg_vec3 p)
{
    csg_vec3 ab = csg_vec3_sub(b, a), ac = csg_vec3_sub(c, a);
    csg_vec3 ap = csg_vec3_sub(p, a), bp = csg_vec3_sub(p, b), cp = csg_vec3_sub(p, c);
    double d1 = csg_vec3_dot(ab, ap), d2 = csg_vec3_dot(ac, ap), d3 = csg_vec3_dot(ab, bp),
           d4 = csg_vec3_dot(ac, bp), d5 = csg_vec3_dot(ab, cp), d6 = csg_vec3_dot(ac, cp);
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (d1 <= 0 && d2 <= 0)
        return a;
    if (d3 >= 0 && d4 <= d3)
        return b;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return along(a, b, d1 / (d1 - d3));
    if (d6 >= 0 && d5 <= d6)
        return c;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return along(a, c, d2 / (d2 - d6));
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return along(b, c, (d4 - d3) / (d4 - d3 + d5 - d6));
    double sum = va + vb + vc;
    return csg_vec3_add(along(a, b, vb / sum), csg_vec3_scale(ac, vc / sum));
}

double solid_distance(const csg_triangles *t, csg_vec3 p)
{
    double least = INFINITY;
    for (size_t i = 0; i < t->count; i++) {
        const uint32_t *k = t->corners[i];
        csg_vec3 q = nearest_point(t->points[k[0]], t->points[k[1]], t->points[k[2]], p);
        least = fmin(least, csg_vec3_norm(csg_vec3_sub(p, q)));
    }
    return least;
}

double solid_winding(const csg_triangles *t, csg_vec3 p)
{
    double sum = 0;
    for (size_t i = 0; i < t->count; i++) {
        csg_vec3 a = csg_vec3_sub(t->points[t->corners[i][0]], p),
                 b = csg_vec3_sub(t->points[t->corners[i][1]], p),
                 c = csg_vec3_sub(t->points[t->corners[i][2]], p);
        double x = csg_vec3_norm(a), y = csg_vec3_norm(b), z = csg_vec3_norm(c);
        double denominator =
            x * y * z + csg_vec3_dot(a, b) * z + csg_vec3_dot(b, c) * x + csg_vec3_dot(c, a) * y;
        sum += 2 * atan2(csg_vec3_dot(a, csg_vec3_cross(b, c)), denominator);
    }
    return sum / (4 * M_PI);
}

csg_vec3 solid_random_point(csg_random *random, double half)
{
    double x = csg_random_uniform(random, -half, half), y = csg_random_uniform(random, -half, half);
    return csg_vec3_make(x, y, csg_random_uniform(random, -half, half));
}
