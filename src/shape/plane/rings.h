/* SPDX-License-Identifier: MIT
 * The boundary of a region as rings of linked corners, for triangulation: the solid is on the left.
 * Joining a hole to the ring around it doubles two corners, so a point can have several.
 */
#ifndef CSG_SHAPE_RINGS_H
#define CSG_SHAPE_RINGS_H

#include "base/orient.h"
#include "shape/plane/outline.h"

#define CSG_CORNER_NONE UINT32_MAX

typedef struct csg_ring_corner {
    uint32_t point; /* of the outline; the first of those at its place */
    uint32_t previous, next;
    uint32_t next_in_cell; /* triangulate.c */
    bool is_joined;        /* part of a ring that can be joined to */
    bool is_blocker;       /* triangulate.c */
} csg_ring_corner;

typedef struct csg_rings {
    const csg_outline *outline;
    csg_ring_corner *corners; /* the outline's points first, then the doubled ones */
    uint32_t corner_count;
} csg_rings;

typedef struct csg_ring_start {
    csg_vec2 at; /* of the ring's leftmost, lowest corner */
    uint32_t corner;
} csg_ring_start;

/* Links the outline's points; corners has room for all, starts too. Where loops touch at points,
 * they are linked anew so that each ring goes around one piece of the solid, or around one hole or
 * several that hang together: then rings and holes do not meet. starts gets the rings, then the
 * holes from left to right. */
void csg_rings_link(csg_rings *rings, csg_ring_start *starts, size_t *ring_count,
                    size_t *hole_count);

static inline csg_vec2 csg_ring_at(const csg_rings *rings, uint32_t corner)
{
    return rings->outline->points[rings->corners[corner].point];
}

/* Whether the way from the corner towards q begins in the solid. */
bool csg_ring_sees(const csg_rings *rings, uint32_t corner, csg_vec2 q);

/* Joins the hole whose leftmost, lowest corner is given to a ring by a cut to a corner that it
 * sees. Two more corners. False: nothing lies to its left, which no clean outline has. */
bool csg_ring_join(csg_rings *rings, uint32_t hole);

#endif
