/* SPDX-License-Identifier: MIT
 * A refined lattice on its way to a mesh: its borders are checked (borders.h), then its triangles
 * are made (extract.h).
 */
#ifndef CSG_MESH_ADAPTIVE_EXTRACTION_H
#define CSG_MESH_ADAPTIVE_EXTRACTION_H

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

#endif
