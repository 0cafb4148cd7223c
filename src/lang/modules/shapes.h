/* SPDX-License-Identifier: MIT
 * What the modules of shapes share: flat and solid children, facets, and the ways from outlines and
 * triangles to nodes.
 */
#ifndef CSG_LANG_SHAPES_H
#define CSG_LANG_SHAPES_H

#include "lang/modules/modules.h"
#include "solid/operations.h"

/* ---- geometry (solid/) ----------------------------------------------------------------------
 * A job of that layer for this call, and its end: its reasons become findings, its steps are those
 * of the evaluation. */

csg_solid_job csg_shape_job(csg_module_call *call);
csg_node_id csg_shape_made(csg_module_call *call, const csg_solid_job *job, csg_node_id node);
/* By $fn, $fa, $fs and the scene's options. */
csg_facet_rule csg_facet_rule_now(const csg_eval *e);

/* ---- nodes ---------------------------------------------------------------------------------- */

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
/* The tight box of a node; false after a report. */
bool csg_shape_box(csg_module_call *call, csg_node_id node, csg_box *out);
/* A radius by itself or as a diameter. */
double csg_argument_radius(csg_module_call *call, uint32_t r, uint32_t d, double otherwise,
                           csg_range_kind range);
/* [x, y] or one number for both; false after a report. */
bool csg_argument_pair(csg_module_call *call, uint32_t index, double out[2]);

/* ---- children: flat figures or solids ------------------------------------------------------- */

/* Runs the children and leaves on the stack those that are flat (or solid), each statement's as one
 * part when `each`; tells of the others. The mark below them. */
size_t csg_shape_operands(csg_module_call *call, bool flat, bool each);
/* The same, united; EMPTY when there are none. */
csg_node_id csg_shape_children(csg_module_call *call, bool flat);

#endif
