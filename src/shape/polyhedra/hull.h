/* SPDX-License-Identifier: MIT
 * Convex hull in space, by the Qhull library (hull.c, the only file that knows it).
 */
#ifndef CSG_SHAPE_HULL_H
#define CSG_SHAPE_HULL_H

#include "shape/polyhedra/triangles.h"

/* The hull of the points as outward triangles. CSGM_ERR_SCENE: all points lie in a plane.
 * CSGM_ERR_UNSUPPORTED: built without the library. The result does not depend on chance. */
csgm_status csg_hull(csg_memory *memory, const csg_vec3 *points, size_t count, csg_triangles *out);
/* Was the program built with the library? */
bool csg_hull_is_available(void);

#endif
