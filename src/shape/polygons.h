/* SPDX-License-Identifier: MIT
 * Exact set operations on outlines, by the Clipper library (polygons.cc, the only file that knows
 * it). Results are clean: loops do not cross, outer ones run counter-clockwise, holes clockwise.
 * Coordinates are rounded to a grid of about 1e-9 of the operands' extent.
 */
#ifndef CSG_SHAPE_POLYGONS_H
#define CSG_SHAPE_POLYGONS_H

#include "shape/outline.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum csg_fill { CSG_FILL_EVEN_ODD, CSG_FILL_NONZERO } csg_fill;
typedef enum csg_polygons_op {
    CSG_POLYGONS_UNION,
    CSG_POLYGONS_INTERSECTION,
    CSG_POLYGONS_DIFFERENCE
} csg_polygons_op;
typedef enum csg_corner { CSG_CORNER_ROUND, CSG_CORNER_MITER, CSG_CORNER_CHAMFER } csg_corner;

/* All of these: *out is initialised and filled on CSGM_OK, else left empty. CSGM_ERR_MEMORY, or
 * CSGM_ERR_UNSUPPORTED where the program was built without the library. */

/* The area that the loops enclose by the rule, as clean loops. */
csgm_status csg_polygons_clean(const csg_outline *in, csg_fill fill, csg_outline *out);
/* a op b of clean outlines. */
csgm_status csg_polygons_combine(csg_polygons_op op, const csg_outline *a, const csg_outline *b,
                                 csg_outline *out);
/* Grown (or shrunk) by `by`; round corners within `tolerance` of true arcs. */
csgm_status csg_polygons_offset(const csg_outline *in, double by, csg_corner corner,
                                double tolerance, csg_outline *out);
/* Minkowski sum of a clean outline and a convex one. */
csgm_status csg_polygons_minkowski(const csg_outline *a, const csg_outline *b, csg_outline *out);

/* One counter-clockwise loop around all points, or none when they lie on a line. (Our own: a few
 * lines of monotone chain.) */
csgm_status csg_polygons_hull(const csg_outline *in, csg_outline *out);

/* Triangles of a clean outline: 3 indices each into its points, counter-clockwise, from `memory`;
 * every edge of the outline is an edge of just one of them. *indices is released by the caller,
 * *index_count * sizeof(uint32_t) bytes. */
csgm_status csg_polygons_triangulate(const csg_outline *in, csg_memory *memory, uint32_t **indices,
                                     size_t *index_count);

#ifdef __cplusplus
}
#endif

#endif
