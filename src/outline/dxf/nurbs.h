/* SPDX-License-Identifier: MIT
 * Rational B-splines in the plane -> points.
 */
#ifndef CSG_OUTLINE_NURBS_H
#define CSG_OUTLINE_NURBS_H

#include "outline/input.h"

enum { CSG_NURBS_MOST_DEGREE = 15 };

typedef struct csg_nurbs {
    int degree;
    const double *knots; /* point_count + degree + 1, never falling */
    size_t point_count;
    const csg_vec2 *points;
    const double *weights; /* > 0; NULL = all 1 */
} csg_nurbs;

/* Counts, degree, order of knots and weights are as they must be. */
bool csg_nurbs_is_valid(const csg_nurbs *curve);
/* The pen follows the curve from its first point on, within about `tolerance`. */
bool csg_nurbs_draw(const csg_nurbs *curve, csg_outline *pen, double tolerance);

#endif
