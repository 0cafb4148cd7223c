/* SPDX-License-Identifier: MIT
 * Pruning: which part of a tape can matter in a cell. Inside the band |f| <= tau no bit of a value
 * changes, outside it no sign does, so pruned and unpruned runs write the same file.
 *
 * A cell is a cube. Primitives give their range over it: exactly where they fall outwards along the
 * axes, over the ball around it otherwise (Lipschitz constant 1: value at the centre +- radius),
 * expression fields by interval arithmetic (formula_kernel.h); composed bottom-up through the
 * operators; a demand interval goes top-down: the root's value matters in
 * [-tau, tau]; an operand that stays below (above) what can matter through a union (intersection),
 * or below the largest sibling by the blend's support, is dropped. Shapes are pruned alike: what of
 * their geometry can be nearest to a point of the cell, as far as distances matter there, is listed
 * with the leaf (csg_shape_near).
 */
#ifndef CSG_FIELD_PRUNE_H
#define CSG_FIELD_PRUNE_H

#include "field/kernels/kernel.h"

typedef enum csg_cell_state { CSG_CELL_OUTSIDE, CSG_CELL_INSIDE, CSG_CELL_SURFACE } csg_cell_state;

/* A finished subtree of the shorter tape. */
typedef struct csg_emitted {
    uint32_t root, begin;
    uint32_t source; /* its root in the longer tape */
} csg_emitted;

/* Working arrays of one thread. */
typedef struct csg_pruner {
    csg_memory *memory;
    const csg_kernel *kernel;
    float rounding; /* slack of lengths: rounding error of any distance in the lattice */
    float center[3][CSG_OCTANTS], radius; /* of the last csg_prune_octants, rounding included */
    float slack;       /* of comparisons: the same of leaves' values; operators' own rounding is in
                          their intervals */
    float *low, *high; /* of every node, eight lanes; later the demands on operators; of shapes,
                          what csg_shape_demand has */
    float *turns;      /* of every node, where the tape has fillets: csg_kernel.intervals */
    uint8_t *dropped;  /* a bit for each octant */
    uint8_t dropped_any;
    bool has_shapes;
    float tau; /* half width of the band; what wavers included */
    bool decided;
    csg_emitted *stack;
    csg_tape_node *nodes; /* the shorter tape */
    float *scratch;
    size_t capacity; /* nodes the arrays hold */
    size_t scratch_capacity;
    const csg_tape *tape; /* of the last csg_prune_octants */
} csg_pruner;

void csg_pruner_init(csg_pruner *pruner, csg_memory *memory, const csg_kernel *kernel,
                     float rounding);
void csg_pruner_release(csg_pruner *pruner);

/* Intervals of the whole tape over eight cubes, given by the balls around them. False: out of
 * memory. */
bool csg_prune_octants(csg_pruner *pruner, const csg_tape *tape, const float cx[CSG_OCTANTS],
                       const float cy[CSG_OCTANTS], const float cz[CSG_OCTANTS], float radius);

/* The same of one cube, as octant 0. */
bool csg_prune_cube(csg_pruner *pruner, const csg_tape *tape, const float center[3], float radius);

/* What the last call found about one of the cubes. */
csg_cell_state csg_prune_state(const csg_pruner *pruner, int octant);

/* The tape for that cube: *out is the same one where nothing could
 * be dropped, else a shorter one in the arena. tau: half width of the band, the same for all eight.
 * False: out of memory. */
bool csg_prune_shorten(csg_pruner *pruner, int octant, float tau, csg_arena *arena, csg_tape *out);

/* Copies a tape's nodes, so that they no longer depend on the arena they came from. False: out of
 * memory. */
bool csg_prune_copy(csg_tape *tape, csg_arena *arena);

#endif
