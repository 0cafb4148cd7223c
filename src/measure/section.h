/* SPDX-License-Identifier: MIT
 * Plane sections of a cube carved by a formula of half spaces: how much of a face of the cube is
 * in the solid, and how much of the solid's surface a piece of it has in the cube, seen along the
 * piece's normal. Each between what is certain and what is possible.
 */
#ifndef CSG_MEASURE_SECTION_H
#define CSG_MEASURE_SECTION_H

#include "measure/halves.h"

typedef struct csg_section {
    double least, most; /* areas */
} csg_section;

/* Pieces of a surface that run so close beside each other in the cube that one direction sees the
 * solid's surface as a graph over its plane, whichever of them it is. */
typedef struct csg_section_group {
    uint32_t planes; /* bits */
    int count, first;
    double direction[3]; /* unit, along the first one's slope: inwards */
    double width;   /* zeros of all of them are that close to the first one's plane, along it */
    double cosine;  /* of the surface's normals with the direction, at least; 0: not known */
    bool is_convex; /* each bounds a convex solid, or what is left around one */
} csg_section_group;

/* The face x_axis = side * half, side: -1 or 1. */
csg_section csg_section_of_face(const csg_halves *halves, double half, int axis, int side);

/* The planes that can be the surface somewhere in the cube, in groups. Returns how many groups. */
int csg_section_find_groups(const csg_halves *halves, double half,
                            csg_section_group groups[CSG_HALVES_MOST]);

/* The surface of the group's pieces in the cube, projected along the group's direction: the area
 * where it is for certain, and the one where it may be, counted once for each piece that it may be
 * of. Pieces of different groups share nothing that is certain. */
csg_section csg_section_of_group(const csg_halves *halves, double half,
                                 const csg_section_group *group);

#endif
