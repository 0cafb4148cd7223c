/* SPDX-License-Identifier: MIT
 * See triangle.h.
 */
#include "mesh/remesh/triangle.h"

/* ---- shape ------------------------------------------------------------------------------------
 */

double csg_triangle_longest_side(const csg_vec3 v[3])
{
    return fmax(
        csg_vec3_norm(csg_vec3_sub(v[1], v[0])),
        fmax(csg_vec3_norm(csg_vec3_sub(v[2], v[1])), csg_vec3_norm(csg_vec3_sub(v[0], v[2]))));
}

double csg_triangle_quality(csg_vec3 a, csg_vec3 b, csg_vec3 c)
{
    csg_vec3 s[3] = {csg_vec3_sub(b, a), csg_vec3_sub(c, b), csg_vec3_sub(a, c)};
    double longest =
        fmax(csg_vec3_dot(s[0], s[0]), fmax(csg_vec3_dot(s[1], s[1]), csg_vec3_dot(s[2], s[2])));
    return longest > 0 ? csg_vec3_norm(csg_vec3_cross(s[0], s[1])) / longest : 0;
}

double csg_triangle_least_sine(const csg_vec3 v[3])
{
    double a = csg_vec3_norm(csg_vec3_sub(v[1], v[0])), b = csg_vec3_norm(csg_vec3_sub(v[2], v[1]));
    double c = csg_vec3_norm(csg_vec3_sub(v[0], v[2]));
    double shortest = fmin(a, fmin(b, c)),
           others = a * b * c; /* over the shortest: of the others */
    if (!(shortest > 0))
        return 0;
    return csg_vec3_norm(csg_triangle_cross(v[0], v[1], v[2])) * shortest / others;
}

double csg_worst_sine(const csg_vec3 (*triangles)[3], uint32_t count)
{
    double worst = 1;
    for (uint32_t i = 0; i < count; i++)
        worst = fmin(worst, csg_triangle_least_sine(triangles[i]));
    return worst;
}

uint32_t csg_triangle_facing(csg_vec3 n)
{
    static const double LEAST_COS = 0.05;
    const double along[13] = {n.x,
                              n.y,
                              n.z,
                              n.x + n.y,
                              n.x - n.y,
                              n.y + n.z,
                              n.y - n.z,
                              n.z + n.x,
                              n.z - n.x,
                              n.x + n.y + n.z,
                              n.x + n.y - n.z,
                              n.x - n.y + n.z,
                              n.y + n.z - n.x};
    double least = LEAST_COS * csg_vec3_norm(n);
    const double leasts[3] = {least, least * sqrt(2),
                              least * sqrt(3)}; /* by the directions' lengths */
    uint32_t facing = 0;
    for (int i = 0; i < 13; i++) {
        double most = leasts[i < 3 ? 0 : i < 9 ? 1 : 2];
        facing |= (uint32_t)(along[i] > most) << (2 * i);
        facing |= (uint32_t)(along[i] < -most) << (2 * i + 1);
    }
    return facing;
}

/* ---- the nearest place -------------------------------------------------------------------------
 */

static double along(csg_vec3 from, csg_vec3 to, csg_vec3 p)
{
    csg_vec3 way = csg_vec3_sub(to, from);
    double square = csg_vec3_dot(way, way);
    double t = square > 0 ? csg_vec3_dot(csg_vec3_sub(p, from), way) / square : 0;
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* The nearest place of the three sides. */
static double nearest_on_sides(const csg_vec3 v[3], csg_vec3 p, double weights[3])
{
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
        int next = k == 2 ? 0 : k + 1;
        double t = along(v[k], v[next], p);
        csg_vec3 foot = csg_vec3_add(csg_vec3_scale(v[k], 1 - t), csg_vec3_scale(v[next], t));
        csg_vec3 off = csg_vec3_sub(p, foot);
        double square = csg_vec3_dot(off, off);
        if (square < least) {
            least = square;
            weights[0] = weights[1] = weights[2] = 0;
            weights[k] = 1 - t;
            weights[next] = t;
        }
    }
    return least;
}

double csg_triangle_nearest(const csg_vec3 v[3], csg_vec3 p, double weights[3])
{
    csg_vec3 normal = csg_triangle_cross(v[0], v[1], v[2]);
    double square = csg_vec3_dot(normal, normal);
    if (square > 0) {
        for (int k = 0; k < 3; k++)
            weights[k] =
                csg_vec3_dot(normal, csg_triangle_cross(p, v[(k + 1) % 3], v[(k + 2) % 3])) /
                square;
        if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0) {
            double height = csg_vec3_dot(normal, csg_vec3_sub(p, v[0]));
            return height * height / square;
        }
    }
    return nearest_on_sides(v, p, weights);
}
