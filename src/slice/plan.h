/* SPDX-License-Identifier: MIT
 * What is the same for all layers of a solid: the heights, the lattice of smallest squares, the
 * tolerance. All lengths are in the field's frame.
 */
#ifndef CSG_SLICE_PLAN_H
#define CSG_SLICE_PLAN_H

#include "field/kernels/kernel.h"
#include "mesh/watch.h"

enum {
    CSG_SLICE_LEAST_LEVELS = 3,
    CSG_SLICE_DEEPEST = 20,          /* levels of cubes below the root: corners are floats */
    CSG_SLICE_SLAB_LEVELS = 9,       /* levels down to a slab at most */
    CSG_SLICE_SLAB_LAYERS = 16,      /* in a slab at least, or all */
    CSG_SLICE_LEVELS_ABOVE = 2,      /* of cubes that reach beyond their slab and may stay whole */
    CSG_SLICE_CUBES_IN_TOLERANCE = 3 /* a smallest square's diagonal is below half the tolerance */
};

typedef struct csg_slice_plan {
    csgm_context *context;
    const csgm_field *field;
    csg_mesh_watch *watch;
    const csg_kernel *kernel;
    csg_box bounds;   /* of the solid, and as much more as floats may be off */
    double corner[3]; /* of the root cube, the least one */
    double step;      /* the edge of the smallest cubes, of which the root has 2^levels in a row */
    int levels;
    int slab_level; /* cubes of this level are as high as a slab */
    double tolerance;
    float rounding;  /* of lengths */
    const double *z; /* of the layers, ascending */
    size_t layer_count;
} csg_slice_plan;

/* Places of corners: the same float wherever one is asked for. */
static inline float csg_slice_place(const csg_slice_plan *plan, int axis, double steps)
{
    return (float)(plan->corner[axis] + steps * plan->step);
}

/* How many layers are below z. */
size_t csg_slice_layers_below(const csg_slice_plan *plan, double z);

/* z: of the layers, in the field's frame. */
void csg_slice_plan_make(csg_slice_plan *plan, csgm_context *context, const csgm_field *field,
                         csg_mesh_watch *watch, double tolerance, const double *z,
                         size_t layer_count);

#endif
