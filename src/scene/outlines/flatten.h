/* SPDX-License-Identifier: MIT
 * The outline of a flat figure while its scene is being built, for what needs polygons: offsets
 * with corners, hulls, sums, twisted extrusions.
 *
 * Circles and rectangles become polygons within the tolerance, regions give their own outlines;
 * they are placed, offset (with round corners) and combined exactly by the polygon library. What is
 * no polygon (blends, slices of solids, formulas) is traced along its zero contour on a lattice of
 * CSG_TRACE_CELLS cells along the longer side of its box: curves are as good as chords of that
 * length, sharp corners within are cut by up to one cell, and what is thinner than a cell may be
 * lost.
 */
#ifndef CSG_SCENE_FLATTEN_H
#define CSG_SCENE_FLATTEN_H

#include "scene/tree/build.h"

enum { CSG_TRACE_CELLS = 512 };

/* *out is initialised (from the context's memory) and clean on CSGM_OK, else left empty. The node
 * stays as it is. CSGM_ERR_SCENE: it is not flat, or what must be traced has no finite bounds;
 * CSGM_ERR_MEMORY; CSGM_ERR_UNSUPPORTED: it needs the polygon library, which this build is without.
 * Nothing is reported. */
csgm_status csg_flatten(csg_scene_builder *builder, csg_node_id flat, double tolerance,
                        csg_outline *out);

#endif
