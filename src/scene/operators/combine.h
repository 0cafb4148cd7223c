/* SPDX-License-Identifier: MIT
 * Fields combined by a formula (CSG_NODE_COMBINE, scene.h).
 */
#ifndef CSG_SCENE_COMBINE_H
#define CSG_SCENE_COMBINE_H

#include "scene/scene.h"

/* Children of a node, each a variable of its formula. */
enum { CSG_COMBINE_MOST = CSG_FORMULA_MOST_VARIABLES };

/* How a node's formula goes with its operands. */
typedef struct csg_combine {
    const csgm_scene *scene;
    const csg_formula *formula;
    uint32_t operands;
    int trends[CSG_COMBINE_MOST]; /* csg_formula_trends */
    csg_formula_dual *work;       /* NULL: no memory, and nothing is known */
    size_t bytes;
} csg_combine;

void csg_combine_begin(csg_combine *combine, const csgm_scene *scene, const csg_node *node);
void csg_combine_end(csg_combine *combine);

/* t >= 0 such that the node is above -level only where a child that the formula rises with is above
 * -t; INFINITY when none is found. */
double csg_combine_inner_level(const csg_combine *combine, double level);

#endif
