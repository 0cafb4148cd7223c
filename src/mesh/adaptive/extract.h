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

#include "mesh/adaptive/judge.h"
#include "mesh/mesh.h"
#include "mesh/watch.h"

typedef struct csg_extraction {
    /* taken */
    csgm_context *context;
    csg_mesh_watch *watch;
    csg_bricks *bricks;
    const csg_judge *judge;
    csg_vec3 shift;  /* field frame -> relative to the mesh's origin */
    bool colors;     /* the mesh has room for them */
    double farthest; /* how far triangles of leaves beside finer ones may be from the surface */
    size_t checked;  /* bricks: the borders of those before it, among themselves, are simple */
    /* made */
    csgm_mesh *mesh;  /* positions and indices, the caller's; its origin is still to be set */
    uint64_t creases; /* vertices on creases, corners and tips */
    uint64_t smooth;  /* cells in which sheets should meet, and do not */
} csg_extraction;

/* Wants those leaves divided that have several polygons beside finer ones, or touch a pierced edge
 * of finer ones; *any: there are some. Of bricks that were checked only those are again that new
 * ones touch. CSGM_OK or why it was stopped (reported). */
csgm_status csg_extraction_check_borders(csg_extraction *extraction, bool *any);

/* The mesh, or, where leaves beside finer ones turn out to be too far from the surface, *any and no
 * mesh: those want to be divided. CSGM_OK or why it was stopped (reported); CSGM_ERR_LIMIT above
 * 2^31 vertices. */
csgm_status csg_extract(csg_extraction *extraction, bool *any);

#endif
