/* SPDX-License-Identifier: MIT
 * What looking at a cube or at a piece of a triangle costs, counted by its tape and not by a clock,
 * so that work that has to end somewhere ends at the same place everywhere. Gradients of long tapes
 * are not known (slopes.h): what has such is cut to the end, and each part takes longer. A limit on
 * the number of parts alone let blends of 40 balls run for hours.
 */
#ifndef CSG_MESH_DISTANCE_EFFORT_H
#define CSG_MESH_DISTANCE_EFFORT_H

#include <string.h>

#include "field/kernels/kernel.h"

/* 1 of a short tape. A shape is searched anew for each place. */
static inline uint64_t csg_effort_of(const csg_tape *tape)
{
    enum { SHORT_NODES = 16, NODES_OF_SHAPE = 8 };
    uint64_t nodes = tape->count;
    for (uint32_t i = 0; i < tape->count; i++)
        nodes += tape->nodes[i].op == CSG_OP_SHAPE ? NODES_OF_SHAPE - 1 : 0;
    return (nodes + SHORT_NODES - 1) / SHORT_NODES;
}

/* Whether one walk over a tape does for both. */
static inline bool csg_tape_is_same(const csg_tape *a, const csg_tape *b)
{
    return a->count == b->count &&
           (a->nodes == b->nodes || !memcmp(a->nodes, b->nodes, a->count * sizeof *a->nodes));
}

#endif
