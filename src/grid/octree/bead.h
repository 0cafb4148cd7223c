/* SPDX-License-Identifier: MIT
 * Thin tips come in beads between lattice points: points whose six neighbours all have the other
 * sign, so that marching cubes makes a piece of its own of each. A bead that the solid (or its
 * outside) reaches along a diagonal, and on which nothing but faces of one tip is to be seen, is
 * given the other sign: the piece disappears, and the tip is for the polygon below to reach.
 *
 * What is asked is the field's whole tape, at a few points around the bead, so every block that has
 * the point decides alike, pruned or not. A ball of its own is never lost: nothing reaches it.
 */
#ifndef CSG_GRID_BEAD_H
#define CSG_GRID_BEAD_H

#include "field/kernels/dispatch.h"
#include "grid/octree/lattice.h"

/* Longer tapes, and those with formulas, take too long to ask: their beads stay. */
enum { CSG_BEAD_MOST_NODES = 512 };

typedef struct csg_beads {
    const csg_kernel *kernel;
    const csg_tape *tape; /* the whole */
    const csg_lattice *lattice;
    float *scratch;
    size_t scratch_floats;
    uint64_t evaluations;
    int left; /* that may still be spent on the bead at hand */
} csg_beads;

/* Whether a lattice point is to be given the other sign. */
bool csg_bead_is(csg_beads *beads, const uint32_t at[3]);

#endif
