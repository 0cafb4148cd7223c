/* SPDX-License-Identifier: MIT
 * Figures of straight edges that sharp operators join become one outline, whose field is the true
 * distance on both sides and whose edges are those of the figure: a union of squares side by side
 * has no seams, and a plate with a thousand holes is one leaf. Curves, and what has a colour of its
 * own, stay as they are; corners move by the rounding of shape/plane/polygons.h, about 1e-9 of the
 * figure.
 */
#ifndef CSG_SCENE_UNITE_H
#define CSG_SCENE_UNITE_H

#include "scene/tree/build.h"

/* The flat node, or what takes its place; the node is consumed. Where the polygon library cannot do
 * it, or nothing would be left, the node stays. NONE: no memory. */
csg_node_id csg_unite(csg_scene_builder *builder, csg_node_id flat);

#endif
