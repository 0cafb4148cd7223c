/* SPDX-License-Identifier: MIT
 * A solid bounded by triangles, as a field: exact distance by a tree of boxes, inside by the
 * winding number. Triangles as people publish them are first made a closed chain (every edge as
 * often in one direction as in the other): corners at one place are welded, loose faces turned
 * alike, holes filled. The winding number of a closed chain is a whole number off the
 * surface, so the field has no jumps, and what is meshed from it is closed.
 *
 * Shells that overlap unite, but their triangles within others stay: the field is 0 on them and
 * positive on both sides. That shows only where the solid is shrunk or hollowed.
 */
#ifndef CSG_SHAPE_POLYHEDRON_H
#define CSG_SHAPE_POLYHEDRON_H

#include "shape/polyhedra/repairs.h"
#include "shape/shape.h"

/* The inside is where the winding number is 1 or more (of the mended, outward triangles).
 * CSGM_ERR_SCENE: no triangles with area; coordinates must be finite. */
csgm_status csg_polyhedron_create(csg_memory *memory, const csg_triangles *triangles,
                                  csg_repairs *repairs, csg_shape **out);
/* The mended triangles, valid as long as the shape. */
const csg_triangles *csg_polyhedron_triangles(const csg_shape *polyhedron);

/* Each triangle has a place below their number, near ones near places: which of them it is. */
uint32_t csg_polyhedron_triangle_at(const csg_shape *polyhedron, uint32_t place);
/* Places of the triangles that come within `reach` of the one at `place`, this one too, and of
 * others; false as soon as `visit` says so. */
typedef bool csg_polyhedron_visit(void *user, uint32_t place);
bool csg_polyhedron_near(const csg_shape *polyhedron, uint32_t place, double reach,
                         csg_polyhedron_visit *visit, void *user);
/* Whether there is solid behind the middle of the triangle, once, and none before it, as far as a
 * billionth of the whole away. */
bool csg_polyhedron_is_clear(const csg_shape *polyhedron, uint32_t place);
/* All edges convex, one piece, nothing mended that matters. */
bool csg_polyhedron_is_convex(const csg_shape *polyhedron);

#endif
