/* SPDX-License-Identifier: MIT
 * The solid in a cube by a Taylor model of its field: along the axis that the surface faces most it
 * is a graph over the cube's face, and what is below is found with errors of sixth order where
 * planes (halves.h) leave sheets of fourth order.
 */
#ifndef CSG_MEASURE_GRAPH_H
#define CSG_MEASURE_GRAPH_H

#include "field/taylor/tape_taylor.h"
#include "measure/cut.h"

typedef struct csg_graph {
    double integrals[CSG_INTEGRALS]; /* of the solid in the cube, around the cube's centre */
    double error;                    /* of the volume */
    double first, second;            /* of the first and second moments */
    bool is_close; /* no more is open than is enough; else nothing of this is known */
} csg_graph;

/* f: in the ball around the cube. enough: what may be left open, and costs no more time; nothing is
 * found of a cube that leaves more. 0: as little as can be is. False: the surface may not be a
 * graph there. */
bool csg_graph_find(const csg_taylor_pieces *f, double half, double enough, csg_graph *out);

/* What the surface's area in the cube is beside its flow along the normal of planes of this
 * slope. */
bool csg_graph_excess(const csg_taylor_pieces *f, const double slope[3], double half, double enough,
                      double *least, double *most);

/* What the surface's area in the cube is at most, in faces of the cube, of any pieces whose
 * gradients stay near one vector all over the ball, by less than this share of it: no line along
 * the vector meets a piece's surface twice, so its area is no more than that of the cube as it is
 * seen along the vector, over the least cosine between the two. INFINITY: it is not known. */
double csg_graph_spread_most(const csg_taylor_pieces *f, double half, double stray_most);
/* The same as an area. */
double csg_graph_area_most(const csg_taylor_pieces *f, double half, double stray_most);

/* The models on the cube's face x_axis = side * half, side: -1, 1, or 0, which is the square
 * through its middle, as ones that do not depend on that axis. False: they are the field nowhere
 * there. */
bool csg_graph_section(const csg_taylor_pieces *f, double half, int axis, int side,
                       csg_taylor_pieces *out);

/* Of the cube's face x_axis = side * half, side: -1 or 1: the area of it that is in the
 * solid, within *error of *area. False: the surface may not be a graph there. */
bool csg_graph_face(const csg_taylor_pieces *f, double half, int axis, int side, double enough,
                    double *area, double *error);

/* Where a curve runs, in the frame of the cube of which its plane is a section. */
typedef struct csg_graph_turned {
    int across;    /* the axis along which nothing changes */
    int radius;    /* the axis along which the distance from the axis of revolution grows */
    double at;     /* that distance at the cube's centre */
    double enough; /* what may be left open; 0: as little as can be is */
} csg_graph_turned;

/* Of models that do not depend on an axis: the integral of the distance from the axis of revolution
 * along the surface's section. False: the surface may not be a graph there. */
bool csg_graph_arc(const csg_taylor_pieces *section, double half, const csg_graph_turned *turned,
                   double *least, double *most);

/* The same at most, of any pieces, as csg_graph_spread_most tells it. */
double csg_graph_arc_most(const csg_taylor_pieces *section, double half,
                          const csg_graph_turned *turned, double stray_most);

#endif
