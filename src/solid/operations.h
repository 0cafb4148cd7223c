/* SPDX-License-Identifier: MIT
 * What this layer makes: nodes and numbers come in, a node goes out. NONE: the job stopped
 * (solid.h). Nodes that come in are consumed, as by csg_build_*, and none is empty but where it
 * says so.
 */
#ifndef CSG_SOLID_OPERATIONS_H
#define CSG_SOLID_OPERATIONS_H

#include "shape/plane/polygons.h"
#include "solid/facets.h"

/* ---- of nodes (hull.c, minkowski.c, shadow.c, repeat.c) -------------------------------------- */

/* The convex hull, flat of what is flat; of the empty solid it is empty. */
csg_node_id csg_solid_hull(csg_solid_job *job, csg_node_id all);
/* The sum of two nodes of one dimension; empty where one is. */
csg_node_id csg_solid_minkowski(csg_solid_job *job, csg_node_id a, csg_node_id b);
/* What a solid covers of the plane z = 0, seen along z. */
csg_node_id csg_solid_shadow(csg_solid_job *job, csg_node_id solid);
/* counts[0] * counts[1] * counts[2] of the node, `cell` apart. */
csg_node_id csg_solid_repeat(csg_solid_job *job, csg_node_id node, csg_vec3 cell,
                             const uint32_t counts[3]);

/* ---- of figures (extrude.c, offset.c) -------------------------------------------------------- */

typedef struct csg_extrusion {
    double height, twist, scale[2]; /* at the top; twist in degrees, clockwise going up */
    uint32_t slices;                /* 0: as many as are needed */
} csg_extrusion;

/* The figure between z = 0 and z = height. */
csg_node_id csg_solid_extrude(csg_solid_job *job, const csg_facet_rule *rule, csg_node_id flat,
                              const csg_extrusion *s);
/* The figure turned about its y axis, which becomes z, from `start` on by `angle`, in degrees. It
 * lies on one side of the axis. */
csg_node_id csg_solid_revolve(csg_solid_job *job, const csg_facet_rule *rule, csg_node_id flat,
                              double angle, double start);
/* The same of a figure that is its own mirror image, or lies where x > 0. */
csg_node_id csg_solid_turn(csg_solid_job *job, csg_node_id flat, double angle, double start);
/* The figure grown by r, with round corners. */
csg_node_id csg_solid_offset_round(csg_solid_job *job, const csg_facet_rule *rule,
                                   csg_node_id child, double r);
/* The figure's polygons grown, with corners as told (csg_polygons_offset). */
csg_node_id csg_solid_offset_sharp(csg_solid_job *job, csg_node_id child, double by,
                                   csg_corner corner, double tolerance);

/* The figure without its holes: polygons. */
csg_node_id csg_solid_fill(csg_solid_job *job, csg_node_id child);

/* As high over the figure as the outline is far; straight: as far as the edges, moving inwards,
 * have come when they reach a point. */
csg_node_id csg_solid_roof(csg_solid_job *job, csg_node_id flat, bool straight);
/* The straight roof over a clean outline, which is released. */
csg_node_id csg_solid_straight_roof(csg_solid_job *job, csg_outline *clean);

/* ---- of numbers (tubes.c, periodic.c) -------------------------------------------------------- */

typedef struct csg_knot { /* of a skeleton */
    csg_vec3 at;
    double radius;
} csg_knot;

/* Along lines (degree 1) or Bezier curves that share their ends (2, 3). Not all radii are 0. */
csg_node_id csg_solid_tube(csg_solid_job *job, const csg_knot *knots, size_t count, int degree);
/* Along a Catmull-Rom curve through all knots. */
csg_node_id csg_solid_spline(csg_solid_job *job, const csg_knot *knots, size_t count, bool closed);
/* Balls of radius r around all points of a flat polygon, counted by the even-odd rule, in the plane
 * x, y of `frame`, which keeps lengths; the outline is released. */
csg_node_id csg_solid_sheet(csg_solid_job *job, csg_outline *outline, const csg_affine *frame,
                            double r);
enum { CSG_PATCH_MOST = 16 };

/* Control points of a tensor-product Bezier patch, row after row; 2 to CSG_PATCH_MOST of each. */
typedef struct csg_bezier_patch {
    const csg_vec3 *points;
    uint32_t rows, columns;
} csg_bezier_patch;

/* Few enough triangles are within a 500th of the radius of the patch. */
bool csg_solid_patch_fits(const csg_bezier_patch *patch, double r);
/* Balls of radius r around all points of a patch that fits; the field is within 2.1e-3 r of theirs.
 */
csg_node_id csg_solid_patch(csg_solid_job *job, const csg_bezier_patch *patch, double r);
/* A tube along a curve (scene/primitives/curve.h) as a union of capsules within 1e-4 of its largest
 * radius. */
csg_node_id csg_solid_capsules(csg_solid_job *job, csg_primitive_kind kind,
                               const double *parameters);

typedef enum csg_periodic_kind {
    CSG_PERIODIC_GYROID,
    CSG_PERIODIC_SCHWARZ_P,
    CSG_PERIODIC_DIAMOND
} csg_periodic_kind;

/* A wall along the surface, or with thickness 0 what is on one side of it. */
csg_node_id csg_solid_periodic(csg_solid_job *job, csg_periodic_kind kind, double cell,
                               double thickness);

#endif
