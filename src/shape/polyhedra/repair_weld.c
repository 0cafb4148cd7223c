/* SPDX-License-Identifier: MIT
 * Points at one place become one point, and triangles over the same three points one triangle:
 * both by a table of hashes. A second weld joins rims that miss each other by rounding
 * (a seam computed as sin(2 pi) on one side and 0 on the other): only points of open edges, within
 * 2^-20 of the frame.
 */
#include <string.h>

#include "base/places.h"
#include "shape/polyhedra/repair.h"

/* A table with room for `entries`, at least 1. */
static bool make_table(csg_table *table, csg_memory *memory, size_t entries)
{
    csg_table_init(table, memory);
    return csg_table_reserve(table, entries + 1, NULL, NULL);
}

/* ---- points -----------------------------------------------------------------------------------
 */

static csg_vec3 on_lattice(const csg_triangle_frame *frame, csg_vec3 p)
{
    csg_vec3 q = csg_triangle_frame_enter(frame, p);
    return csg_triangle_frame_round_point(q);
}

/* The number of this point; a new one when it was not there. */
static uint32_t find_point(csg_table *places, csg_triangles *out, csg_vec3 p)
{
    size_t slot;
    uint32_t found = csg_place_find(places, out->points, p, &slot);
    if (found != CSG_TABLE_NONE)
        return found;
    csg_table_put(places, slot, (uint32_t)out->point_count);
    out->points[out->point_count] = p;
    return (uint32_t)out->point_count++;
}

bool csg_repair_weld(csg_arena *scratch, const csg_triangle_frame *frame, const csg_triangles *in,
                     csg_triangles *out, csg_repairs *repairs)
{
    csg_table places;
    uint32_t *number = csg_arena_alloc(scratch, in->point_count * sizeof *number);
    void *points = NULL, *corners = NULL;
    if (!number || !csg_memory_reserve(out->memory, &points, &out->point_capacity, in->point_count,
                                       sizeof *out->points))
        return false;
    out->points = points;
    if (!csg_memory_reserve(out->memory, &corners, &out->capacity, in->count, sizeof *out->corners))
        return false;
    out->corners = corners;
    if (!make_table(&places, scratch->memory, in->point_count))
        return false;
    memset(number, 0xff, in->point_count * sizeof *number);
    for (size_t t = 0; t < in->count; t++) {
        for (int k = 0; k < 3; k++) {
            uint32_t corner = in->corners[t][k];
            if (number[corner] == UINT32_MAX) {
                size_t before = out->point_count;
                number[corner] = find_point(&places, out, on_lattice(frame, in->points[corner]));
                repairs->welded += before == out->point_count;
            }
            out->corners[t][k] = number[corner];
        }
    }
    out->count = in->count;
    csg_table_release(&places);
    return true;
}

/* ---- rims -------------------------------------------------------------------------------------
 */

static const double RIM_REACH = 0x1p-20;

typedef struct rims {
    const csg_triangles *triangles;
    csg_table cells;       /* the first of each cell, as an index into kept */
    uint32_t *kept, *next; /* points that stay, and the next in the same cell */
    size_t count;
} rims;

static csg_vec3 cell_of(csg_vec3 p)
{
    return csg_vec3_make(floor(p.x / RIM_REACH), floor(p.y / RIM_REACH), floor(p.z / RIM_REACH));
}

/* The first kept point of this cell; NONE: there is none, and *slot is where it would be. */
static uint32_t first_in_cell(const rims *r, csg_vec3 cell, size_t *slot)
{
    uint32_t i = csg_table_first(&r->cells, csg_place_hash(cell), slot);
    while (i != CSG_TABLE_NONE &&
           !csg_place_is_same(cell_of(r->triangles->points[r->kept[i]]), cell))
        i = csg_table_next(&r->cells, slot);
    return i;
}

static uint32_t near_in_cell(const rims *r, csg_vec3 cell, csg_vec3 p)
{
    size_t slot;
    for (uint32_t i = first_in_cell(r, cell, &slot); i != CSG_TABLE_NONE; i = r->next[i]) {
        csg_vec3 away = csg_vec3_sub(r->triangles->points[r->kept[i]], p);
        if (csg_vec3_dot(away, away) <= RIM_REACH * RIM_REACH)
            return r->kept[i];
    }
    return UINT32_MAX;
}

/* A point that stays and is near, or this one, which then stays. Those that stay are further apart
 * than the reach, so a cell has few of them. */
static uint32_t keep_or_find(rims *r, uint32_t point)
{
    csg_vec3 p = r->triangles->points[point], home = cell_of(p);
    for (int i = 0; i < 27; i++) {
        csg_vec3 cell = {home.x + i % 3 - 1, home.y + i / 3 % 3 - 1, home.z + i / 9 - 1};
        uint32_t found = near_in_cell(r, cell, p);
        if (found != UINT32_MAX)
            return found;
    }
    size_t slot;
    r->kept[r->count] = point;
    r->next[r->count] = first_in_cell(r, home, &slot);
    csg_table_put(&r->cells, slot, (uint32_t)r->count++);
    return point;
}

bool csg_repair_weld_rims(csg_arena *scratch, csg_triangles *triangles,
                          const csg_triangle_edges *edges, size_t *welded)
{
    enum { EDGES_PER_QUESTION = 1024 };
    size_t open = 0;
    for (size_t i = 0; i < edges->count; i++)
        open += edges->edges[i].count == 1;
    if (!open)
        return true;
    rims r = {.triangles = triangles,
              .kept = csg_arena_alloc(scratch, 2 * open * sizeof *r.kept),
              .next = csg_arena_alloc(scratch, 2 * open * sizeof *r.next)};
    uint32_t *number = csg_arena_alloc(scratch, triangles->point_count * sizeof *number);
    if (!r.kept || !r.next || !number || !make_table(&r.cells, scratch->memory, 2 * open))
        return false;
    memset(number, 0xff, triangles->point_count * sizeof *number);
    for (size_t i = 0; i < edges->count; i++) {
        if (i % EDGES_PER_QUESTION == 0 && csg_memory_has_ended(scratch->memory)) {
            csg_table_release(&r.cells);
            return false;
        }
        uint32_t ends[2] = {edges->edges[i].low, edges->edges[i].high};
        for (int k = 0; k < 2 && edges->edges[i].count == 1; k++) {
            if (number[ends[k]] == UINT32_MAX) {
                number[ends[k]] = keep_or_find(&r, ends[k]);
                *welded += number[ends[k]] != ends[k];
            }
        }
    }
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++)
            if (number[triangles->corners[t][k]] != UINT32_MAX)
                triangles->corners[t][k] = number[triangles->corners[t][k]];
    csg_table_release(&r.cells);
    return true;
}

/* ---- triangles --------------------------------------------------------------------------------
 */

/* Triangles over the same three corners. */
typedef struct alike {
    uint32_t corners[3]; /* rising */
    uint32_t first[3];   /* of the first of them, as they came: what stays begins where it did */
    bool is_rising;      /* the first one */
    int32_t net;         /* those that run as they rise, less those that run back */
    uint32_t count;
} alike;

/* True: the corners run as they rise, up to rotation. */
static bool sort_corners(const uint32_t in[3], uint32_t out[3])
{
    int least = in[0] < in[1] ? (in[0] < in[2] ? 0 : 2) : (in[1] < in[2] ? 1 : 2);
    uint32_t b = in[(least + 1) % 3], c = in[(least + 2) % 3];
    out[0] = in[least];
    out[1] = b < c ? b : c;
    out[2] = b < c ? c : b;
    return b < c;
}

static size_t gather(const csg_triangles *triangles, csg_table *places, alike *groups,
                     size_t *degenerate)
{
    size_t count = 0;
    for (uint32_t t = 0; t < triangles->count; t++) {
        uint32_t key[3];
        bool rising = sort_corners(triangles->corners[t], key);
        if (key[0] == key[1] || key[1] == key[2]) {
            ++*degenerate;
            continue;
        }
        size_t slot;
        uint64_t hash = csg_hash_word(csg_hash_word(csg_hash_word(0, key[0]), key[1]), key[2]);
        uint32_t group = csg_table_first(places, hash, &slot);
        while (group != CSG_TABLE_NONE && memcmp(groups[group].corners, key, sizeof key) != 0)
            group = csg_table_next(places, &slot);
        if (group == CSG_TABLE_NONE) {
            const uint32_t *first = triangles->corners[t];
            group = (uint32_t)count++;
            groups[group] =
                (alike){{key[0], key[1], key[2]}, {first[0], first[1], first[2]}, rising, 0, 0};
            csg_table_put(places, slot, group);
        }
        groups[group].net += rising ? 1 : -1;
        groups[group].count++;
    }
    return count;
}

/* How many of a group stay, and whether they run as their corners rise. */
static uint32_t copies_of(const alike *group, bool only_cancel, bool double_sided, bool *rising)
{
    *rising = group->net >= 0;
    uint32_t size = (uint32_t)(group->net < 0 ? -group->net : group->net);
    if (only_cancel)
        return size;
    return size || double_sided ? 1 : 0;
}

bool csg_repair_drop(csg_arena *scratch, csg_triangles *triangles, bool only_cancel,
                     csg_repairs *repairs)
{
    csg_table places;
    csg_arena_mark mark = csg_arena_get_mark(scratch);
    alike *groups = csg_arena_alloc(scratch, triangles->count * sizeof *groups);
    if (!groups || !make_table(&places, scratch->memory, triangles->count))
        return false;
    size_t count = gather(triangles, &places, groups, &repairs->degenerate), pairs = 0, kept = 0;
    csg_table_release(&places);
    for (size_t i = 0; i < count; i++)
        pairs += groups[i].net == 0;
    for (size_t i = 0; i < count; i++) {
        const alike *group = &groups[i];
        bool rising;
        uint32_t copies = copies_of(group, only_cancel, 2 * pairs > count, &rising);
        for (uint32_t k = 0; k < copies; k++) {
            uint32_t *to = triangles->corners[kept++];
            bool as_first = rising == group->is_rising;
            to[0] = group->first[0];
            to[1] = group->first[as_first ? 1 : 2];
            to[2] = group->first[as_first ? 2 : 1];
        }
        repairs->duplicate += only_cancel ? 0 : group->count - copies;
    }
    triangles->count = kept;
    csg_arena_release_to(scratch, mark);
    return true;
}
