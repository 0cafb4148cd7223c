/* SPDX-License-Identifier: MIT
 * Growable lines; see polylines.h.
 */
#include "outline/polylines.h"

#include <string.h>

void csg_polylines_init(csg_polylines *lines, csg_memory *memory)
{
    *lines = (csg_polylines){.memory = memory};
    csg_outline_init(&lines->pen, memory);
}

void csg_polylines_release(csg_polylines *lines)
{
    csg_memory_release(lines->memory, lines->points, lines->point_capacity * sizeof *lines->points);
    csg_memory_release(lines->memory, lines->items, lines->capacity * sizeof *lines->items);
    csg_outline_release(&lines->pen);
    csg_polylines_init(lines, lines->memory);
}

void csg_polylines_clear(csg_polylines *lines)
{
    lines->point_count = lines->count = lines->pen.point_count = 0;
}

static bool same(csg_vec2 a, csg_vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

csgm_status csg_polylines_finish(csg_polylines *lines, bool closed)
{
    size_t added = lines->pen.point_count;
    while (closed && added > 1 && same(lines->pen.points[added - 1], lines->pen.points[0]))
        added--;
    lines->pen.point_count = 0;
    if (added < 2)
        return CSGM_OK;
    if (added > CSG_INPUT_MOST_POINTS - lines->point_count)
        return CSGM_ERR_LIMIT;
    void *points = lines->points, *items = lines->items;
    bool done = csg_memory_reserve(lines->memory, &points, &lines->point_capacity,
                                   lines->point_count + added, sizeof *lines->points);
    lines->points = points;
    done = done && csg_memory_reserve(lines->memory, &items, &lines->capacity, lines->count + 1,
                                      sizeof *lines->items);
    lines->items = items;
    if (!done)
        return CSGM_ERR_MEMORY;
    memcpy(lines->points + lines->point_count, lines->pen.points, added * sizeof *lines->points);
    lines->items[lines->count++] = (csg_polyline){lines->point_count, added, closed};
    lines->point_count += added;
    return CSGM_OK;
}

void csg_polylines_transform(csg_polylines *lines, size_t first_line, const csg_affine *map)
{
    size_t begin = first_line < lines->count ? lines->items[first_line].first : lines->point_count;
    for (size_t i = begin; i < lines->point_count; i++) {
        csg_vec2 p = lines->points[i];
        lines->points[i].x = map->m[0][0] * p.x + map->m[0][1] * p.y + map->t[0];
        lines->points[i].y = map->m[1][0] * p.x + map->m[1][1] * p.y + map->t[1];
    }
}
