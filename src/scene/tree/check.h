/* SPDX-License-Identifier: MIT
 * The builder's checks: false, and one sentence in builder->problem, for what no scene may hold.
 */
#ifndef CSG_SCENE_CHECK_H
#define CSG_SCENE_CHECK_H

#include "scene/primitives/sizes.h"
#include "scene/tree/build.h"

/* The first failure stays. */
void csg_check_fail(csg_scene_builder *builder, csgm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* values as in primitives.def; a plane's normal becomes a unit vector, a gauge's constant is
 * found. */
bool csg_check_primitive(csg_scene_builder *builder, csg_primitive_kind kind, double *values);
bool csg_check_field(csg_scene_builder *builder, const csg_formula_step *steps, uint32_t count,
                     csg_box bounds, double lipschitz);
/* The formula's Lipschitz constant: the bound that was found where none is stated (0); else the
 * stated one if it is proven, trusted, or nothing is known, an error where it is refuted, and else
 * the larger one of both. A tiny one is raised. */
bool csg_check_slope(csg_scene_builder *builder, double stated, const csg_slope_trial *trial,
                     csg_formula *formula);
/* Of a capsule. */
bool csg_check_ends(csg_scene_builder *builder, csg_vec3 p1, csg_vec3 p2, double r1, double r2);
bool csg_check_matrix(csg_scene_builder *builder, const csg_affine *matrix);
/* A blend without width becomes sharp. */
bool csg_check_operator(csg_scene_builder *builder, csg_node_kind kind, csg_blend *blend);
bool csg_check_offset(csg_scene_builder *builder, double r);
/* The numbers given, and that warps do not nest too deeply. */
bool csg_check_warp(csg_scene_builder *builder, const csg_warp *warp, csg_node_id child);
bool csg_check_look(csg_scene_builder *builder, const csg_look *look);

#endif
