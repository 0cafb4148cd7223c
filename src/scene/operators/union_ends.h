/* SPDX-License-Identifier: MIT
 * Half-spaces that contain operands of a union (operators.md 16): what a ball fills that rolls
 * along some of them lies in their convex hull, so a blend ends where half-spaces do that hold
 * them all. Fillets end there, and what a number means (tree/numbers.h).
 */
#ifndef CSG_SCENE_UNION_ENDS_H
#define CSG_SCENE_UNION_ENDS_H

#include "scene/scene.h"

/* Of a union: operand k lies within csg_fillet_towards(ends[i], p) <= reaches[k * count + i]
 * (INFINITY: none is known). flush: how far all reach where one that reaches farthest has a face
 * there, plane or around the axis, and another is near enough to blend; else INFINITY, for nothing
 * swells there, or what does is round. */
typedef struct csg_union_ends {
    const csg_fillet_end *ends;
    const double *reaches, *flush;
    size_t count;
} csg_union_ends;

/* `ends` is valid until it returns; false: no memory. */
typedef bool csg_union_ends_take(void *user, csg_node_id id, const csg_union_ends *ends);

/* Finds what holds the operands of every union wanted, from the leaves up, of a sealed scene whose
 * bounds are known. CSGM_OK or CSGM_ERR_MEMORY (not reported). */
csgm_status csg_union_ends_find(const csgm_scene *scene, bool (*is_wanted)(const csg_node *node),
                                csg_union_ends_take *take, void *user);
/* Fills in those of fillets. */
csgm_status csg_fillet_planes_find(csgm_scene *scene);

#endif
