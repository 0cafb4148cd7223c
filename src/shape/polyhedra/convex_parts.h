/* SPDX-License-Identifier: MIT
 * A solid bounded by triangles -> convex parts whose union it is.
 */
#ifndef CSG_SHAPE_CONVEX_PARTS_H
#define CSG_SHAPE_CONVEX_PARTS_H

#include "shape/polyhedra/triangles.h"

typedef struct csg_convex_parts {
    csg_memory *memory;
    csg_vec3 *points; /* the corners of all parts, one part after the other */
    size_t *ends;     /* per part: where it ends in points */
    size_t point_count, point_capacity, count, capacity;
} csg_convex_parts;

void csg_convex_parts_init(csg_convex_parts *parts, csg_memory *memory);
void csg_convex_parts_release(csg_convex_parts *parts);
/* A part more, with these corners. False: out of memory. */
bool csg_convex_parts_add(csg_convex_parts *parts, const csg_vec3 *points, size_t count);

/* Appends the parts of a closed chain of outward triangles. What is nearer than `slack` counts as
 * one. CSGM_ERR_LIMIT: there are more than `most`, or it would take more than some seconds. */
csgm_status csg_convex_parts_find(const csg_triangles *solid, double slack, size_t most,
                                  csg_convex_parts *parts);

#endif
