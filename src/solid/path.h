/* SPDX-License-Identifier: MIT
 * Paths in space along which figures are swept: points come in, pieces with frames go out. A piece
 * is a straight line or an arc of at most 90 degrees; two that meet have one tangent there, or they
 * make a corner, which is mitred.
 *
 * A frame turns with the tangent and no further (rotation-minimising: W. Wang, B. Juettler,
 * D. Zheng, Y. Liu, Computation of Rotation Minimizing Frames, ACM TOG 27 (2008)). Of lines and
 * arcs that is exact: nothing turns along a line, and along an arc all turns about its axis. What
 * shall turn further (a twist, a closed path in space, a figure that stays upright) does so evenly
 * along pieces.
 */
#ifndef CSG_SOLID_PATH_H
#define CSG_SOLID_PATH_H

#include "base/geometry.h"
#include "base/memory.h"

/* Right-handed and orthonormal: x cross y is the tangent. */
typedef struct csg_path_frame {
    csg_vec3 at, x, y, tangent;
} csg_path_frame;

typedef struct csg_path_piece {
    csg_path_frame start, end; /* end: before `turn`; the next piece's start has turned, too */
    double length;
    double radius, angle; /* of an arc, and how far it goes round, in degrees, > 0; a line has 0 */
    csg_vec3 inward;      /* unit vector to the arc's centre at its start */
    double turn;          /* of the figure along the piece, in degrees, counter-clockwise seen
                             against the tangent */
    uint32_t from;        /* the point given at which it begins, or before which */
} csg_path_piece;

typedef struct csg_path {
    csg_memory *memory;
    csg_path_piece *pieces;
    size_t count, capacity;
    bool closed; /* the last piece's end is the first one's start */
} csg_path;

typedef struct csg_path_shape {
    const csg_vec3 *points;
    uint32_t count;
    bool closed, smooth, upright;
    double round; /* radius of the arcs in the place of corners; 0: corners stay */
    double twist; /* from end to end, in degrees, clockwise seen against the tangent */
    csg_vec3 up;  /* the figure's y axis is as near to it as it can be where the path begins */
} csg_path_shape;

typedef enum csg_path_fault {
    CSG_PATH_SOUND,
    CSG_PATH_NO_MEMORY,
    CSG_PATH_COINCIDES,   /* points `at` and `other` are one */
    CSG_PATH_TURNS_BACK,  /* at point `at` */
    CSG_PATH_BENDS_MEET,  /* arcs at points `at` and `other` need `needed` of the length `there` */
    CSG_PATH_RUNS_UP,     /* along `up` at point `at`, so that nothing is upright */
    CSG_PATH_TOO_THICK,   /* the figure reaches `needed` inwards where the path's radius is `there`,
                             after point `at` */
    CSG_PATH_TURNS_THICK, /* the same of a figure that turns, which may reach half as far */
    CSG_PATH_TOO_SHORT, /* mitres at points `at` and `other` need `needed` of the length `there` */
    CSG_PATH_CANNOT_TURN, /* for mitres as above, and nothing is left to turn along */
} csg_path_fault;

typedef struct csg_path_finding {
    csg_path_fault fault;
    uint32_t at, other;
    double needed, there;
} csg_path_finding;

/* At least two points, three of a closed path; all finite. False: `found` says why. */
bool csg_path_make(csg_path *path, csg_memory *memory, const csg_path_shape *shape,
                   csg_path_finding *found);
void csg_path_release(csg_path *path);
/* What is before piece i, or after it, across a joint; SIZE_MAX: an end of the path. */
size_t csg_path_before(const csg_path *path, size_t i);
size_t csg_path_after(const csg_path *path, size_t i);
/* Does it meet the one before at a corner? False at an end. */
bool csg_path_is_corner(const csg_path *path, size_t i);
/* The normal, along the path, of the plane where piece i begins: halfway between both tangents. */
csg_vec3 csg_path_joint(const csg_path *path, size_t i);

#endif
