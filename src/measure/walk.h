/* SPDX-License-Identifier: MIT
 * Cubes over a solid: a root, halved level by level, with the tapes that hold in each. Centres and
 * halves are exact as floats, so that a cube is what its numbers say.
 */
#ifndef CSG_MEASURE_WALK_H
#define CSG_MEASURE_WALK_H

#include <float.h>
#include <math.h>

#include "field/prune/prune.h"
#include "measure/axis.h"
#include "measure/halves.h"
#include "measure/symmetry.h"
#include "mesh/watch.h"

enum { CSG_MEASURE_DEEPEST = 16 /* levels below the root: 8 bits of half and these are a float */ };

typedef struct csg_measure_cube {
    double c[3], half; /* field frame */
    int level;
    csg_cell_state state;
    csg_tape tape; /* where the state is SURFACE */
} csg_measure_cube;

typedef struct csg_measure_worker {
    csg_pruner pruner;
    csg_arena arena;
    float *scratch;
    double enough; /* what one cube may leave open before it is divided (rounds.h); 0: it is not */
} csg_measure_worker;

typedef struct csg_measure_walk {
    csgm_context *context;
    const csgm_field *field;
    csg_tape tape;             /* of the field, with room for what it is symmetrical to */
    csg_tape_exact exact;      /* of the tape, but where images of cubes count (rounds.h) */
    csg_symmetries symmetries; /* of the solid, where there is a frontier */
    int axis;                  /* that all of it turns about, or CSG_AXIS_NONE */
    csg_mesh_watch *watch;
    const csg_kernel *kernel;
    csg_box bounds; /* of the solid, field frame */
    double half;    /* of the root */
    size_t scratch_floats;
    csg_measure_worker *workers;
    uint32_t worker_count;
    csg_arena tapes;         /* of the frontier */
    csg_measure_cube *cubes; /* the frontier: SURFACE cubes of one level, and INSIDE ones above */
    size_t count, capacity;
    float tau;
} csg_measure_walk;

/* Of the ball around a cube, for pruning by floats. */
static inline float csg_measure_radius(double half)
{
    return (float)(half * sqrt(3.0) * (1 + 4 * (double)FLT_EPSILON));
}

/* Bounds are finite and not empty. CSGM_OK, or why it was stopped (reported); release in any case.
 */
csgm_status csg_measure_walk_begin(csg_measure_walk *walk, csgm_context *context,
                                   const csgm_field *field, csg_mesh_watch *watch);
/* The same without a frontier, on any thread: cubes come from the root, on. False: out of memory,
 * not reported. */
bool csg_measure_walk_open(csg_measure_walk *walk, csgm_context *context, const csgm_field *field,
                           csg_mesh_watch *watch);
csg_measure_cube csg_measure_root(const csg_measure_walk *walk);
void csg_measure_walk_release(csg_measure_walk *walk);

/* The parent's octants; new tapes are in the arena. Those beyond the bounds are OUTSIDE. False: out
 * of memory. */
bool csg_measure_divide(const csg_measure_walk *walk, csg_measure_worker *worker,
                        const csg_measure_cube *parent, csg_arena *arena,
                        csg_measure_cube children[CSG_OCTANTS]);

/* The solid in the cube. It may become INSIDE or OUTSIDE. False: nothing is known. */
bool csg_measure_enclose(const csg_measure_walk *walk, csg_measure_worker *worker,
                         csg_measure_cube *cube, csg_halves *out);
/* What planes tell of the whole cube. */
void csg_measure_take_state(csg_measure_cube *cube, const csg_halves *halves);
/* The same by csg_halves_find_with_strays. */
bool csg_measure_enclose_with_strays(const csg_measure_walk *walk, csg_measure_worker *worker,
                                     csg_measure_cube *cube, csg_halves *out);

#endif
