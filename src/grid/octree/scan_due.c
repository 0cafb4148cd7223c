/* SPDX-License-Identifier: MIT
 * Whether a block is to be looked at for what lies between its samples; see scan.h.
 */
#include "field/cones/cone.h"
#include "grid/octree/block.h"

bool csg_scan_is_due(const csg_lattice *lattice, double margin, const uint32_t at[3],
                     const csg_tape *tape)
{
    csg_cone cone;
    float c[3];
    for (int axis = 0; axis < 3; axis++)
        c[axis] =
            csg_lattice_coordinate(lattice, axis, at[axis] * CSG_BLOCK_EDGE + CSG_BLOCK_EDGE / 2);
    double radius = (double)csg_lattice_ball_radius(lattice, margin, CSG_BLOCK_EDGE / 2);
    return !csg_cone_find(NULL, tape, c, radius, &cone);
}

bool csg_scan_comes_first(const csg_tape *tape)
{
    bool any = false;
    for (uint32_t i = 0; i < tape->count && !any; i++)
        any = tape->nodes[i].op == CSG_OP_SHAPE &&
              csg_tape_shape(tape, &tape->nodes[i])->kind == CSG_SHAPE_POLYHEDRON;
    return any;
}
