/* SPDX-License-Identifier: MIT
 * S-bounds: boxes that contain each node's solid, cut by what its ancestors can show
 * (Cameron; the exact two-level scheme for soft blends of operators.md 3.5).
 */
#ifndef CSG_SCENE_BOUNDS_H
#define CSG_SCENE_BOUNDS_H

#include "scene/scene.h"

/* Levels and boxes of operators.md 3.5 for one node, in the node's own frame. */
typedef struct csg_node_bounds {
    double below, above; /* l, L: the value must be exact in [-l, L] */
    csg_box level_box;   /* O: contains {f >= -l} */
    /* B: outside it the node is < -l wherever its value matters. The node's value is at most
     * max(1, lambda) b_B - l, lambda that of the fields in it. */
    csg_box clamp_box;
} csg_node_bounds;

/* One entry per node of the scene, for the band `delta` >= 0 at the root; out has
 * scene->node_count entries. Unreachable nodes do not exist in a sealed scene. */
csgm_status csg_bounds_compute(const csgm_scene *scene, double delta, csg_node_bounds *out);

/* Fills scene->bounds of a scene whose other arrays are ready: each node's box in its own frame
 * without regard to its ancestors, except that the root's is cut to what the whole tree can show.
 */
csgm_status csg_bounds_fill(csgm_scene *scene);

/* Box of the solid {f >= 0}. Empty for an empty solid, infinite sides for an unbounded one. */
csg_box csg_bounds_of_solid(const csgm_scene *scene);

#endif
