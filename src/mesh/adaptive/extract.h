/* SPDX-License-Identifier: MIT
 * Vertices and triangles of the leaves of a refined lattice: roots on their edges, crease points in
 * their faces, a fan around an apex in each cell.
 *
 * Why nothing meets: segments of a face do not cross, and both cells at the face have the same; a
 * fan around a point strictly within a convex cell does not meet itself, nor the cell's faces but
 * in its loop; a cell has one polygon, or several that are apart, or those of csg_cell_tables.
 */
#ifndef CSG_MESH_ADAPTIVE_EXTRACT_H
#define CSG_MESH_ADAPTIVE_EXTRACT_H

#include "mesh/adaptive/extraction.h"

/* The mesh of leaves whose borders are checked (borders.h). CSGM_OK or why it was stopped
 * (reported); CSGM_ERR_LIMIT above 2^31 vertices. */
csgm_status csg_extract(csg_extraction *extraction);

#endif
