/* SPDX-License-Identifier: MIT
 * Plane convex facets cut by planes, and a convex cell made of such: a box that half-spaces cut.
 */
#ifndef CSG_SHAPE_CONVEX_CELL_H
#define CSG_SHAPE_CONVEX_CELL_H

#include "base/geometry.h"
#include "base/memory.h"

typedef struct csg_cut_plane { /* the points where dot(normal, p) <= offset */
    csg_vec3 normal;           /* unit, outward */
    double offset;
} csg_cut_plane;

typedef struct csg_facet {
    csg_cut_plane plane; /* what is behind it */
    csg_vec3 *points;    /* counter-clockwise seen from outside; in an arena */
    size_t count;
    uint32_t number; /* of the plane among others, for who counts them */
} csg_facet;

typedef struct csg_convex_cell {
    csg_arena *arena;
    double slack;
    csg_facet *facets;
    size_t count;
} csg_convex_cell;

csg_cut_plane csg_cut_plane_turned(const csg_cut_plane *plane);

/* From its points; false: they lie on a line, to `slack`. */
bool csg_facet_find_plane(csg_facet *facet, double slack);
/* The least and the largest distance of its points from the plane, positive outside. */
void csg_facet_reach(const csg_facet *facet, const csg_cut_plane *plane, double *low, double *high);
/* What lies behind the plane (parts[0]) and before it; of one that lies in it, to `slack`, nothing.
 * False: out of memory. */
bool csg_facet_split(csg_arena *arena, const csg_facet *facet, const csg_cut_plane *plane,
                     double slack, csg_facet parts[2]);

/* All of these: false without memory. */
bool csg_convex_cell_begin(csg_convex_cell *cell, csg_arena *arena, csg_box box, double slack);
bool csg_convex_cell_cut(csg_convex_cell *cell, const csg_cut_plane *by);
/* Each corner once, in the arena; none where the cell is thinner than a few `slack`. */
bool csg_convex_cell_corners(const csg_convex_cell *cell, csg_vec3 **out, size_t *count);

#endif
