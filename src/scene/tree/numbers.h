/* SPDX-License-Identifier: MIT
 * What a number means as a blend: round(r) among solids that meet, which ends flush. Two rules on
 * top of round, which knows nothing but values, and so grew solids together that never meet, and
 * let faces swell that they have in common:
 *   - operands fall into groups: two are in one if they meet, or a chain of others leads from one
 *     to the other (operators/apart.h). Each group is blended by itself;
 *   - a group's union is cut by the half-spaces and cylinders that hold all of its operands and in
 *     which one of them has a face (operators/union_ends.h): what is curved may swell.
 * Of a difference the first operand's complement and those subtracted are grouped alike; nothing
 * is cut there, for a complement has no hull. An intersection is as with round(r), and so is
 * an operator with soft operands, whose fields say little about where they meet.
 *
 * All of it is said by nodes there are: sharp unions of round ones within sharp intersections.
 * These carry CSG_FLAG_NUMBER and CSG_FLAG_ENDED, so that the number is printed again, and colours
 * are those of the solids.
 */
#ifndef CSG_SCENE_NUMBERS_H
#define CSG_SCENE_NUMBERS_H

#include "scene/tree/build.h"

/* Primitives and operators of a sealed scene as its text has them: without what unions end at. */
void csg_numbers_count(const csgm_scene *scene, uint32_t *primitives, uint32_t *operators);

/* Whether the sealed scene has operators for which this is to be done. */
bool csg_numbers_are_pending(const csgm_scene *scene);

/* Two steps, each in the builder's tree, in place. `scene` is sealed from it as it is at the time
 * and has its bounds; its node i is the builder's origins[i]. Failures are noted in the builder,
 * but for CSGM_ERR_MEMORY. */
csgm_status csg_numbers_group(csg_scene_builder *builder, const csgm_scene *scene,
                              const csg_node_id *origins);
csgm_status csg_numbers_end(csg_scene_builder *builder, const csgm_scene *scene,
                            const csg_node_id *origins);

/* What the builder's tree was before both; its arrays have grown behind it. */
typedef struct csg_numbers_before {
    csg_node_id *ids;
    csg_node *nodes;
    size_t count, node_count, child_count, parameter_count, transform_count;
} csg_numbers_before;

/* In the scratch. CSGM_OK or CSGM_ERR_MEMORY (not reported). */
csgm_status csg_numbers_remember(const csg_scene_builder *builder, const csgm_scene *scene,
                                 const csg_node_id *origins, csg_arena *scratch,
                                 csg_numbers_before *before);
/* Leaves the builder as it was: what stands above a blend looks at the same tree, whether or not
 * somebody asked for its solid on the way. */
void csg_numbers_undo(csg_scene_builder *builder, const csg_numbers_before *before);

#endif
