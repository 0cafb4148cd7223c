/* SPDX-License-Identifier: MIT
 * Half-spaces that contain operands of a union (operators.md 16): what a ball fills that rolls
 * along some of them lies in their convex hull, so a blend ends where half-spaces do that hold
 * them all. Fillets end there, and what a number means (tree/numbers.h).
 */
#ifndef CSG_SCENE_FILLET_PLANES_H
#define CSG_SCENE_FILLET_PLANES_H

#include "scene/scene.h"

/* `ends` is valid until it returns; false: no memory. */
typedef bool csg_union_ends_take(void *user, csg_node_id id, const csg_fillet_planes *ends);

/* Finds what holds the operands of every union wanted, from the leaves up, of a sealed scene whose
 * bounds are known. CSGM_OK or CSGM_ERR_MEMORY (not reported). */
csgm_status csg_union_ends_find(const csgm_scene *scene, bool (*is_wanted)(const csg_node *node),
                                csg_union_ends_take *take, void *user);
/* Fills in those of fillets. */
csgm_status csg_fillet_planes_find(csgm_scene *scene);

#endif
