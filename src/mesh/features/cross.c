/* SPDX-License-Identifier: MIT
 * Rounds of looking for triangles that meet; see cross.h.
 */
#include "mesh/features/cross.h"

#include <string.h>

#include "mesh/features/demote.h"
#include "mesh/features/shift.h"
#include "mesh/features/smooth.h"

/* As a feature was in the last round: apexes beyond its sides are others' business. */
typedef struct csg_cross_state {
    float at[3];
    bool known;
    bool changed; /* since the round before */
    uint8_t moves;
    uint8_t tries;   /* places that a smooth one's apex has had */
    bool waits;      /* vertices of it were put back: it is to be settled again */
    uint32_t search; /* the last one that changed it: what was found of it before is past */
} cross_state;

enum { CHANGED = 1, AWAKE = 2, CROSSED = 4 }; /* bits of a block */

static size_t triangle_bytes(const csg_feature *f)
{
    return f->side_count * sizeof f->triangle[0];
}

/* Where those of each block begin in cross->triangles, and where the last end. */
static void find_starts(csg_feature_cross *cross)
{
    const csg_feature_store *store = cross->near.store;
    size_t at = 0;
    for (size_t b = 0; b < store->block_count; b++) {
        const csg_feature_block *block = &store->blocks[b];
        cross->starts[b] = at;
        for (uint32_t i = block->first; i < block->first + block->count; i++)
            at += triangle_bytes(&store->features[i]);
    }
    cross->starts[store->block_count] = at;
}

bool csg_feature_cross_begin(csg_feature_cross *cross)
{
    csg_near *near = &cross->near;
    size_t count = near->store->count + 1, blocks = near->store->block_count + 1;
    near->boxes = csg_memory_alloc(near->memory, count * sizeof *near->boxes);
    near->fans = csg_memory_alloc(near->memory, count * sizeof *near->fans);
    cross->states = csg_memory_alloc(near->memory, count * sizeof(cross_state));
    cross->blocks = csg_memory_alloc(near->memory, blocks);
    cross->starts = csg_memory_alloc(near->memory, blocks * sizeof *cross->starts);
    if (!near->boxes || !near->fans || !cross->states || !cross->blocks || !cross->starts)
        return false;
    find_starts(cross);
    cross->triangles = csg_memory_alloc(near->memory, cross->starts[blocks - 1] + 1);
    if (!cross->triangles)
        return false;
    memset(cross->states, 0, count * sizeof(cross_state));
    memset(cross->blocks, 0, blocks);
    return true;
}

void csg_feature_cross_end(csg_feature_cross *cross)
{
    csg_near *near = &cross->near;
    size_t count = near->store->count + 1;
    for (uint32_t i = 0; i < cross->room_count; i++)
        csg_near_room_release(&cross->rooms[i], near->memory);
    csg_memory_release(near->memory, near->boxes, count * sizeof *near->boxes);
    csg_memory_release(near->memory, near->fans, count * sizeof *near->fans);
    csg_memory_release(near->memory, cross->states, count * sizeof(cross_state));
    size_t blocks = near->store->block_count + 1;
    if (cross->triangles)
        csg_memory_release(near->memory, cross->triangles, cross->starts[blocks - 1] + 1);
    csg_memory_release(near->memory, cross->starts, blocks * sizeof *cross->starts);
    csg_memory_release(near->memory, cross->blocks, blocks);
}

/* ---- looking -----------------------------------------------------------------------------------
 */

void csg_feature_cross_look(csg_feature_cross *cross, size_t index)
{
    const csg_feature_block *block = &cross->near.store->blocks[index];
    uint8_t *before = cross->triangles + cross->starts[index];
    bool changed = false;
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        const csg_feature *f = &cross->near.store->features[i];
        cross_state *state = &cross->states[i];
        size_t bytes = triangle_bytes(f);
        state->changed = !state->known || memcmp(before, f->triangle, bytes) != 0 ||
                         state->moves != f->moves || memcmp(state->at, f->at, sizeof f->at) != 0;
        changed = changed || state->changed;
        memcpy(state->at, f->at, sizeof f->at);
        memcpy(before, f->triangle, bytes);
        before += bytes;
        state->known = true;
        state->waits = false;
        state->moves = f->moves;
    }
    cross->blocks[index] = changed ? CHANGED : 0;
}

void csg_feature_cross_wake(csg_feature_cross *cross)
{
    const csg_feature_store *store = cross->near.store;
    for (size_t b = 0; b < store->block_count; b++)
        for (int k = 0; k < CSG_NEAR_BLOCKS && cross->blocks[b] & CHANGED; k++) {
            const csg_feature_block *around = csg_near_block(store, &store->blocks[b], k);
            if (around)
                cross->blocks[around - store->blocks] |= AWAKE;
        }
}

bool csg_feature_cross_is_awake(const csg_feature_cross *cross, size_t block)
{
    return cross->blocks[block] & AWAKE;
}

void csg_feature_cross_measure(csg_feature_cross *cross, size_t block)
{
    if (csg_feature_cross_is_awake(cross, block))
        csg_near_measure(&cross->near, block);
}

static bool note(void *user, const csg_near_triangle *s, const csg_near_triangle *t)
{
    return false;
}

/* Whether something that has changed comes near the block's triangles: of those that have not, all
 * is known. */
static bool is_touched(const csg_feature_cross *cross, size_t index)
{
    const csg_feature_store *store = cross->near.store;
    const csg_near_box box = csg_near_box_of_block(&cross->near, index);
    for (int k = 0; k < CSG_NEAR_BLOCKS; k++) {
        const csg_feature_block *around = csg_near_block(store, &store->blocks[index], k);
        for (uint32_t i = 0; around && i < around->count; i++)
            if (cross->states[around->first + i].changed &&
                csg_near_reaches(&cross->near, around->first + i, &box))
                return true;
    }
    return false;
}

bool csg_feature_cross_test(csg_feature_cross *cross, uint32_t worker, size_t block)
{
    csg_near_room *room = &cross->rooms[worker];
    if (!csg_feature_cross_is_awake(cross, block) || !is_touched(cross, block))
        return true;
    if (!csg_near_collect(&cross->near, room, block))
        return false;
    if (!csg_near_search(&cross->near, room, block, note, NULL))
        cross->blocks[block] |= CROSSED;
    return true;
}

/* ---- mending -----------------------------------------------------------------------------------
 */

/* Of those that own the triangles: the one whose apex lies furthest outside its cell; NONE where
 * all are smooth. */
static uint32_t victim_of(const csg_feature_cross *cross, const uint32_t owners[4])
{
    uint32_t victim = CSG_FEATURE_NONE;
    double most = -1;
    for (int k = 0; k < 4; k++) {
        if (owners[k] == CSG_FEATURE_NONE ||
            csg_feature_is_plain(&cross->near.store->features[owners[k]]))
            continue;
        double excess = csg_near_excess(&cross->near, owners[k]);
        if (excess > most) {
            most = excess;
            victim = owners[k];
        }
    }
    return victim;
}

static bool is_past(const csg_feature_cross *cross, const uint32_t owners[4])
{
    for (int k = 0; k < 4; k++)
        if (owners[k] != CSG_FEATURE_NONE &&
            (cross->states[owners[k]].search == cross->search || cross->states[owners[k]].waits))
            return true;
    return false;
}

static void has_changed(csg_feature_cross *cross, uint32_t feature)
{
    cross->states[feature].search = cross->search;
    cross->states[feature].known =
        false; /* even if it is as it was: pairs of it were passed over */
    cross->has_changed = true;
}

/* Vertices of theirs that have moved, or for them, go back first. */
static bool put_back(csg_feature_cross *cross, const uint32_t owners[4])
{
    csg_feature_store *store = cross->near.store;
    bool any = false;
    for (int k = 0; k < 4; k++) {
        if (owners[k] == CSG_FEATURE_NONE || !csg_feature_is_shifted(&store->features[owners[k]]))
            continue;
        csg_feature_shift_back(store, cross->near.marching->tables, &store->features[owners[k]]);
        has_changed(cross, owners[k]);
        cross->states[owners[k]].waits = true;
        any = true;
    }
    return any;
}

/* One becomes smooth; where all are, one's apex goes to another place in its polygon. */
static bool mend(void *user, const csg_near_triangle *s, const csg_near_triangle *t)
{
    csg_feature_cross *cross = user;
    csg_feature_store *store = cross->near.store;
    const csg_cell_tables *tables = cross->near.marching->tables;
    const uint32_t owners[4] = {s->owner[0], s->owner[1], t->owner[0], t->owner[1]};
    if (is_past(cross, owners))
        return true;
    if (put_back(cross, owners))
        return true;
    uint32_t victim = victim_of(cross, owners);
    if (victim != CSG_FEATURE_NONE) {
        csg_feature_demote(store, tables, &store->features[victim]);
        has_changed(cross, victim);
        return true;
    }
    for (int k = 0; k < 4; k += 2) {
        cross_state *state = owners[k] == CSG_FEATURE_NONE ? NULL : &cross->states[owners[k]];
        if (state && csg_feature_divide(&store->features[owners[k]], tables, state->tries + 1u)) {
            state->tries++;
            has_changed(cross, owners[k]);
            return true;
        }
    }
    return true;
}

/* The block, over and over, until nothing in it meets that can be helped. False: out of memory. */
static bool mend_block(csg_feature_cross *cross, size_t index, size_t *changed)
{
    const csg_feature_store *store = cross->near.store;
    do {
        cross->search++;
        cross->has_changed = false;
        for (int k = 0; k < CSG_NEAR_BLOCKS; k++) {
            const csg_feature_block *around = csg_near_block(store, &store->blocks[index], k);
            if (around)
                csg_near_measure(&cross->near, (size_t)(around - store->blocks));
        }
        if (!csg_near_collect(&cross->near, &cross->rooms[0], index))
            return false;
        csg_near_search(&cross->near, &cross->rooms[0], index, mend, cross);
        *changed += cross->has_changed;
    } while (cross->has_changed);
    return true;
}

bool csg_feature_cross_mend(csg_feature_cross *cross, size_t *changed)
{
    bool done = true;
    *changed = 0;
    for (size_t b = 0; b < cross->near.store->block_count && done; b++)
        if (cross->blocks[b] & CROSSED)
            done = mend_block(cross, b, changed);
    return done;
}
