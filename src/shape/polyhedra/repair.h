/* SPDX-License-Identifier: MIT
 * Triangles as published -> a closed chain in a frame: on every edge as many triangles run one way
 * as the other. The steps, in order: round to the lattice and weld (repair_weld.c), drop what is
 * there twice, turn neighbours alike (repair_turn.c), fill holes (repair_holes.c), find the pieces
 * and turn the whole outwards (repair_pieces.c).
 */
#ifndef CSG_SHAPE_REPAIR_H
#define CSG_SHAPE_REPAIR_H

#include "shape/polyhedra/edges.h"
#include "shape/polyhedra/frame.h"
#include "shape/polyhedra/repairs.h"

typedef struct csg_chain {
    csg_triangle_frame frame;
    csg_triangles triangles; /* in the frame; those without area are gone */
    uint32_t *pieces;        /* per triangle; pieces share no edge */
    size_t piece_count;
    double *volumes; /* per piece, in the frame */
    uint32_t
        *welded; /* per point: its number among the places of the input's corners, in their order */
} csg_chain;

/* CSGM_ERR_SCENE: not finite, out of range, or nothing is left that bounds a volume.
 * `scratch` holds pieces, volumes and numbers; triangles are from `memory` and only there on
 * CSGM_OK. */
csgm_status csg_repair(csg_memory *memory, csg_arena *scratch, const csg_triangles *in,
                       csg_chain *out, csg_repairs *repairs);

/* ---- the steps; false is for memory ------------------------------------------------- */

/* Corners on the lattice, equal ones one; points that no triangle has are gone. */
bool csg_repair_weld(csg_arena *scratch, const csg_triangle_frame *frame, const csg_triangles *in,
                     csg_triangles *out, csg_repairs *repairs);
/* Points of open edges that nearly coincide become one. */
bool csg_repair_weld_rims(csg_arena *scratch, csg_triangles *triangles,
                          const csg_triangle_edges *edges, size_t *welded);
/* Triangles with two equal corners go, and of those with the same three corners all but one; where
 * they cancel each other, all of them, unless the model is made of such pairs throughout.
 * only_cancel: copies that run alike stay. */
bool csg_repair_drop(csg_arena *scratch, csg_triangles *triangles, bool only_cancel,
                     csg_repairs *repairs);
/* The edges are those of the triangles before; where any is flipped they no longer are. */
bool csg_repair_turn(csg_arena *scratch, csg_triangles *triangles, const csg_triangle_edges *edges,
                     size_t *flipped);
bool csg_repair_fill(csg_arena *scratch, csg_triangles *triangles, const csg_triangle_edges *edges,
                     csg_repairs *repairs);

/* Fills pieces and volumes. CSGM_ERR_SCENE: nothing is left. */
csgm_status csg_repair_pieces(csg_arena *scratch, const csg_triangle_edges *edges, csg_chain *chain,
                              csg_repairs *repairs);

/* Numbers the points in the order of the corners; points that no triangle has are gone. With the
 * frame of what is left (csg_repair sees to that) a chain that is repaired again stays as it is. */
bool csg_repair_number(csg_arena *scratch, csg_triangles *triangles);

/* Exactly on one line. */
bool csg_repair_is_flat(const csg_triangles *triangles, const uint32_t corners[3]);

/* A closed loop of needed edges -> triangles that have them. *effort goes down with the work. */
bool csg_repair_fill_loop(csg_arena *scratch, csg_triangles *triangles, uint32_t *loop,
                          size_t count, uint64_t *effort);

#endif
