/* SPDX-License-Identifier: MIT
 * What runs of a mesh have in common: vertices that triangles of several runs use, from the first
 * run that has one until its link is closed; and triangles of vertices whose places are not known
 * yet. So memory is that of the border of what has been seen, not of the mesh. One thread at a
 * time.
 */
#ifndef CSG_MESH_FIGURES_SEAM_H
#define CSG_MESH_FIGURES_SEAM_H

#include "base/memory.h"
#include "mesh/figures/link.h"
#include "mesh/figures/measures.h"

/* A vertex that is open. */
typedef struct csg_seam_vertex {
    uint32_t number, piece;
    uint32_t arcs, arc_count; /* the first of a list */
    uint32_t waiting;         /* corners that want its place: the first of a list */
    bool is_placed;
    float at[3];
} csg_seam_vertex;

typedef struct csg_seam_arc csg_seam_arc;
typedef struct csg_seam_triangle csg_seam_triangle;

typedef struct csg_seam {
    csg_memory *memory;
    csg_seam_vertex *slots; /* open addressing with linear probing, at most half full */
    size_t size, count;
    csg_seam_arc *arcs;
    csg_seam_triangle *triangles;
    size_t arc_room, triangle_room, arc_count, triangle_count; /* with free ones: */
    uint32_t free_arc, free_triangle;
    csg_link_arc *link; /* of the vertex at hand */
    size_t link_room;
    uint32_t *pieces; /* sets (base/sets.h) of pieces of runs that hang together */
    size_t piece_count, piece_room;
    uint64_t components; /* that no other run has a part of */
} csg_seam;

#define CSG_SEAM_NONE UINT32_MAX

/* `count` pieces more, each a set of its own: the first's number, or CSG_SEAM_NONE: out of memory,
 * as below where false is returned. */
uint32_t csg_seam_add_pieces(csg_seam *seam, size_t count);
/* Room for so many vertices more, and arcs at each: until it is called again, or a vertex closed,
 * vertices stay where csg_seam_meet says that they are. */
bool csg_seam_reserve(csg_seam *seam, size_t vertices, size_t arcs);
/* Some of the link of a vertex, in a piece (CSG_SEAM_NONE: nothing of it yet), in room that was
 * reserved. at: its place, NULL where
 * another run has it. */
csg_seam_vertex *csg_seam_meet(csg_seam *seam, uint32_t vertex, uint32_t piece, const float *at);
void csg_seam_add_arc(csg_seam *seam, csg_seam_vertex *vertex, csg_link_arc arc);
/* A triangle: measured now, or once the places of all its vertices are known. at: 9 floats;
 * vertices: NULL for those whose places stand there. */
bool csg_seam_add_triangle(csg_seam *seam, csg_seam_vertex *const vertices[3], const float *at,
                           csg_mesh_measures *measures);
/* Measures the triangles that have waited for this vertex last, which has a place now. */
void csg_seam_settle(csg_seam *seam, csg_seam_vertex *vertex, csg_mesh_measures *measures);
/* Forgets the vertex if its link is closed and no triangle waits for its place: *is_closed. */
bool csg_seam_close(csg_seam *seam, uint32_t vertex, bool *is_closed);
uint64_t csg_seam_components(csg_seam *seam);
void csg_seam_release(csg_seam *seam);

#endif
