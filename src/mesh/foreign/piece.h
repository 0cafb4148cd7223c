/* SPDX-License-Identifier: MIT
 * One part of a mesh of others on its way through OpenMesh: its triangles, mended as those of
 * imports are, as a closed manifold whose vertices know what they were.
 */
#ifndef CSG_MESH_FOREIGN_PIECE_H
#define CSG_MESH_FOREIGN_PIECE_H

#include "mesh/foreign/halfedges.h"
#include "mesh/mesh.h"
#include "mesh/remesh/corners.h"
#include "shape/polyhedra/repair.h"

/* Colour and material of a corner: what may jump where vertices share a place. */
typedef struct csg_corner_look {
    uint8_t color[4];
    uint16_t material[2];
} csg_corner_look;

/* Corners (half-edges that begin there) by their vertices: the first of each vertex, and of each
 * corner the next one of its vertex; UINT32_MAX ends. */
typedef struct csg_vertex_corners {
    uint32_t *first, *next;
} csg_vertex_corners;

typedef struct csg_foreign_piece {
    csg_arena *arena; /* holds all of it */
    csgm_mesh_view source;
    uint64_t first_triangle, triangle_count; /* in the source */
    csg_triangle_frame frame;
    csg_halfedge_mesh mesh;  /* vertices in the frame, one for each fan of triangles */
    uint32_t *source_vertex; /* of each vertex at first: one of the source's at its place */
    uint32_t *
        triangle_of; /* of each triangle at first: one of the source; UINT32_MAX: it fills a hole */
    csg_corner_look
        *looks;      /* of each half-edge's first corner at first; NULL: there is one look only */
    uint32_t *group; /* of each triangle at first: seams are between groups */
    double (*points)[3];        /* of vertices at first */
    csg_vertex_corners corners; /* at first; none where there is one look only */
} csg_foreign_piece;

/* CSGM_ERR_SCENE: it encloses nothing; CSGM_ERR_MEMORY. Neither is reported. */
csgm_status csg_foreign_piece_make(csg_arena *arena, const csgm_mesh_view *source,
                                   uint64_t first_triangle, uint64_t triangle_count,
                                   csg_foreign_piece *out, csg_repairs *repairs);
/* In the arena. False: out of memory. */
bool csg_list_corners(csg_arena *arena, const csg_halfedge_mesh *mesh, csg_vertex_corners *out);
/* What the source says of a vertex; zeros of what it does not have. */
csg_corner_look csg_vertex_look(const csgm_mesh_view *source, uint32_t vertex);
/* The look of corner k of a triangle as it is now. */
csg_corner_look csg_foreign_look(const csg_foreign_piece *piece, size_t triangle, int k);

#endif
