/* SPDX-License-Identifier: MIT
 * Places sorted along x, against which triangles are held; see unsure.h. There are few: some
 * hundred of a gear.
 */
#include "mesh/adaptive/unsure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/rank_loop.h"
#include "base/trace.h"
#include "mesh/adaptive/extract.h"
#include "mesh/remesh/triangle.h"

typedef struct csg_unsure_place {
    csg_vec3 at;
    bool is_near; /* the mesh */
} place;

static int compare_places(const void *a, const void *b)
{
    double x = ((const place *)a)->at.x, y = ((const place *)b)->at.x;
    return x < y ? -1 : x > y;
}

/* The rooms' places behind each other, forgotten there; with ranks those of all, some of them
 * several times. CSGM_OK or why it ends (reported). */
static csgm_status gather(const csg_extraction *x, csg_records *out)
{
    csgm_context *context = x->context;
    csgm_status status = CSGM_OK;
    for (uint32_t i = 0; i < csg_pool_threads(context->pool) && status == CSGM_OK; i++) {
        csg_judge_room *room = &x->judge->rooms[i];
        if (!csg_records_add(&context->memory, out, room->unsure,
                             room->unsure_count * sizeof *room->unsure))
            status = csg_context_no_memory(context);
        room->unsure_count = 0;
    }
    if (!context->ranks)
        return status;
    csg_rank_pieces all;
    status = csg_ranks_gather(context, status, CSGM_ALL_RANKS, out->bytes, out->count, &all);
    csg_memory_release(&context->memory, out->bytes, out->capacity);
    *out = (csg_records){all.bytes, (size_t)all.total, (size_t)all.total};
    return status;
}

/* They, sorted. NULL: out of memory. */
static place *sort(csg_memory *memory, const csg_records *gathered, size_t count)
{
    place *places = csg_memory_alloc(memory, count * sizeof *places);
    for (size_t i = 0; places && i < count; i++) {
        places[i] = (place){.is_near = false};
        memcpy(&places[i].at, gathered->bytes + i * sizeof(csg_vec3), sizeof(csg_vec3));
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

csgm_status csg_unsure_begin(csg_extraction *x, csg_unsure *unsure)
{
    csg_memory *memory = &x->context->memory;
    csg_records gathered = {0};
    *unsure = (csg_unsure){0};
    csgm_status status = gather(x, &gathered);
    size_t count = gathered.count / sizeof(csg_vec3);
    if (status == CSGM_OK && count) {
        unsure->places = sort(memory, &gathered, count);
        unsure->count = unsure->places ? count : 0;
        status = unsure->places ? CSGM_OK : csg_context_no_memory(x->context);
    }
    csg_memory_release(memory, gathered.bytes, gathered.capacity);
    return status;
}

void csg_unsure_look(const csg_extraction *x, csg_unsure *unsure, const csgm_mesh *mesh)
{
    for (uint64_t t = 0; t < mesh->triangle_count && unsure->count; t++) {
        csg_vec3 v[3];
        for (int k = 0; k < 3; k++) {
            const float *p = mesh->positions + 3 * (size_t)mesh->indices[3 * t + (uint64_t)k];
            v[k] = csg_vec3_sub(csg_vec3_from_floats(p), x->shift);
        }
        mark_near_triangle(unsure->places, unsure->count, v, x->farthest);
    }
}

bool csg_unsure_end(csg_extraction *x, csg_unsure *unsure)
{
    bool any = false;
    for (size_t i = 0; i < unsure->count; i++)
        if (!unsure->places[i].is_near && want_divided(x->bricks, unsure->places[i].at))
            any = true;
    csg_memory_release(&x->context->memory, unsure->places, unsure->count * sizeof *unsure->places);
    *unsure = (csg_unsure){0};
    return any;
}

bool csg_unsure_add(csg_extraction *x, const csg_vec3 *places, size_t count)
{
    csg_judge_room *room = &x->judge->rooms[0];
    size_t all = room->unsure_count + count;
    if (!csg_memory_reserve(&x->context->memory, (void **)&room->unsure, &room->unsure_capacity,
                            all, sizeof *room->unsure))
        return false;
    if (count)
        memcpy(room->unsure + room->unsure_count, places, count * sizeof *places);
    room->unsure_count = all;
    return true;
}

/* ---- without the mesh --------------------------------------------------------------------------
 */

/* Marks the bricks whose leaves may have triangles within reach of a place. Steps are shorter than
 * the finest brick, so that none is passed over. */
static void mark_within_reach(const csg_extraction *x, csg_vec3 at, uint8_t *marks)
{
    const csg_bricks *b = x->bricks;
    double reach = x->farthest, brick = CSG_BRICK_EDGE * b->lattice->cell_size;
    int steps = (int)ceil(2 * reach / (0.9 * brick));
    for (int k = 0; k <= steps; k++)
        for (int j = 0; j <= steps; j++)
            for (int i = 0; i <= steps; i++) {
                csg_vec3 off =
                    csg_vec3_make(2.0 * i / steps - 1, 2.0 * j / steps - 1, 2.0 * k / steps - 1);
                float point[3];
                csg_vec3_to_floats(point, csg_vec3_add(at, csg_vec3_scale(off, reach)));
                uint32_t number = csg_bricks_leaf_at(b, point);
                if (number != CSG_BRICK_NONE)
                    marks[number] = 1;
            }
}

/* The triangles of the leaves around all places. CSGM_OK or why it ends (reported). */
static csgm_status extract_around(csg_extraction *x, const csg_unsure *unsure,
                                  csg_extracted_part *part)
{
    csg_memory *memory = &x->context->memory;
    const size_t bricks = x->bricks->count;
    uint8_t *marks = csg_memory_alloc(memory, bricks);
    uint32_t *leaves = csg_memory_alloc(memory, bricks * sizeof *leaves);
    csgm_status status = CSGM_ERR_MEMORY;
    if (marks && leaves) {
        size_t count = 0;
        memset(marks, 0, bricks);
        for (size_t i = 0; i < unsure->count; i++)
            mark_within_reach(x, unsure->places[i].at, marks);
        for (size_t i = 0; i < bricks; i++)
            if (marks[i])
                leaves[count++] = (uint32_t)i;
        status = csg_extract_part(x, leaves, count, part);
    } else {
        status = csg_context_no_memory(x->context);
    }
    csg_memory_release(memory, leaves, bricks * sizeof *leaves);
    csg_memory_release(memory, marks, bricks);
    return status;
}

csgm_status csg_unsure_check(csg_extraction *x, bool *any)
{
    CSG_ZONE(x->context, "unsure places");
    csg_unsure unsure;
    csg_extracted_part part = {0};
    uint64_t smooth = x->smooth;
    csgm_status status = csg_unsure_begin(x, &unsure);
    *any = false;
    if (status != CSGM_OK || !unsure.count)
        return status;
    status = extract_around(x, &unsure, &part);
    if (status == CSGM_OK)
        csg_unsure_look(x, &unsure, part.mesh);
    *any = csg_unsure_end(x, &unsure) && status == CSGM_OK;
    csg_extracted_part_release(&part);
    x->smooth = smooth; /* they are counted as the mesh is made */
    return status;
}
