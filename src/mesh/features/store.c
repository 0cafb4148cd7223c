/* SPDX-License-Identifier: MIT
 * All features of a mesh, block by block in Morton order, and how they hang together: which side of
 * a polygon leads to which other one, and whether the segment between them is flipped.
 */
#include <string.h>

#include "mesh/features/cut.h"
#include "mesh/features/face.h"
#include "mesh/features/features.h"

enum { E = CSG_BLOCK_EDGE };

/* Room for so many more of both. */
static bool reserve(csg_feature_store *store, size_t features, size_t blocks)
{
    return csg_memory_reserve(store->memory, (void **)&store->blocks, &store->block_capacity,
                              store->block_count + blocks, sizeof(csg_feature_block)) &&
           csg_memory_reserve(store->memory, (void **)&store->features, &store->capacity,
                              store->count + features, sizeof(csg_feature));
}

bool csg_feature_store_add(csg_feature_store *store, const csg_feature_room *room, size_t first,
                           size_t count)
{
    if (!count)
        return true;
    const csg_feature_block *blocks = room->blocks + first;
    size_t from = blocks[0].first;
    size_t features = blocks[count - 1].first + blocks[count - 1].count - from;
    if (!reserve(store, features, count))
        return false;
    memcpy(store->features + store->count, room->features + from,
           features * sizeof *store->features);
    for (size_t i = 0; i < count; i++) {
        csg_feature_block entry = blocks[i];
        entry.first = (uint32_t)(store->count + entry.first - from);
        store->blocks[store->block_count++] = entry;
    }
    store->count += features;
    return true;
}

bool csg_feature_store_take_lists(csg_feature_store *store, csg_feature_room *room)
{
    bool taken = csg_memory_reserve(store->memory, (void **)&store->taken, &store->taken_capacity,
                                    store->taken_count + 1, sizeof *store->taken);
    if (taken) {
        store->taken[store->taken_count++] = room->lists;
        csg_arena_init(&room->lists, store->memory);
    }
    csg_feature_room_empty(room);
    return taken;
}

void *csg_feature_store_pack(const csg_feature_store *store, size_t first, size_t *bytes)
{
    *bytes = csg_feature_lists_bytes(store->features + first, store->count - first);
    uint8_t *packed = *bytes ? csg_memory_alloc(store->memory, *bytes) : NULL, *to = packed;
    for (size_t i = first; packed && i < store->count; i++) {
        size_t own = csg_feature_list_bytes(&store->features[i]);
        memcpy(to, store->features[i].side, own);
        to += own;
    }
    return packed;
}

bool csg_feature_store_adopt(csg_feature_store *store, const csg_feature *features, size_t count,
                             const void *lists, size_t list_bytes, const csg_feature_block *blocks,
                             size_t block_count)
{
    if (!count)
        return true;
    void *own = csg_arena_alloc(&store->lists, list_bytes);
    if (!own || !reserve(store, count, block_count))
        return false;
    memcpy(own, lists, list_bytes);
    memcpy(store->features + store->count, features, count * sizeof *features);
    memcpy(store->blocks + store->block_count, blocks, block_count * sizeof *blocks);
    csg_features_lay_out(store->features + store->count, count, own);
    store->count += count;
    store->block_count += block_count;
    store->numbered = store->block_count;
    return true;
}

bool csg_feature_store_index(csg_feature_store *store)
{
    csg_table_release(&store->index);
    csg_table_init(&store->index, store->memory);
    if (!csg_table_reserve(&store->index, store->block_count + 1, NULL, NULL))
        return false;
    for (size_t i = 0; i < store->block_count; i++)
        csg_table_add(&store->index, csg_lattice_hash(store->blocks[i].at), (uint32_t)i);
    return true;
}

const csg_feature_block *csg_feature_store_find(const csg_feature_store *store,
                                                const uint32_t at[3])
{
    if (!store->block_count)
        return NULL;
    size_t slot;
    uint32_t found = csg_table_first(&store->index, csg_lattice_hash(at), &slot);
    while (found != CSG_TABLE_NONE &&
           memcmp(store->blocks[found].at, at, sizeof store->blocks[found].at) != 0)
        found = csg_table_next(&store->index, &slot);
    return found != CSG_TABLE_NONE ? &store->blocks[found] : NULL;
}

void csg_feature_store_release(csg_feature_store *store)
{
    if (!store->memory)
        return;
    csg_memory_release(store->memory, store->features, store->capacity * sizeof(csg_feature));
    csg_arena_reset(&store->lists);
    for (size_t i = 0; i < store->taken_count; i++)
        csg_arena_reset(&store->taken[i]);
    csg_memory_release(store->memory, store->taken, store->taken_capacity * sizeof *store->taken);
    csg_memory_release(store->memory, store->blocks,
                       store->block_capacity * sizeof(csg_feature_block));
    csg_table_release(&store->index);
    csg_memory_release(store->memory, store->moves, store->move_capacity * sizeof *store->moves);
    *store = (csg_feature_store){0};
}

/* ---- neighbours --------------------------------------------------------------------------------
 */

/* The cell beyond a face: moves `at` to its block. False: beyond the lattice. */
static bool step(uint32_t at[3], uint16_t *cell, int axis, bool up)
{
    int c[3] = {*cell & 7, *cell >> 3 & 7, *cell >> 6};
    c[axis] += up ? 1 : -1;
    if (c[axis] < 0 && at[axis] == 0)
        return false;
    at[axis] += c[axis] < 0 ? UINT32_MAX : c[axis] == E;
    c[axis] = (c[axis] + E) % E;
    *cell = (uint16_t)((c[2] * E + c[1]) * E + c[0]);
    return true;
}

/* The feature with a side from edge `from` to edge `to` in that cell. */
static uint32_t feature_with(const csg_feature_store *store, const csg_feature_block *block,
                             uint16_t cell, uint8_t from, uint8_t to, uint8_t *side)
{
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        const csg_feature *f = &store->features[i];
        for (uint8_t s = 0; f->cell == cell && s < f->side_count; s++)
            if (f->side[s].edge == from && f->side[(s + 1) % f->side_count].edge == to) {
                *side = s;
                return i;
            }
    }
    return CSG_FEATURE_NONE;
}

static void link_side(csg_feature_store *store, const csg_cell_tables *tables,
                      const csg_feature_block *block, csg_feature *f, int s)
{
    uint8_t from = f->side[s].edge, to = f->side[(s + 1) % f->side_count].edge, side = 0;
    int face = csg_face_between(tables, from, to);
    uint32_t at[3] = {block->at[0], block->at[1], block->at[2]};
    uint16_t cell = f->cell;
    if (face < 0 || !step(at, &cell, face / 2, face % 2))
        return;
    const csg_feature_block *beyond = csg_feature_store_find(store, at);
    if (!beyond)
        return;
    uint32_t other = feature_with(store, beyond, cell, csg_edge_beyond(tables, to, face / 2),
                                  csg_edge_beyond(tables, from, face / 2), &side);
    if (other == CSG_FEATURE_NONE || f->state == CSG_FEATURE_GIVEN_UP ||
        store->features[other].state == CSG_FEATURE_GIVEN_UP) /* in a cell with a joined face */
        return;
    f->side[s].beyond = other;
    f->side[s].beyond_side = side;
    if (f->creased >> s & store->features[other].creased >> side & 1)
        f->flipped |= (uint16_t)(1u << s);
}

void csg_feature_link(csg_feature_store *store, const csg_cell_tables *tables, size_t index)
{
    const csg_feature_block *block = &store->blocks[index];
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        csg_feature *f = &store->features[i];
        for (int s = 0; s < f->side_count; s++)
            link_side(store, tables, block, f, s);
        f->ends = f->creased & ~f->flipped;
    }
}

void csg_feature_flip(csg_feature_store *store, const csg_cell_tables *tables, size_t index)
{
    const csg_feature_block *block = &store->blocks[index];
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        csg_feature *f = &store->features[i];
        if (f->creased)
            csg_feature_cut(store->features, tables, f, f->triangle);
    }
}

/* ---- triangles ---------------------------------------------------------------------------------
 */

/* The sheet of the apex beyond side s that lies in this sheet of the feature. */
static uint8_t sheet_beyond(const csg_feature_store *store, const csg_feature *f, int s,
                            uint8_t sheet)
{
    const csg_feature *g = &store->features[f->side[s].beyond];
    int t = f->side[s].beyond_side;
    return g->side[f->side[s].sheet == sheet ? (t + 1) % g->side_count : t].sheet;
}

void csg_feature_triangle(const csg_feature_store *store, const csg_feature *f, int index,
                          csg_fan_corner corners[3])
{
    const uint8_t *t = f->triangle[index];
    int c = 0;
    while (t[c] >= CSG_FEATURE_BEYOND)
        c++;
    uint8_t sheet = f->side[t[c]].sheet;
    for (c = 0; c < 3; c++) {
        int s = t[c] - CSG_FEATURE_BEYOND;
        if (t[c] == CSG_FEATURE_APEX)
            corners[c] = (csg_fan_corner){.apex = f, .sheet = sheet};
        else if (s >= 0)
            corners[c] = (csg_fan_corner){.apex = &store->features[f->side[s].beyond],
                                          .sheet = sheet_beyond(store, f, s, sheet)};
        else
            corners[c] = (csg_fan_corner){.edge = f->side[t[c]].edge,
                                          .at = f->moved >> t[c] & 1 ? f->side[t[c]].corner : NULL};
    }
}
