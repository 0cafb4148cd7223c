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
    size_t node_capacity, child_capacity, parameter_capacity, transform_capacity, color_capacity,
        formula_capacity, step_capacity;
    csgm_status status; /* first failure, sticky */
    char problem[160];  /* one sentence about it, "" for memory */
} csg_scene_builder;

csgm_status csg_build_begin(csg_scene_builder *builder, csgm_context *context);
/* Drops everything; harmless after csg_build_finish. */
void csg_build_abandon(csg_scene_builder *builder);

csg_node_id csg_build_empty(csg_scene_builder *builder, csg_span where);
/* parameters as in primitives.def; checked: finite and in range. */
csg_node_id csg_build_primitive(csg_scene_builder *builder, csg_node_kind kind,
                                const double *parameters, csg_span where);
/* Sphere-swept segment between any two points with radii >= 0, not both 0; a ball where one end
 * swallows the other. */
csg_node_id csg_build_capsule(csg_scene_builder *builder, csg_vec3 p1, csg_vec3 p2, double r1,
                              double r2, csg_span where);
/* The solid where the formula is >= 0. steps as csg_formula_collect gives them; bounds: where the
 * formula is meant (formula.h), a finite box, or all of space; cut: and nothing outside of it is
 * inside. lipschitz 0: computed, which fails for formulas that are too steep to tell. */
csg_node_id csg_build_field(csg_scene_builder *builder, const csg_formula_step *steps,
                            uint32_t count, csg_box bounds, bool cut, double lipschitz,
                            csg_span where);
/* matrix must be invertible and finite. */
csg_node_id csg_build_transform(csg_scene_builder *builder, const csg_affine *matrix,
                                csg_node_id child, csg_span where);
/* The outermost colour holds, as in OpenSCAD. */
csg_node_id csg_build_color(csg_scene_builder *builder, csg_color color, csg_node_id child,
                            csg_span where);
/* kind: UNION, INTERSECTION or DIFFERENCE; any count, 0 gives EMPTY. EMPTY operands: of a union
 * or subtracted ones vanish; in an intersection or first of a difference they make it EMPTY. */
csg_node_id csg_build_operator(csg_scene_builder *builder, csg_node_kind kind, csg_blend blend,
                               const csg_node_id *children, size_t count, csg_span where);

/* Seals the scene with this root: copies what is reachable into one arena and computes bounds.
 * dependencies are copied. On success the builder is empty again and *out is the caller's. */
csgm_status csg_build_finish(csg_scene_builder *builder, csg_node_id root,
                             const char *const *dependencies, size_t dependency_count,
                             csgm_scene **out);

#endif
