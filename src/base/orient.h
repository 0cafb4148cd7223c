/* SPDX-License-Identifier: MIT
 * Which way points turn: signs of determinants of coordinates, right to the last bit. In double
 * where its error cannot change the sign, else by sums that lose nothing (Shewchuk, Adaptive
 * Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997).
 *
 * shape/polyhedra asks the same of points on a lattice that are thought to be moved off every edge;
 * there integers of 128 bits are exact and shorter (tree_winding.c).
 */
#ifndef CSG_BASE_ORIENT_H
#define CSG_BASE_ORIENT_H

#include <math.h>

#include "base/geometry.h"

/* 1: a, b, c turn counter-clockwise, -1: clockwise, 0: they lie on a line. Exact wherever the
 * differences of the coordinates are, as they are on the grid of shape/plane/polygons.h. Rounding
 * is monotone, so products that differ once rounded are in that order; if not, their rounding
 * errors decide, which fma() gives. */
static inline int csg_orient_plane(csg_vec2 a, csg_vec2 b, csg_vec2 c)
{
    double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
    double left = ux * vy, right = uy * vx;
    if (left != right)
        return left > right ? 1 : -1;
    double left_rest = fma(ux, vy, -left), right_rest = fma(uy, vx, -right);
    return (left_rest > right_rest) - (left_rest < right_rest);
}

int csg_orient_along_exactly(const float a[3], const float b[3], const float c[3], int axis);
int csg_orient_space_exactly(const float a[3], const float b[3], const float c[3],
                             const float d[3]);

/* Which way (a, b, c) turns, seen along an axis; 0: on a line. */
static inline int csg_orient_along(const float a[3], const float b[3], const float c[3], int axis)
{
    const double error = 4.0 * 0x1p-53; /* Shewchuk's (3 + 16 e) e, e = 2^-53, and a little more */
    int i = axis == 2 ? 0 : axis + 1, j = i == 2 ? 0 : i + 1;
    double x = ((double)b[i] - (double)a[i]) * ((double)c[j] - (double)a[j]);
    double y = ((double)b[j] - (double)a[j]) * ((double)c[i] - (double)a[i]);
    double most = fabs(x) + fabs(y);
    if (fabs(x - y) > error * most)
        return (x > y) - (x < y);
    return most > 0 ? csg_orient_along_exactly(a, b, c, axis) : 0;
}

/* The sign of the volume of a tetrahedron: on which side of (a, b, c) d lies; 0: in its plane. */
static inline int csg_orient_space(const float a[3], const float b[3], const float c[3],
                                   const float d[3])
{
    const double error = 8.0 * 0x1p-53; /* Shewchuk's (7 + 56 e) e, and a little more */
    double u[3], v[3], w[3], volume = 0, most = 0;
    for (int i = 0; i < 3; i++) {
        u[i] = (double)b[i] - (double)a[i];
        v[i] = (double)c[i] - (double)a[i];
        w[i] = (double)d[i] - (double)a[i];
    }
    for (int i = 0; i < 3; i++) {
        int j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
        double x = v[j] * w[k], y = v[k] * w[j];
        volume += u[i] * (x - y);
        most += fabs(u[i]) * (fabs(x) + fabs(y));
    }
    if (fabs(volume) > error * most)
        return (volume > 0) - (volume < 0);
    return most > 0 ? csg_orient_space_exactly(a, b, c, d) : 0;
}

#endif
