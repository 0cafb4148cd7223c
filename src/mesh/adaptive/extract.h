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

/* A part of it. */
typedef struct csg_extracted_part {
    csgm_mesh *mesh;  /* open where others go on; its origin is still to be set */
    uint64_t *places; /* per vertex: of the edge or face of cells that it is on, which others may
                         have too; 0: it is in a cell */
    uint8_t *creases; /* per vertex: whether it is on a crease, corner or tip */
} csg_extracted_part;

/* That of these leaves alone; x->mesh stays as it is, and x->creases are not counted. CSGM_OK or as
 * csg_extract. */
csgm_status csg_extract_part(csg_extraction *extraction, const uint32_t *leaves, size_t count,
                             csg_extracted_part *part);
void csg_extracted_part_release(csg_extracted_part *part);

#endif
