/* SPDX-License-Identifier: MIT
 * The loops of an outline as rings of linked corners, for triangulation: the solid is on the left.
 * Joining a hole to the ring around it doubles two corners, so a point can have several.
 */
#ifndef CSG_SHAPE_RINGS_H
#define CSG_SHAPE_RINGS_H

#include "shape/outline.h"
#include "shape/turn.h"

#define CSG_CORNER_NONE UINT32_MAX

typedef struct csg_ring_corner {
    uint32_t point; /* of the outline */
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
