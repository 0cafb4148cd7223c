/* SPDX-License-Identifier: MIT
 * The zero contour of a scene in the plane z = 0, as loops.
 */
#ifndef CSG_SCENE_TRACE_H
#define CSG_SCENE_TRACE_H

#include "scene/scene.h"

/* Loops around {f >= 0}: outer ones counter-clockwise, holes clockwise, none crosses another.
 * `cells`: a power of two, along the longer side of the scene's box. *out is initialised and filled
 * on CSGM_OK, else left empty. CSGM_ERR_SCENE: the box is not finite. */
csgm_status csg_trace(const csgm_scene *scene, uint32_t cells, csg_outline *out);

#endif
