/* SPDX-License-Identifier: MIT
 * Triangles of an outline made as fat as its edges allow.
 */
#ifndef CSG_SHAPE_DELAUNAY_H
#define CSG_SHAPE_DELAUNAY_H

#include "shape/plane/outline.h"

/* Turns edges between two triangles into the other diagonal until none of them could be fatter
 * (Lawson 1977): triangles as csg_polygons_triangulate gives them, edges of one triangle stay. What
 * it costs is bounded: a few may be left. False: out of memory, the triangles are as good as
 * before. */
bool csg_delaunay_improve(const csg_outline *outline, csg_memory *memory, uint32_t *indices,
                          size_t index_count);

#endif
