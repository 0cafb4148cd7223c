/* SPDX-License-Identifier: MIT
 * Which triangles of a polyhedron, segments of a region can matter in a cube: see prune.h.
 */
#ifndef CSG_FIELD_PRUNE_SHAPES_H
#define CSG_FIELD_PRUNE_SHAPES_H

#include "base/memory.h"
#include "field/kernels/kernel.h"

/* What of a shape's values matters in an octant, and where: in the shape's own units. */
typedef struct csg_shape_demand {
    float reach;  /* distances from its surface that matter; may be infinite */
    float middle; /* at least the distance at the octant's centre */
} csg_shape_demand;

/* From the interval of the leaf's value over the octant and the demand on it. */
csg_shape_demand csg_prune_shape_demand(const csg_tape *tape, const csg_tape_node *leaf, float low,
                                        float high, float demand_low, float demand_high);

/* A cube of the tape's frame, and the radius of the ball around it, rounding included. */
typedef struct csg_shape_cube {
    float center[3], radius;
} csg_shape_cube;

/* Gives the leaf a list in the arena, shorter than the one it has or a copy of that; NULL: the
 * whole shape. *shortened is set where it is shorter. False: out of memory. */
bool csg_prune_shape(const csg_kernel *kernel, const csg_tape *tape, csg_tape_node *leaf,
                     const csg_shape_cube *cube, csg_shape_demand demand, csg_arena *arena,
                     bool *shortened);

/* Its list copied to the arena; false: out of memory. */
bool csg_prune_copy_shape(csg_tape_node *leaf, csg_arena *arena);

#endif
