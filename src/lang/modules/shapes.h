/* SPDX-License-Identifier: MIT
 * What the modules of shapes share: flat and solid children, facets, and the ways from outlines and
 * triangles to nodes.
 */
#ifndef CSG_LANG_SHAPES_H
#define CSG_LANG_SHAPES_H

#include "lang/modules/modules.h"
#include "shape/plane/outline.h"
#include "shape/polyhedra/triangles.h"

/* ---- nodes (shapes.c) ----------------------------------------------------------------------- */

/* The node as the module's result: failures are told. */
csg_node_id csg_shape_done(csg_module_call *call, csg_node_id node);
csg_node_id csg_shape_empty(csg_module_call *call);
csg_node_id csg_shape_moved(csg_module_call *call, csg_node_id node, const csg_affine *by);
/* The region of a clean outline, which is released; nothing inside: the empty solid, told. */
csg_node_id csg_shape_region(csg_module_call *call, csg_outline *clean);
/* The area of any outline (released) by the even-odd or the winding rule. */
csg_node_id csg_shape_area(csg_module_call *call, csg_outline *outline, bool even_odd);
/* The solid of the triangles, which are released; `told`: what was mended is a warning. */
csg_node_id csg_shape_solid(csg_module_call *call, csg_triangles *triangles, bool told);
/* A tube along a curve (scene/primitives/curve.h) as a union of capsules within 1e-4 of its largest
 * radius. */
csg_node_id csg_shape_capsules(csg_module_call *call, csg_node_kind kind, const double *parameters);
/* A failure of csg_polygons_*, csg_hull and the like. `what` completes "cannot ...". Returns the
 * empty solid. */
csg_node_id csg_shape_failed(csg_module_call *call, csgm_status status, const char *what);
/* A radius by itself or as a diameter. */
double csg_argument_radius(csg_module_call *call, uint32_t r, uint32_t d, double otherwise,
                           csg_range_kind range);
/* [x, y] or one number for both; false after a report. */
bool csg_argument_pair(csg_module_call *call, uint32_t index, double out[2]);

/* ---- children: flat figures or solids ------------------------------------------------------- */

bool csg_shape_is_empty(const csg_eval *e, csg_node_id node);
bool csg_shape_is_flat(const csg_eval *e, csg_node_id node); /* false for the empty solid */
/* Of the parts above `first`, keeps those of the first one's dimension; warns of the others. */
void csg_shape_keep_alike(csg_eval *e, size_t first, csg_span where);
/* Runs the children and leaves on the stack those that are flat (or solid), each statement's as one
 * part when `each`; tells of the others. The mark below them. */
size_t csg_shape_operands(csg_module_call *call, bool flat, bool each);
/* The same, united; EMPTY when there are none. */
csg_node_id csg_shape_children(csg_module_call *call, bool flat);
/* A scene that is a figure of the plane becomes a plate of thickness 1, told. */
csg_node_id csg_shape_of_scene(csg_eval *e, csg_node_id node, csg_span where);

/* ---- facets (facets.c) ---------------------------------------------------------------------- */

/* The value of $fn, $fa or $fs, `otherwise` where it is no number. */
double csg_special_number(const csg_eval *e, const char *name, double otherwise);
/* Edges of a circle of this radius by $fn, $fa and $fs, as OpenSCAD counts them. */
uint32_t csg_fragments(const csg_eval *e, double radius);
/* The same where facets are asked for ($fn from 3 to 16, or the option for all of them), else 0:
 * round. */
uint32_t csg_facets(const csg_eval *e, double radius);
bool csg_facets_are_exact(const csg_eval *e);
double csg_cosine_deg(double degrees); /* exact for multiples of 90 */
double csg_sine_deg(double degrees);
/* Nodes in place of CIRCLE, of a frustum between z = -half and half, of SPHERE. */
csg_node_id csg_faceted_circle(csg_module_call *call, double radius, uint32_t count);
csg_node_id csg_faceted_frustum(csg_module_call *call, const double radii[2], double half,
                                uint32_t count);
csg_node_id csg_faceted_sphere(csg_module_call *call, double radius, uint32_t count);

#endif
