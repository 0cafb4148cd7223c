/* SPDX-License-Identifier: MIT
 * A field in pieces (field/taylor/tape_taylor.h) as a graph over a face of a cube: those that
 * may be the field over a patch fall along one axis there. Its surface is one piece's at every
 * point of the face; a patch over which more than one may be it is halved, and in the end what they
 * differ by is left open.
 */
#ifndef CSG_MEASURE_GRAPH_FIELD_H
#define CSG_MEASURE_GRAPH_FIELD_H

#include "field/taylor/tape_taylor.h"
#include "measure/graph_patch.h"

typedef struct csg_graph_field {
    csg_graph_base bases[CSG_TAYLOR_PIECES];                         /* of the same axes */
    csg_taylor conditions[CSG_TAYLOR_PIECES][CSG_TAYLOR_CONDITIONS]; /* in these axes */
    int condition_count[CSG_TAYLOR_PIECES];
    csg_graph_columns of[CSG_TAYLOR_PIECES]; /* all over the cube, unless they are crossed */
    int count;
} csg_graph_field;

/* A tape's field in the ball around the cube (csg_tape_taylor_pieces), without the pieces that it
 * is nowhere in the cube, and the conditions that hold all over it. */
bool csg_graph_field_pieces(const csg_tape *tape, const double c[3], double half,
                            csg_taylor_pieces *out);

/* The same of pieces that are valid in the cube already. False: none is left. */
bool csg_graph_field_keep(csg_taylor_pieces *f, double half);

/* Whether all of the cube is in the piece's solid, or outside of it, if that is told. */
csg_graph_columns csg_graph_field_state(const csg_taylor *f, double half);

/* For pieces that are valid in the cube and stay where they are. */
void csg_graph_field_begin(csg_graph_field *g, const csg_taylor_pieces *f, double half);

typedef struct csg_graph_visitor {
    void *user;
    /* What may be left open where it is not told which piece it is, of a first patch: of the
     * volume; of the surface's gradient, times the patch's area. */
    double enough, enough_turned;
    /* Patches which the surface crosses, by one piece and how far the surface may be from that.
     * Returns how large a part of the patch may show the surface. */
    double (*cross)(void *user, const csg_graph_base *g, const csg_graph_patch *q,
                    const csg_graph_room *off);
    /* Whose columns are in the solid. NULL: they do not matter. */
    void (*fill)(void *user, const csg_graph_base *g, const csg_graph_patch *q);
} csg_graph_visitor;

/* Over one of the first patches. *error: what is added is of the volume between the graph and the
 * surface, at most. False: the surface may not be a graph there. */
bool csg_graph_field_visit(const csg_graph_field *g, const csg_graph_patch *first,
                           const csg_graph_visitor *visitor, double *error);

#endif
