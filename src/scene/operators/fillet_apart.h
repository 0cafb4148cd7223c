/* SPDX-License-Identifier: MIT
 * Which solids of a fillet do not meet. A fillet looks at faces where they are, not at whether they
 * meet farther on: two balls side by side turn from each other by as much as a groove does, in a
 * ring around the gap between them, and grew together there. So operands that are proven to stay
 * apart do not blend with each other, whatever else they blend with.
 *
 * Boxes say so, or cubes in which the Lipschitz constants of both leave no room for a common point.
 * Where neither does, the two may meet. What is found of two solids depends on how many operands
 * there are and on what it takes to ask them, not on their order.
 */
#ifndef CSG_SCENE_FILLET_APART_H
#define CSG_SCENE_FILLET_APART_H

#include "scene/scene.h"

/* Fills them in, of a sealed scene whose bounds are known. CSGM_OK or CSGM_ERR_MEMORY (not
 * reported). */
csgm_status csg_fillet_apart_find(csgm_scene *scene);

#endif
