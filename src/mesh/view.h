/* SPDX-License-Identifier: MIT
 * Arrays of others: what must hold of a view before its numbers are used.
 */
#ifndef CSG_MESH_VIEW_H
#define CSG_MESH_VIEW_H

#include <string.h>

#include "base/geometry.h"

/* Not finite = all bits of the exponent set. Integers, since the compiler may not reorder a sum of
 * floats into vectors. */
static inline bool csg_all_finite(const float *values, uint64_t count)
{
    const uint32_t exponent = 0x7F800000;
    uint32_t bad = 0;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        bad |= (bits & exponent) == exponent;
    }
    return !bad;
}

/* Positions and origin. */
static inline bool csg_view_is_finite(const csgm_mesh_view *view)
{
    return isfinite(view->origin.x + view->origin.y + view->origin.z) &&
           csg_all_finite(view->positions, 3 * view->vertex_count);
}

/* Of all vertices whose places are finite. */
static inline csg_box csg_view_bounds(const csgm_mesh_view *view)
{
    csg_box box = csg_box_empty();
    for (uint64_t v = 0; v < view->vertex_count; v++) {
        csg_vec3 p = csg_vec3_add(view->origin, csg_vec3_from_floats(view->positions + 3 * v));
        if (isfinite(p.x + p.y + p.z))
            box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

/* Each triangle names vertices that exist. */
static inline bool csg_view_is_in_range(const csgm_mesh_view *view)
{
    uint32_t largest = 0;
    for (uint64_t i = 0; i < 3 * view->triangle_count; i++)
        largest = view->indices[i] > largest ? view->indices[i] : largest;
    return !view->triangle_count || largest < view->vertex_count;
}

#endif
