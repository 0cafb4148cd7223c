/* SPDX-License-Identifier: MIT
 * A closed oriented triangle mesh that is being changed: a corner table (Rossignac, Safonova and
 * Szymczak 2001). Corner 3 t + k is vertex k of triangle t; across[c] is the corner that faces c
 * over the edge opposite to it. Walking around a vertex, collapsing and flipping an edge need no
 * lists; the caller asks first whether the mesh stays a manifold.
 */
#ifndef CSG_MESH_REMESH_CORNERS_H
#define CSG_MESH_REMESH_CORNERS_H

#include "base/memory.h"

#define CSG_CORNER_NONE UINT32_MAX
/* An edge whose triangles turn by more than this is a crease: 20 degrees between normals. */
#define CSG_CREASE_COS 0.94

enum { CSG_CORNERS_MOST_VALENCE = 256 }; /* a collapse that would make more is refused */

typedef struct csg_corners {
    csg_memory *memory;
    uint32_t *vertex; /* 3 * triangle_count; NONE at the first corner: the triangle is gone */
    uint32_t *across; /* 3 * triangle_count */
    uint32_t *corner; /* per vertex: one of its corners; NONE: the vertex is gone */
    uint32_t triangle_count, vertex_count;
    uint32_t live; /* triangles left */
} csg_corners;

typedef enum csg_corners_result {
    CSG_CORNERS_MADE,
    CSG_CORNERS_NO_MEMORY,
    CSG_CORNERS_NOT_CLOSED /* or not oriented, or a vertex with several fans, or too large */
} csg_corners_result;

/* Copies the indices. Nothing to release unless MADE. */
csg_corners_result csg_corners_make(csg_corners *corners, csg_memory *memory,
                                    const uint32_t *indices, uint64_t triangle_count,
                                    uint64_t vertex_count);
void csg_corners_release(csg_corners *corners);

static inline uint32_t csg_corner_next(uint32_t c)
{
    return c % 3 == 2 ? c - 2 : c + 1;
}
static inline uint32_t csg_corner_previous(uint32_t c)
{
    return c % 3 == 0 ? c + 2 : c - 1;
}
/* The next corner at the same vertex, counter-clockwise from outside. */
static inline uint32_t csg_corner_swing(const csg_corners *corners, uint32_t c)
{
    return csg_corner_next(corners->across[csg_corner_next(c)]);
}
static inline bool csg_corners_is_live(const csg_corners *corners, uint32_t triangle)
{
    return corners->vertex[3 * triangle] != CSG_CORNER_NONE;
}

uint32_t csg_corners_valence(const csg_corners *corners, uint32_t vertex);
/* The corner at `from` whose next corner is at `to`: the triangle left of the edge. NONE: there is
 * no such edge. */
uint32_t csg_corners_find_edge(const csg_corners *corners, uint32_t from, uint32_t to);

/* Whether the edge that starts at this corner may shrink to a point: its ends have no neighbours in
 * common but the two that face it, and these keep three triangles or more. */
bool csg_corners_can_collapse(const csg_corners *corners, uint32_t corner);
/* Takes the edge's first vertex and its two triangles away; the second vertex stands for both. */
void csg_corners_collapse(csg_corners *corners, uint32_t corner);

/* Whether the edge that starts at this corner may be replaced by the other diagonal. */
bool csg_corners_can_flip(const csg_corners *corners, uint32_t corner);
void csg_corners_flip(csg_corners *corners, uint32_t corner);

/* Puts a vertex on the edge that starts at this corner; each of its triangles is cut in two. The
 * vertex and the two triangles are ones that are gone. */
void csg_corners_split(csg_corners *corners, uint32_t corner, uint32_t vertex,
                       const uint32_t triangles[2]);

#endif
