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
    size_t simple;   /* bricks: the borders of those before it, among themselves, are simple */
    size_t near;     /* the same: they are near the surface */
    /* made */
    csgm_mesh *mesh;  /* positions and indices, the caller's; its origin is still to be set */
    uint64_t creases; /* vertices on creases, corners and tips */
    uint64_t smooth;  /* cells in which sheets should meet, and do not */
} csg_extraction;

/* The mesh of leaves whose borders are checked (borders.h). CSGM_OK or why it was stopped
 * (reported); CSGM_ERR_LIMIT above 2^31 vertices. */
csgm_status csg_extract(csg_extraction *extraction);

#endif
