/* SPDX-License-Identifier: MIT
 * Which way three points of the plane turn, right to the last bit.
 */
#ifndef CSG_SHAPE_TURN_H
#define CSG_SHAPE_TURN_H

#include "shape/plane/outline.h"

/* 1: a, b, c turn counter-clockwise, -1: clockwise, 0: they lie on a line. Exact wherever the
 * differences of the coordinates are, as they are on the grid of polygons.h. Rounding is monotone,
 * so products that differ once rounded are in that order; if not, their rounding errors decide,
 * which fma() gives. */
static inline int csg_turn(csg_vec2 a, csg_vec2 b, csg_vec2 c)
{
    double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
    double left = ux * vy, right = uy * vx;
    if (left != right)
        return left > right ? 1 : -1;
    double left_rest = fma(ux, vy, -left), right_rest = fma(uy, vx, -right);
    return (left_rest > right_rest) - (left_rest < right_rest);
}

#endif
