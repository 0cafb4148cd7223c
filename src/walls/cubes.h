/* SPDX-License-Identifier: MIT
 * The surface of a field in cubes, as a tree for walls/search.
 */
#ifndef CSG_WALLS_CUBES_H
#define CSG_WALLS_CUBES_H

#include "clearance/support.h"
#include "walls/search.h"
#include "walls/side.h"

/* Planes that may meet in the cube, and with them faces: at a point of the surface normals are
 * between those of one group's. */
typedef struct csg_wall_group {
    csg_wall_normals
        normals; /* of what is beyond the wall, or gap, outward: towards the other side */
    uint8_t planes[CSG_HALVES_MOST]; /* of each cap: its plane */
    bool has_planes;
} csg_wall_group;

typedef struct csg_wall_cube {
    csg_measure_cube cube;          /* SURFACE */
    const csg_clear_pieces *pieces; /* contain what is beyond; NULL: all of the cube may be */
    const csg_wall_group *groups;
    uint32_t first_child;
    uint8_t group_count, child_count;
    bool is_divided, is_vague; /* vague: some normals are hardly known */
} csg_wall_cube;

typedef struct csg_wall_cubes {
    csg_wall_side side;
    csg_arena arena; /* tapes, pieces, normals */
    csg_wall_cube *nodes;
    size_t count, capacity;
    bool overlooks; /* places were left out where segments would be shorter than the finest */
} csg_wall_cubes;

/* *is_there: there is a surface at all. False: out of memory. Release it in any case. */
bool csg_wall_cubes_begin(csg_wall_cubes *cubes, const csg_wall_side *side, bool *is_there);
void csg_wall_cubes_release(csg_wall_cubes *cubes);
csg_wall_source csg_wall_cubes_source(csg_wall_cubes *cubes);

#endif
