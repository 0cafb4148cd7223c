/* SPDX-License-Identifier: MIT
 * A flat figure as a drawing (shape/plane/drawing.h), a layer for each part's name and colour, in
 * the order in which the scene makes them. A layer is what stands below its name and colour, as far
 * as both reach the root through sharp unions, transforms and other looks only (as parts of solids
 * do, scene/tree/parts.h). Polygons as csg_flatten makes them.
 */
#ifndef CSG_SCENE_DRAW_LAYERS_H
#define CSG_SCENE_DRAW_LAYERS_H

#include "scene/tree/build.h"
#include "shape/plane/drawing.h"

/* From the context's memory; what encloses nothing makes no layer, so there may be none. The flat
 * node stays as it is. Status as of csg_flatten; *out is NULL unless CSGM_OK. */
csgm_status csg_draw_layers(csg_scene_builder *builder, csg_node_id flat, double tolerance,
                            csg_drawing **out);

#endif
