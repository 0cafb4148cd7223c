/* SPDX-License-Identifier: MIT
 * Places sorted along x, against which triangles are held; see unsure.h. There are few: some
 * hundred of a gear.
 */
#include "mesh/adaptive/unsure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "mesh/remesh/triangle.h"

typedef struct place {
    csg_vec3 at;
    bool is_near; /* the mesh */
} place;

static int compare_places(const void *a, const void *b)
{
    double x = ((const place *)a)->at.x, y = ((const place *)b)->at.x;
    return x < y ? -1 : x > y;
}

/* The rooms' places, sorted. NULL: out of memory. */
static place *gather(const csg_extraction *x, uint32_t rooms, size_t count)
{
    place *places = csg_memory_alloc(&x->context->memory, count * sizeof *places);
    size_t n = 0;
    for (uint32_t i = 0; places && i < rooms; i++) {
        const csg_judge_room *room = &x->judge->rooms[i];
        for (size_t k = 0; k < room->unsure_count; k++)
            places[n++] = (place){room->unsure[k], false};
    }
    if (places)
        qsort(places, count, sizeof *places, compare_places);
    return places;
}

/* The first place whose x is at least that. */
static size_t first_from(const place *places, size_t count, double x)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (places[middle].at.x < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void mark_near_triangle(place *places, size_t count, const csg_vec3 v[3], double reach)
{
    double weights[3];
    double low = fmin(v[0].x, fmin(v[1].x, v[2].x)) - reach;
    double high = fmax(v[0].x, fmax(v[1].x, v[2].x)) + reach;
    for (size_t i = first_from(places, count, low); i < count && places[i].at.x <= high; i++)
        if (!places[i].is_near && csg_triangle_nearest(v, places[i].at, weights) <= reach * reach)
            places[i].is_near = true;
}

static void mark_near_mesh(const csg_extraction *x, place *places, size_t count)
{
    const csgm_mesh *mesh = x->mesh;
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        csg_vec3 v[3];
        for (int k = 0; k < 3; k++) {
            const float *p = mesh->positions + 3 * (size_t)mesh->indices[3 * t + (uint64_t)k];
            v[k] = csg_vec3_sub(csg_vec3_from_floats(p), x->shift);
        }
        mark_near_triangle(places, count, v, x->farthest);
    }
}

/* False: there are no smaller cells. */
static bool want_divided(csg_bricks *b, csg_vec3 at)
{
    float point[3];
    unsigned cell[3], bit;
    csg_vec3_to_floats(point, at);
    uint32_t number = csg_bricks_leaf_at(b, point);
    if (number == CSG_BRICK_NONE || b->items[number].level == b->finest)
        return false;
    csg_brick *brick = &b->items[number];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] = point[axis] > csg_brick_coordinate(b, brick, axis, 1);
    bit = 1u << csg_brick_cell(cell[0], cell[1], cell[2]);
    brick->wanted |= (uint8_t)bit;
    brick->searched &= (uint8_t)~bit; /* what is in its place is searched again */
    return true;
}

csgm_status csg_unsure_check(csg_extraction *x, bool *any)
{
    CSG_ZONE(x->context, "unsure places");
    uint32_t rooms = csg_pool_threads(x->context->pool);
    size_t count = 0;
    *any = false;
    for (uint32_t i = 0; i < rooms; i++)
        count += x->judge->rooms[i].unsure_count;
    if (!count)
        return CSGM_OK;
    place *places = gather(x, rooms, count);
    if (!places)
        return csg_context_no_memory(x->context);
    mark_near_mesh(x, places, count);
    for (size_t i = 0; i < count; i++)
        if (!places[i].is_near && want_divided(x->bricks, places[i].at))
            *any = true;
    csg_memory_release(&x->context->memory, places, count * sizeof *places);
    for (uint32_t i = 0; i < rooms; i++)
        x->judge->rooms[i].unsure_count = 0;
    return CSGM_OK;
}
