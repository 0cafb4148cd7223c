/* SPDX-License-Identifier: MIT
 * What the judge found on the way to his verdict of a brick, kept for the mesh of its leaves: it
 * would find the same. Vertices are floats already, as the mesh has them.
 */
#ifndef CSG_MESH_ADAPTIVE_JUDGED_H
#define CSG_MESH_ADAPTIVE_JUDGED_H

#include "mesh/adaptive/pierce.h"

enum {
    CSG_BRICK_SLOTS = 3 * CSG_BRICK_POINTS, /* of edges, of faces: csg_brick_slot */
    CSG_JUDGED_MOST_ROOTS = 2 * CSG_BRICK_EDGES,
    CSG_JUDGED_MOST_CREASES = CSG_SIDE_PARTS * CSG_MOST_FACES,
    CSG_JUDGED_MOST_PIECES = 4,                         /* polygons of a cell */
    CSG_JUDGED_MOST_APEXES = 8 * CSG_JUDGED_MOST_PIECES /* of a brick's polygons */
};

/* The slot of an edge, or of a face, along or across an axis, by its lower (lowest) point. */
static inline unsigned csg_brick_slot(int axis, const unsigned low[3])
{
    enum { N = CSG_BRICK_SAMPLES };
    return (unsigned)axis * CSG_BRICK_POINTS + low[0] + N * (low[1] + N * low[2]);
}

static inline int csg_slot_place(unsigned slot, unsigned low[3])
{
    enum { N = CSG_BRICK_SAMPLES };
    low[0] = slot % N, low[1] = slot / N % N, low[2] = slot % CSG_BRICK_POINTS / (N * N);
    return (int)(slot / CSG_BRICK_POINTS);
}

/* A vertex on an edge; quarters: its span's middle, in quarters of the edge: 2, or 1 and 3 of the
 * halves of a pierced one. */
typedef struct csg_judged_root {
    float at[3], gradient[3];
    uint8_t slot, quarters;
} csg_judged_root;

/* A vertex in a face. */
typedef struct csg_judged_crease {
    float at[3], gradient[3];
    uint8_t slot, part; /* of csg_face_side */
    bool is_smooth;     /* it has a gradient */
    bool is_torn;       /* csg_face_crease */
} csg_judged_crease;

/* The point in the middle of a fan, as long as the polygon has so many vertices in faces; of no
 * polygon: the place of the surface that is farthest from the triangles of the cell (cover.h). */
typedef struct csg_judged_apex {
    float at[3];
    uint8_t cell, polygon, in_faces;
    uint8_t kind; /* a csg_apex_kind */
} csg_judged_apex;
#define CSG_JUDGED_NO_POLYGON UINT8_C(0xFF)

typedef struct csg_judged {
    uint8_t root_count, crease_count, apex_count;
    const csg_judged_root *roots;
    const csg_judged_crease *creases;
    const csg_judged_apex *apexes;
    const csg_pierced *pierced; /* NULL: no edge is */
} csg_judged;

/* What is kept of a side's part; its slot is for the caller. False: there is nothing. */
bool csg_judged_crease_of(const csg_face_side *side, unsigned part, csg_judged_crease *out);
/* A copy in an arena. NULL: out of memory. */
const csg_judged *csg_judged_keep(csg_arena *arena, const csg_judged *judged);
/* Keeps there what bricks from `first` on, and all that there are by now, have for their own: half
 * of what the judge found on edges and in faces lies on the borders of bricks, and others have it,
 * too. False: out of memory. */
bool csg_judged_keep_own(csg_arena *arena, csg_bricks *bricks, size_t first);

/* The same for other ranks (base/rank_loop.h). False: out of memory. */
bool csg_judged_pack(csg_memory *memory, const csg_judged *judged, csg_records *records);
bool csg_judged_unpack(csg_arena *arena, csg_record_reader *reader, size_t item,
                       const csg_judged **out);

/* Of a brick whose judge kept nothing, because no leaf is left of it, there is nothing. */
const csg_pierced *csg_judged_pierced(const csg_judged *judged);
/* NULL: there is none in that face, in that part of the side. */
const csg_judged_crease *csg_judged_crease_in(const csg_judged *judged, unsigned slot,
                                              unsigned part);
/* NULL: it was not cut that way, or had other vertices. */
const csg_judged_apex *csg_judged_apex_of(const csg_judged *judged, unsigned cell, unsigned polygon,
                                          unsigned in_faces);

#endif
