/* SPDX-License-Identifier: MIT
 * The geometry of one triangle: its normal, its shape, its place nearest to a point.
 */
#ifndef CSG_MESH_REMESH_TRIANGLE_H
#define CSG_MESH_REMESH_TRIANGLE_H

#include "base/geometry.h"

/* Twice the area times the normal. */
static inline csg_vec3 csg_triangle_cross(csg_vec3 a, csg_vec3 b, csg_vec3 c)
{
    return csg_vec3_cross(csg_vec3_sub(b, a), csg_vec3_sub(c, a));
}

/* Twenty-six directions as bits: those along which a triangle with this normal, of any length,
 * faces, by three degrees and more. None of one without an area. */
enum { CSG_FACING_ALL = (1 << 26) - 1 };
uint32_t csg_triangle_facing(csg_vec3 normal);

double csg_triangle_longest_side(const csg_vec3 triangle[3]);
/* Smallest altitude over longest side: 0.866 at best, 0 for a sliver. */
double csg_triangle_quality(csg_vec3 a, csg_vec3 b, csg_vec3 c);
/* Sine of the smallest angle. */
double csg_triangle_least_sine(const csg_vec3 triangle[3]);
/* The least of all. */
double csg_worst_sine(const csg_vec3 (*triangles)[3], uint32_t count);

/* The place nearest to p, as weights of the corners; returns the squared distance. */
double csg_triangle_nearest(const csg_vec3 triangle[3], csg_vec3 p, double weights[3]);

#endif
