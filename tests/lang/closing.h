/* SPDX-License-Identifier: MIT
 * Whether a point belongs to the closing of some solids by a ball of radius r: to what no ball of
 * that radius reaches which stays clear of all of them. Told for one point at a time, from exact
 * distances alone: a centre within r of the point is moved to where it is farthest from the nearest
 * solid, by sequential linear programming from several starts.
 */
#ifndef TESTS_LANG_CLOSING_H
#define TESTS_LANG_CLOSING_H

#include "scene/reference.h"

enum { CLOSING_MOST = 3 };

/* The operands of a scene's root, which are distances outside. */
typedef struct closing {
    const csgm_scene *scene;
    csg_reference_room room;
    csg_node_id operands[CLOSING_MOST], first[CLOSING_MOST];
    uint32_t count;
    double r;
} closing;

/* False: out of memory. */
bool closing_begin(closing *c, const csgm_scene *scene, double r);
void closing_end(closing *c);

/* Values and gradients of all operands. */
void closing_operands(closing *c, csg_vec3 p, csg_sample *out);
bool closing_holds(closing *c, csg_vec3 p);

#endif
