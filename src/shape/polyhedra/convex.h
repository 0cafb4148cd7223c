/* SPDX-License-Identifier: MIT
 * Whether a closed chain bounds a convex solid.
 */
#ifndef CSG_SHAPE_CONVEX_H
#define CSG_SHAPE_CONVEX_H

#include "shape/polyhedra/edges.h"

/* Of one piece in a frame that is nowhere inside twice: every edge bends outwards, up to 2^-30. */
bool csg_chain_is_convex(const csg_triangles *chain, const csg_triangle_edges *edges);

#endif
