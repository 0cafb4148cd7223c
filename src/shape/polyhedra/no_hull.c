/* SPDX-License-Identifier: MIT
 * Convex hulls in a build without Qhull.
 */
#include "shape/polyhedra/hull.h"

csgm_status csg_hull(csg_memory *memory, const csg_vec3 *points, size_t count, csg_triangles *out)
{
    (void)points;
    (void)count;
    csg_triangles_init(out, memory);
    return CSGM_ERR_UNSUPPORTED;
}

bool csg_hull_is_available(void)
{
    return false;
}
