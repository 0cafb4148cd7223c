/* SPDX-License-Identifier: MIT
 * Exact set operations on outlines, by the Clipper library (clipper.cc, the only file that knows
 * it). Results are clean: loops do not cross, outer ones run counter-clockwise, holes clockwise;
 * a loop visits no point twice, but may touch others. Coordinates are rounded to a grid of about
 * 1e-9 of the operands' extent; its step is a power of two, so small whole numbers and halves stay
 * what they are.
 */
#ifndef CSG_SHAPE_POLYGONS_H
#define CSG_SHAPE_POLYGONS_H

#include "shape/plane/outline.h"
#include "shape/plane/polygons_terms.h"

/* All of these: *out is initialised and filled on CSGM_OK, else left empty. CSGM_ERR_MEMORY (more
 * than 2^24 points count as that), CSGM_ERR_SCENE: a coordinate is not finite, CSGM_ERR_LIMIT: it
 * crosses itself so often, or so many of its edges lie beside each other, that it would take more
 * than some seconds (crossings.h), or CSGM_ERR_UNSUPPORTED where the program was built without the
 * library. */

/* The area that the loops enclose by the rule, as clean loops. */
csgm_status csg_polygons_clean(const csg_outline *in, csg_fill fill, csg_outline *out);
/* a op b of clean outlines. (Of several overlapping ones, all in one outline: csg_polygons_clean
 * with NONZERO is their union.) */
csgm_status csg_polygons_combine(csg_polygons_op op, const csg_outline *a, const csg_outline *b,
                                 csg_outline *out);
/* CSGM_ERR_LIMIT: csg_polygons_clean would say that, for what is said to be clean already. */
csgm_status csg_polygons_check(const csg_outline *in);
/* Grown (or shrunk) by `by`; round corners within `tolerance` of true arcs, but not finer than 1e-6
 * of the radius. Chamfers are cut at the distance `by` from the corner. Loops are read by NONZERO.
 */
csgm_status csg_polygons_offset(const csg_outline *in, double by, csg_corner corner,
                                double tolerance, csg_outline *out);
/* Minkowski sum of a clean outline and the convex hull of another. Empty where one of them is. */
csgm_status csg_polygons_minkowski(const csg_outline *a, const csg_outline *b, csg_outline *out);

/* One counter-clockwise loop around all points, or none when they lie on a line. (Our own: a few
 * lines of monotone chain; polygons_hull.c.) */
csgm_status csg_polygons_hull(const csg_outline *in, csg_outline *out);

/* Triangles of a clean outline: 3 indices each into its points, counter-clockwise, from `memory`;
 * of points at one place (where loops touch) the first stands for all. Every edge of the outline is
 * an edge of just one of them, every other edge of two. *indices is released by the caller,
 * *index_count * sizeof(uint32_t) bytes; NULL where there are none. CSGM_ERR_LIMIT: it would take
 * more than some seconds. (Our own: triangulate.c.) */
csgm_status csg_polygons_triangulate(const csg_outline *in, csg_memory *memory, uint32_t **indices,
                                     size_t *index_count);
/* Convex loops, counter-clockwise, whose union is the area of a clean outline: fewer than its
 * triangles. CSGM_ERR_LIMIT as there. (Our own: convex_parts.c.) */
csgm_status csg_polygons_convex_parts(const csg_outline *in, csg_memory *memory, csg_outline *out);

#endif
