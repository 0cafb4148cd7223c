/* SPDX-License-Identifier: MIT
 * Whether two triangles of a mesh meet, by the exact signs of base/orient.h.
 */
#ifndef CSG_MESH_FEATURES_EXACT_H
#define CSG_MESH_FEATURES_EXACT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct csg_exact_triangle {
    float at[3][3];
    uint32_t vertex[3]; /* equal numbers: one vertex of the mesh */
} csg_exact_triangle;

/* Whether they have a point in common that is not of a vertex or an edge that they share. A
 * triangle without area meets those at its edges. */
bool csg_exact_meet(const csg_exact_triangle *s, const csg_exact_triangle *t);

/* Whether two that share no vertex come this near to each other: where coordinates are rounded to
 * decimals they might meet. In double, not exactly. */
bool csg_exact_nearly_meet(const csg_exact_triangle *s, const csg_exact_triangle *t, double reach);

#endif
