/* SPDX-License-Identifier: MIT
 * Tangent planes of a field, and where two of them meet.
 */
#ifndef CSG_MESH_PLANE_H
#define CSG_MESH_PLANE_H

#include "base/geometry.h"

/* Where f would be 0 if it went on as it does at a point: g . x = d. */
typedef struct csg_plane {
    csg_vec3 g;
    double d;
} csg_plane;

/* Of a field with value f and gradient g at a point. */
static inline csg_plane csg_plane_of(csg_vec3 at, double f, csg_vec3 g)
{
    return (csg_plane){g, csg_vec3_dot(g, at) - f};
}

/* Moves x to the nearest point of the line in which two planes meet. False: the sine of their
 * angle, squared, is `least` or less. */
static inline bool csg_planes_meet_in_line(const csg_plane p[2], double least, csg_vec3 *x)
{
    double a = csg_vec3_dot(p[0].g, p[0].g), b = csg_vec3_dot(p[0].g, p[1].g);
    double c = csg_vec3_dot(p[1].g, p[1].g), determinant = a * c - b * b;
    double r0 = p[0].d - csg_vec3_dot(p[0].g, *x), r1 = p[1].d - csg_vec3_dot(p[1].g, *x);
    if (!(determinant > least * a * c))
        return false;
    double s = (c * r0 - b * r1) / determinant, t = (a * r1 - b * r0) / determinant;
    *x = csg_vec3_add(*x, csg_vec3_add(csg_vec3_scale(p[0].g, s), csg_vec3_scale(p[1].g, t)));
    return true;
}

#endif
