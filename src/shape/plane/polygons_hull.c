/* SPDX-License-Identifier: MIT
 * Convex hull in the plane: Andrew's monotone chain (1979).
 */
#include <stdlib.h>
#include <string.h>

#include "base/orient.h"
#include "shape/plane/polygons.h"

static int compare_points(const void *left, const void *right)
{
    const csg_vec2 *a = left, *b = right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

/* Adds a point behind the chain that begins at `from`, dropping what it makes dents of. */
static void extend(csg_outline *chain, size_t from, csg_vec2 point)
{
    while (chain->point_count >= from + 2 &&
           csg_orient_plane(chain->points[chain->point_count - 2],
                            chain->points[chain->point_count - 1], point) <= 0)
        chain->point_count--;
    chain->points[chain->point_count++] = point;
}

static bool chain_around(csg_outline *sorted, csg_outline *out)
{
    void *points = NULL;
    size_t count = sorted->point_count;
    /* each point is in the lower or the upper chain, the first in both */
    if (!csg_memory_reserve(out->memory, &points, &out->point_capacity, 2 * count + 1,
                            sizeof *out->points))
        return false;
    out->points = points;
    qsort(sorted->points, count, sizeof *sorted->points, compare_points);
    for (size_t i = 0; i < count; i++)
        extend(out, 0, sorted->points[i]);
    for (size_t from = out->point_count - 1, i = count - 1; i-- > 0;)
        extend(out, from, sorted->points[i]);
    return csg_outline_close(out);
}

csgm_status csg_polygons_hull(const csg_outline *in, csg_outline *out)
{
    csg_outline sorted;
    csg_outline_init(out, in->memory);
    csg_outline_init(&sorted, in->memory);
    for (size_t i = 0; i < in->point_count; i++) {
        if (!isfinite(in->points[i].x) || !isfinite(in->points[i].y))
            return CSGM_ERR_SCENE;
    }
    if (!in->loop_count)
        return CSGM_OK;
    bool is_room = csg_outline_append(&sorted, in) && chain_around(&sorted, out);
    csg_outline_release(&sorted);
    if (!is_room)
        csg_outline_release(out);
    return is_room ? CSGM_OK : CSGM_ERR_MEMORY;
}
