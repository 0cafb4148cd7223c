/* SPDX-License-Identifier: MIT
 * Whether two triangles of a mesh meet, with the exact signs of determinants of their floats: in
 * double where that is certain, else by sums that lose nothing (Shewchuk, Adaptive Precision
 * Floating-Point Arithmetic and Fast Robust Geometric Predicates, 1997).
 */
#ifndef CSG_MESH_FEATURES_EXACT_H
#define CSG_MESH_FEATURES_EXACT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct csg_exact_triangle {
    float at[3][3];
    uint32_t vertex[3]; /* equal numbers: one vertex of the mesh */
} csg_exact_triangle;

/* Which way (a, b, c) turns, seen along an axis; 0: on a line. */
int csg_exact_turn(const float a[3], const float b[3], const float c[3], int axis);

/* Whether they have a point in common that is not of a vertex or an edge that they share. A
 * triangle without area meets those at its edges. */
bool csg_exact_meet(const csg_exact_triangle *s, const csg_exact_triangle *t);

/* Whether two that share no vertex come this near to each other: where coordinates are rounded to
 * decimals they might meet. In double, not exactly. */
bool csg_exact_nearly_meet(const csg_exact_triangle *s, const csg_exact_triangle *t, double reach);

#endif
