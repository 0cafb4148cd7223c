/* SPDX-License-Identifier: MIT
 * Which solids of a blend do not meet. A blend looks at solids where they are, not at whether they
 * meet farther on: two balls side by side turn from each other by as much as a groove does, in a
 * ring around the gap between them, and grew together there. So operands that are proven to stay
 * apart do not blend with each other: in a fillet no such two, in what a number means (tree/
 * numbers.h) those between which no chain of others leads.
 *
 * Boxes say so, or cubes in which the Lipschitz constants of both leave no room for a common point.
 * Where neither does, the two may meet. What is found of two solids depends on how many operands
 * there are and on what it takes to ask them, not on their order.
 */
#ifndef CSG_SCENE_APART_H
#define CSG_SCENE_APART_H

#include "scene/scene.h"

typedef struct csg_apart_pair {
    uint32_t a, b; /* children */
    bool by_boxes; /* these are apart */
} csg_apart_pair;

/* What is known of an operator's operands; of a difference and an intersection, of the complements
 * of those that are not subtracted. */
typedef struct csg_apart {
    csg_node_id id;
    const csg_apart_pair *pairs; /* the first `apart` do not meet, the others may */
    size_t apart, count;         /* pairs of many operands that are out of reach are left out */
    double gap; /* no two meet: how far they are apart, roughly; else, or of many, INFINITY */
} csg_apart;

/* False: no memory. */
typedef bool csg_apart_take(void *user, const csg_apart *found);

/* Asks of every operator wanted, from the leaves up; the scene's bounds are known. CSGM_OK or
 * CSGM_ERR_MEMORY (not reported). */
csgm_status csg_apart_find(const csgm_scene *scene, bool (*is_wanted)(const csg_node *node),
                           csg_apart_take *take, void *user);

/* Fills in those of fillets, of a sealed scene whose bounds are known; the same. */
csgm_status csg_fillet_apart_find(csgm_scene *scene);

#endif
