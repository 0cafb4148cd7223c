/* SPDX-License-Identifier: MIT
 * A smooth field's surface over a face of a cube, in patches. With z along the axis that it faces
 * most, turned so that the solid is below, the model's polynomial F falls with z in a patch's
 * column and on to its root, if it does. Over the patch the surface is then the polynomial of third
 * order of the implicit function, but for its fourth derivatives, and the field's own surface is no
 * farther from that along z than what the model is off, over how fast F falls there: both are
 * bounded in a box around the patch's surface alone, which is far smaller than the cube.
 */
#ifndef CSG_MEASURE_GRAPH_PATCH_H
#define CSG_MEASURE_GRAPH_PATCH_H

#include "base/taylor.h"

enum {
    CSG_GRAPH_SIDE = 2,    /* first patches along a side of the face */
    CSG_GRAPH_HALVED = 3,  /* times at most, one that is cut */
    CSG_GRAPH_CLIPPED = 5, /* corners of a rectangle that is clipped, at most */
    CSG_GRAPH_POINTS = 3 * (CSG_GRAPH_CLIPPED - 2)
};

enum { CSG_GRAPH_XX, CSG_GRAPH_YY, CSG_GRAPH_XY };
enum { CSG_GRAPH_XXX, CSG_GRAPH_XXY, CSG_GRAPH_XYY, CSG_GRAPH_YYY };

/* Of the error that is there anyhow: what may be left open where patches are cut. */
static const double CSG_GRAPH_SHARE = 0.25;

/* Of what a cube may leave open: a first patch, for one such reason. */
static const double CSG_GRAPH_LEAST = 0.03;

/* The surface over a rectangle of the face, by its derivatives at the middle. */
typedef struct csg_graph_patch {
    double at[2], half[2];
    double z, g[2], bend[3], third[4];
} csg_graph_patch;

/* How far the field's surface is from these, over one of the first patches. */
typedef struct csg_graph_room {
    double most, mean; /* along z */
    double turned;     /* its gradient over the face */
    double turned_rms; /* root of the mean square of that; INFINITY: not known */
} csg_graph_room;

typedef struct csg_graph_base {
    const csg_taylor *f;
    csg_taylor p; /* the polynomial, z last */
    int axes[3];  /* of the field, which become x, y and z */
    double turn;  /* z is that times its axis */
    double half;
    double room; /* the model is off by no more anywhere in the cube */
} csg_graph_base;

/* What the patch's columns are. */
typedef enum csg_graph_columns {
    CSG_COLUMNS_EMPTY,
    CSG_COLUMNS_FULL,
    CSG_COLUMNS_CROSSED,
    CSG_COLUMNS_UNKNOWN
} csg_graph_columns;

/* Points and weights by which functions of second order are integrated over a part of a patch. */
typedef struct csg_graph_rule {
    double at[CSG_GRAPH_POINTS][2], weight[CSG_GRAPH_POINTS];
    int count;
} csg_graph_rule;

/* A model that is valid in the ball around the cube, in axes of which z is the one along which this
 * slope is steepest. */
void csg_graph_patch_turn(csg_graph_base *g, const csg_taylor *f, const double slope[3],
                          double half);

/* Another model in the same axes. */
csg_taylor csg_graph_patch_turned(const csg_graph_base *g, const csg_taylor *f);

/* The first patches: where they are. */
csg_graph_patch csg_graph_patch_first(double half, int i);

/* What its columns are in the cube; the surface, if they are crossed. */
csg_graph_columns csg_graph_patch_place(const csg_graph_base *g, csg_graph_patch *q,
                                        csg_graph_room *off);

/* How far the polynomial's parts reach from its value at the middle. */
double csg_graph_patch_line(const csg_graph_patch *q);
double csg_graph_patch_bend(const csg_graph_patch *q);
double csg_graph_patch_third(const csg_graph_patch *q);
double csg_graph_patch_area(const csg_graph_patch *q);

/* One half of it, along that axis, side: -1 or 1; the axis along which it bends more. */
csg_graph_patch csg_graph_patch_half(const csg_graph_patch *q, int axis, int side);
int csg_graph_patch_bent_axis(const csg_graph_patch *q);

/* Of the part where value + g . d > 0: the middles of the edges of its triangles. */
csg_graph_rule csg_graph_patch_rule(const csg_graph_patch *q, double value);

/* The integral of max(z - level, 0) over it; what is open of that is added to *open. */
double csg_graph_patch_above(const csg_graph_patch *q, double level, double *open);

/* Where the surface may be in the cube, at most; and where it is for certain, at least: `beyond` is
 * negative then. The linear part tells. */
double csg_graph_patch_shown(const csg_graph_base *g, const csg_graph_patch *q, double beyond);

/* All of it is seen in the cube, up to `more`. */
bool csg_graph_patch_is_whole(const csg_graph_base *g, const csg_graph_patch *q, double more);

#endif
