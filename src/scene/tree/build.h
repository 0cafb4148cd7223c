/* SPDX-License-Identifier: MIT
 * The only way to make scene nodes: validates, simplifies what is free (nested transforms fold to
 * one, identity transforms and operators of one child vanish, nested sharp unions and intersections
 * flatten, empty operands go), and keeps the order "children before parents".
 *
 * Every csg_build_* returns the new node, an existing one, or CSG_NODE_NONE on failure: then
 * builder->status and builder->problem say why (bad parameter: CSGM_ERR_SCENE and one sentence
 * without a place, the caller has it; limits; memory). Children are consumed: each node may be used
 * once.
 */
#ifndef CSG_SCENE_BUILD_H
#define CSG_SCENE_BUILD_H

#include "scene/scene.h"

typedef struct csg_scene_builder {
    csgm_context *context;
    csgm_scene *scene; /* growing; arrays are from context->memory until csg_build_finish */
    size_t part_capacity, node_capacity, child_capacity, parameter_capacity, transform_capacity,
        look_capacity, formula_capacity, step_capacity, shape_capacity, warp_capacity,
        rule_capacity;
    bool has_numbers;            /* some blend was a number (numbers.h) */
    struct csg_figures *figures; /* flat ones that were made before (figures.h); or NULL */
    csgm_status status;          /* first failure, sticky */
    char problem[160];           /* one sentence about it, "" for memory */
} csg_scene_builder;

csgm_status csg_build_begin(csg_scene_builder *builder, csgm_context *context);
/* Drops everything; harmless after csg_build_finish. */
void csg_build_abandon(csg_scene_builder *builder);

csg_node_id csg_build_empty(csg_scene_builder *builder, csg_span where);
/* parameters as in primitives.def; checked: finite and in range. */
csg_node_id csg_build_primitive(csg_scene_builder *builder, csg_primitive_kind kind,
                                const double *parameters, csg_span where);
/* Those that other code asks for, without kinds.h: a ball around the origin, a block in its place,
 * the half-space of the points p with normal . p <= distance. */
csg_node_id csg_build_ball(csg_scene_builder *builder, double r, csg_span where);
csg_node_id csg_build_block(csg_scene_builder *builder, csg_box box, csg_span where);
csg_node_id csg_build_half_space(csg_scene_builder *builder, csg_vec3 normal, double distance,
                                 csg_span where);
/* Sphere-swept segment between any two points with radii >= 0, not both 0; a ball where one end
 * swallows the other. */
csg_node_id csg_build_capsule(csg_scene_builder *builder, csg_vec3 p1, csg_vec3 p2, double r1,
                              double r2, csg_span where);
/* Where a formula is meant, and what its maker says of it. */
typedef struct csg_field_domain {
    csg_box bounds;   /* formula.h: a finite box, or all of space */
    bool cut;         /* nothing outside of the bounds is inside */
    double lipschitz; /* stated: tried (csg_check_slope); 0: computed, which fails for formulas that
                         are too steep to tell */
    bool trusted;     /* the stated one holds where it can be neither proven nor refuted */
} csg_field_domain;

/* The solid where the formula is >= 0; steps as csg_formula_collect gives them. */
csg_node_id csg_build_field(csg_scene_builder *builder, const csg_formula_step *steps,
                            uint32_t count, const csg_field_domain *domain, csg_span where);
/* matrix must be invertible and finite. */
csg_node_id csg_build_transform(csg_scene_builder *builder, const csg_affine *matrix,
                                csg_node_id child, csg_span where);
/* The outermost colour holds, as in OpenSCAD. */
csg_node_id csg_build_color(csg_scene_builder *builder, csg_color color, csg_node_id child,
                            csg_span where);
/* Colour, material and part in one. */
csg_node_id csg_build_look(csg_scene_builder *builder, const csg_look *look, csg_node_id child,
                           csg_span where);
/* The child as a part of this name (parts.h says what becomes of it). */
csg_node_id csg_build_part(csg_scene_builder *builder, const char *name, csg_node_id child,
                           csg_span where);
/* kind: UNION, INTERSECTION or DIFFERENCE; any count, 0 gives EMPTY. EMPTY operands: of a union
 * or subtracted ones vanish; in an intersection or first of a difference they make it EMPTY. */
csg_node_id csg_build_operator(csg_scene_builder *builder, csg_node_kind kind, csg_blend blend,
                               const csg_node_id *children, size_t count, csg_span where);

/* The blend of a rule, for csg_build_operator and many of them; the same rule gives the same blend.
 * Checked: parameters in range, which the problem names. An ARC with points (in the frame of the
 * operands): two on the operands' surfaces where the transition ends, the first on the first's, and
 * more that the result's surface shall pass through; their angles are found when the operator is
 * built, which then takes two operands. NULL values, *out.kind SHARP: a failure. */
csg_blend csg_build_rule(csg_scene_builder *builder, const csg_rule *rule);
/* The blend max(f1, f2) + g(|f1 - f2|) for a formula g of x; *out: what is known of g. */
csg_blend csg_build_profile(csg_scene_builder *builder, const csg_formula_step *steps,
                            uint32_t count, csg_profile *out);
/* The child as a soft object. range 0: such that a ball, a tube or a torus becomes the classical
 * P(distance from the skeleton / R), and a superellipsoid P of its gauge; others need a range. */
csg_node_id csg_build_soft(csg_scene_builder *builder, csg_soft soft, csg_node_id child,
                           csg_span where);

/* ---- flat nodes, shapes and warps ------------------------------------------------------------
 * A flat node is a figure of the plane: its field does not depend on z and its box is infinite
 * there. CIRCLE, RECTANGLE, regions, and operators, transforms, colours and offsets of flat nodes
 * are flat. A transform of a flat node must keep the plane (last row and column of m are not looked
 * at; z is scaled so that the field stays a distance wherever the plane part is a similarity). */

bool csg_build_is_flat(const csg_scene_builder *builder, csg_node_id node);
/* Takes over one reference to the shape, also on failure. */
csg_node_id csg_build_shape(csg_scene_builder *builder, csg_shape *shape, csg_span where);
/* The child grown by r (shrunk where r < 0): its field plus r. Exact on exact distances. */
csg_node_id csg_build_offset(csg_scene_builder *builder, double r, csg_node_id child,
                             csg_span where);
/* The child between z = low and z = high. An exact distance where a flat child's is; a child that
 * is not flat (twisted) is cut sharply. */
csg_node_id csg_build_extrude(csg_scene_builder *builder, csg_node_id child, double low,
                              double high, csg_span where);
/* Half the thickness of the plate in a sheet, a polygon as skeleton, for its radius. */
#define CSG_SHEET_HALF 1e-6
/* A flat child where |z - middle| <= half: csg_build_extrude in the numbers of its nodes. */
csg_node_id csg_build_plate(csg_scene_builder *builder, csg_node_id child, double half,
                            double middle, csg_span where);
/* `warp` with the parameters given. Fails where csg_warp_settle says that it cannot be done. Cuts
 * what a warp does away from the solid. Sharp operators, colours and what more is below the warp
 * keep their meaning. */
csg_node_id csg_build_warp(csg_scene_builder *builder, const csg_warp *warp, csg_node_id child,
                           csg_span where);
/* The WARP node of csg_build_warp alone, nothing cut. */
csg_node_id csg_build_bare_warp(csg_scene_builder *builder, const csg_warp *warp, csg_node_id child,
                                csg_span where);
/* The node within a finite box: a sharp intersection. */
csg_node_id csg_build_cut(csg_scene_builder *builder, csg_node_id node, csg_box box,
                          csg_span where);
/* F(children), one to three of them, x, y, z of the formula being their fields (scene.h). slope: a
 * bound on the sum of the partial derivatives' sizes, raised to the one that is proven; 0:
 * computed, which fails for formulas that are too steep to tell. A largest or least of operands
 * that are named once each is a sharp operator. */
csg_node_id csg_build_combine(csg_scene_builder *builder, const csg_formula_step *steps,
                              uint32_t count, double slope, const csg_node_id *children,
                              size_t child_count, csg_span where);
/* kind: UNION, INTERSECTION or DIFFERENCE of solids, folded from the left, round by the radius
 * that the formula gives at a point (operators.md 19); outside of the operands' box it is as
 * at the nearest place in it. Fails where intervals do not show that it is finite and >= 0. */
csg_node_id csg_build_varying(csg_scene_builder *builder, csg_node_kind kind,
                              const csg_formula_step *steps, uint32_t count,
                              const csg_node_id *operands, size_t operand_count, csg_span where);
/* A deep copy; shapes and formulas are shared. */
csg_node_id csg_build_copy(csg_scene_builder *builder, csg_node_id node);
/* The box of the node's solid in its own frame (a bound, not always tight), as far as is known
 * while the scene is being built. */
csg_box csg_build_box(csg_scene_builder *builder, csg_node_id node);
/* Seals a copy of what stands below `node`; the builder goes on. */
csgm_status csg_build_snapshot(csg_scene_builder *builder, csg_node_id node, csgm_scene **out);

/* Seals the scene with this root: copies what is reachable into one arena and computes bounds.
 * dependencies are copied. On success the builder is empty again and *out is the caller's. */
csgm_status csg_build_finish(csg_scene_builder *builder, csg_node_id root,
                             const char *const *dependencies, size_t dependency_count,
                             csgm_scene **out);

#endif
