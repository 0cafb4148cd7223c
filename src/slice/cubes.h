/* SPDX-License-Identifier: MIT
 * The cubes of a slab, which is as high as a cube of the plan's slab level: an octree of the cubes
 * that layers run through, down to where it is known that a square of a layer shows the solid to
 * the tolerance.
 *
 * A cube is EMPTY where the field has no zero in it. It is SMOOTH where the solid in it is a half
 * space, but for a sheet between parallel planes no thicker than the tolerance (measure/halves.h):
 * then what corners do not show is thinner, too. Where more than one smooth piece meets cubes are
 * halved down to the smallest, a third of the tolerance: what is not seen there is thinner than
 * their diagonal. Of these a cube is SHARP where the pieces are known and do not face each other;
 * else something thin may be there that no corner shows, and it is UNSETTLED.
 */
#ifndef CSG_SLICE_CUBES_H
#define CSG_SLICE_CUBES_H

#include "field/prune/prune.h"
#include "slice/plan.h"

typedef enum csg_slice_kind {
    CSG_SLICE_EMPTY,
    CSG_SLICE_SPLIT,
    CSG_SLICE_SMOOTH,
    CSG_SLICE_SHARP,
    CSG_SLICE_UNSETTLED
} csg_slice_kind;

/* Where the field is constant + slope . x, but for `room`. */
typedef struct csg_slice_plane {
    double constant;
    float slope[3], room;
} csg_slice_plane;

typedef struct csg_slice_cube {
    uint32_t first; /* SPLIT: of its eight children; SMOOTH: its plane's index + 1, 0 = none */
    uint32_t tape;
    uint32_t square; /* of the layer at hand */
    uint8_t kind;    /* csg_slice_kind */
} csg_slice_cube;

typedef struct csg_slice_cubes {
    const csg_slice_plan *plan;
    csg_pruner pruner;
    csg_arena arena; /* nodes of tapes */
    csg_tape *tapes;
    size_t tape_count, tape_capacity;
    csg_slice_plane *planes;
    size_t plane_count, plane_capacity;
    csg_slice_cube *cubes; /* the first is the root */
    size_t count, capacity;
    size_t first_layer, end_layer; /* of the slab */
    uint64_t unsettled;
    float *scratch;
    size_t scratch_floats;
} csg_slice_cubes;

/* False: out of memory; release in any case. */
bool csg_slice_cubes_init(csg_slice_cubes *cubes, const csg_slice_plan *plan);
void csg_slice_cubes_release(csg_slice_cubes *cubes);

/* Of the slab of these layers; those of the last slab are gone. False: out of memory, or it was
 * stopped. */
bool csg_slice_cubes_make(csg_slice_cubes *cubes, size_t first_layer, size_t end_layer);

#endif
