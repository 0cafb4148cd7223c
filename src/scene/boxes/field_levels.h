/* SPDX-License-Identifier: MIT
 * Levels of soft nodes and of operators that take fields: how far below its surface an operand
 * matters to one that is to be known down to a level.
 */
#ifndef CSG_SCENE_FIELD_LEVELS_H
#define CSG_SCENE_FIELD_LEVELS_H

#include "scene/scene.h"

/* t such that a SOFT node is >= -level only where its child is >= -t; INFINITY: everywhere. */
double csg_soft_level(const csgm_scene *scene, const csg_node *node, double level);
/* The same for operand number `index` of an operator that takes fields: a union is >= -level only
 * where one of its operands is >= -t, an intersection only where each is. */
double csg_field_level(const csgm_scene *scene, const csg_node *node, uint32_t index, double level);
/* Values of a child beyond -below and above make no difference to a SOFT node, or to an operator
 * that takes fields. */
void csg_field_band(const csgm_scene *scene, const csg_node *node, uint32_t index, double *below,
                    double *above);

#endif
