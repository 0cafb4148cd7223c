/* SPDX-License-Identifier: MIT
 * What Taylor models promise at a point, and what a cube's graph promises against what its parts
 * do: 512 of them, which err by little of what the cube may. Bounds that are too narrow are found
 * by this, far below what points would show.
 */
#ifndef TEST_GRAPH_SUPPORT_H
#define TEST_GRAPH_SUPPORT_H

#include "field/taylor/tape_taylor.h"
#include "mesh/mesh_support.h"

/* The model's polynomial and its gradient at x, and how far the function may be from these. */
double graph_polynomial_at(const csg_taylor *f, const double x[3]);
void graph_gradient_at(const csg_taylor *f, const double x[3], double out[3]);
double graph_room_at(const csg_taylor *f, const double x[3]);
double graph_turn_at(const csg_taylor *f, const double x[3]);

/* Is x where the piece is the field: 1, it is; -1, it is not; 0, not told. */
int graph_is_there(const csg_taylor_piece *piece, const double x[3]);

/* A field, by its models in the ball around a cube. */
typedef struct graph_field {
    bool (*find)(const void *user, const double c[3], double half, csg_taylor_pieces *out);
    const void *user;
    uint64_t seed; /* for messages */
} graph_field;

/* The integrals of the solid in the cube; the area of its surface there. They fail the test where a
 * cube and its parts do not agree. False: there is no graph in the cube or a part of it. */
bool graph_try_integrals(const graph_field *f, const double c[3], double half);
bool graph_try_area(const graph_field *f, const double c[3], double half);

/* Every other time: models are of the scene's numbers, not of the tape's floats. */
void graph_take_numbers(mesh_case *m);

#endif
