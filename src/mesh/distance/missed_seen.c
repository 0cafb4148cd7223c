/* SPDX-License-Identifier: MIT
 * What the judge of cells saw, in place of a search; see missed.h.
 */
#include <string.h>

#include "mesh/distance/missed.h"

/* The nearest triangle of the surface; NONE: none is within the error. Those that close a part of a
 * mesh hide it seldom, near the part's border. */
static uint32_t nearest_triangle(const csg_remesh *r, csg_vec3 at, double error)
{
    uint32_t nearest = CSG_CORNER_NONE;
    csg_triangle_tree_nearest(&r->tree, at, error, &nearest);
    if (nearest == CSG_CORNER_NONE || nearest >= r->closing)
        return nearest;
    double least = error * error, weights[3];
    nearest = CSG_CORNER_NONE;
    for (uint32_t t = r->closing; t < r->corners.triangle_count; t++) {
        csg_vec3 v[3];
        csg_triangle_tree_corners(&r->tree, t, v);
        double square = csg_triangle_nearest(v, at, weights);
        if (square < least) {
            least = square;
            nearest = t;
        }
    }
    return nearest;
}

csgm_status csg_missed_take_seen(const csg_remesh *r, const csg_seen *seen, double error,
                                 csg_missed *out)
{
    *out = (csg_missed){0};
    for (size_t i = 0; i < seen->count; i++) {
        csg_vec3 at = csg_vec3_from_floats(seen->at[i]);
        csg_missed_point point = {.triangle = nearest_triangle(r, at, error)};
        if (point.triangle == CSG_CORNER_NONE)
            continue;
        memcpy(point.at, seen->at[i], sizeof point.at);
        if (!csg_memory_reserve(r->memory, (void **)&out->points, &out->capacity, out->count + 1,
                                sizeof point)) {
            csg_missed_release(out, r->memory);
            return csg_context_no_memory(r->context);
        }
        out->points[out->count++] = point;
    }
    return CSGM_OK;
}
