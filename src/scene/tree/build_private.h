/* SPDX-License-Identifier: MIT
 * What the files that build nodes share; see build.h.
 */
#ifndef CSG_SCENE_BUILD_PRIVATE_H
#define CSG_SCENE_BUILD_PRIVATE_H

#include "scene/tree/build.h"

/* Notes the failure; NONE. */
csg_node_id csg_build_no_memory(csg_scene_builder *builder);
/* False after a failure, which is noted. */
bool csg_build_is_usable(csg_scene_builder *builder, csg_node_id child);
bool csg_build_reserve_node(csg_scene_builder *builder);
bool csg_build_reserve_children(csg_scene_builder *builder, size_t more);
bool csg_build_reserve_parameters(csg_scene_builder *builder, size_t more);
/* Room was made by the three above. A node whose children are all flat becomes flat, unless it is a
 * warp. */
csg_node_id csg_build_append(csg_scene_builder *builder, csg_node node, const csg_node_id *children,
                             size_t count);

/* A node of its own around the child, nothing folded. */
csg_node_id csg_build_append_transform(csg_scene_builder *builder, csg_affine matrix,
                                       csg_node_id child, csg_span where);
csg_node_id csg_build_append_look(csg_scene_builder *builder, const csg_look *look,
                                  csg_node_id child, csg_span where);
/* A formula of its own, its steps with it. */
bool csg_build_append_formula(csg_scene_builder *builder, const csg_formula_step *steps,
                              const csg_formula *formula);
/* An operator as it stands, nothing simplified; `range` counts where the blend takes fields. */
csg_node_id csg_build_append_operator(csg_scene_builder *builder, csg_node_kind kind,
                                      csg_blend blend, double range, const csg_node_id *children,
                                      size_t count, csg_span where);
/* Range and angles of a rule for these operands; *blend may become another. */
bool csg_build_settle_rule(csg_scene_builder *builder, csg_node_kind kind, csg_blend *blend,
                           const csg_node_id *operands, size_t count, double *range);
/* The width beyond which a blend that was made here leaves operands as they are; INFINITY for some.
 */
double csg_build_support(const csg_scene_builder *builder, csg_blend blend);
/* Soft operands of a union, and those that are subtracted, get an end where a blend of lengths
 * would reach beyond their field's plateau: `operands` are replaced. Figures are left as they are.
 * False: a failure, which is noted. */
bool csg_build_end_plateaus(csg_scene_builder *builder, csg_node_kind kind, double support,
                            csg_node_id *operands, size_t count);
/* csg_build_combine with a slope that is known to hold. */
csg_node_id csg_build_combine_known(csg_scene_builder *builder, const csg_formula_step *steps,
                                    uint32_t count, double slope, const csg_node_id *children,
                                    size_t child_count, csg_span where);
/* Two nodes joined by a profile: a combine node. */
csg_node_id csg_build_profiled(csg_scene_builder *builder, csg_node_kind kind, csg_blend blend,
                               csg_node_id a, csg_node_id b, csg_span where);

#endif
