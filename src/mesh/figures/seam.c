/* SPDX-License-Identifier: MIT
 * A table of open vertices, with lists of arcs and triangles; see seam.h.
 */
#include "mesh/figures/seam.h"

#include <string.h>

#include "base/sets.h"

struct csg_seam_arc {
    csg_link_arc arc;
    uint32_t next;
};

/* It waits at each of its vertices that has no place yet. A list of those that wait at a vertex is
 * one of corners: 3 * triangle + corner. */
struct csg_seam_triangle {
    float at[9];
    uint32_t missing; /* corners without a place */
    uint32_t next[3]; /* in the list of each; of free triangles: next[0] */
};

enum { FIRST_SIZE = 1 << 10, NONE = CSG_SEAM_NONE };

/* ---- the table ---------------------------------------------------------------------------- */

static size_t home_of(const csg_seam *s, uint32_t number)
{
    return (size_t)(number * UINT64_C(0x9E3779B97F4A7C15) >> 32) & (s->size - 1);
}

/* Its slot, or the free one where it would stand. */
static size_t slot_of(const csg_seam *s, uint32_t number)
{
    size_t slot = home_of(s, number);
    while (s->slots[slot].number != number && s->slots[slot].number != NONE)
        slot = (slot + 1) & (s->size - 1);
    return slot;
}

static csg_seam_vertex *find(const csg_seam *s, uint32_t number)
{
    csg_seam_vertex *found = s->size ? &s->slots[slot_of(s, number)] : NULL;
    return found && found->number == number ? found : NULL;
}

static bool grow(csg_seam *s)
{
    csg_seam old = *s;
    s->size = old.size ? 2 * old.size : FIRST_SIZE;
    s->slots = csg_memory_alloc(s->memory, s->size * sizeof *s->slots);
    if (!s->slots) {
        *s = old;
        return false;
    }
    for (size_t i = 0; i < s->size; i++)
        s->slots[i].number = NONE;
    for (size_t i = 0; i < old.size; i++)
        if (old.slots[i].number != NONE)
            s->slots[slot_of(s, old.slots[i].number)] = old.slots[i];
    csg_memory_release(s->memory, old.slots, old.size * sizeof *old.slots);
    return true;
}

/* Closes the gap by what would be looked for across it (Knuth, volume 3, 6.4, algorithm R). */
static void take_out(csg_seam *s, csg_seam_vertex *vertex)
{
    size_t gap = (size_t)(vertex - s->slots), at = gap;
    s->count--;
    for (;;) {
        at = (at + 1) & (s->size - 1);
        if (s->slots[at].number == NONE)
            break;
        size_t home = home_of(s, s->slots[at].number);
        if (((at - home) & (s->size - 1)) < ((at - gap) & (s->size - 1)))
            continue;
        s->slots[gap] = s->slots[at];
        gap = at;
    }
    s->slots[gap].number = NONE;
}

/* ---- what is done at vertices -------------------------------------------------------------- */

uint32_t csg_seam_add_pieces(csg_seam *s, size_t count)
{
    size_t first = s->piece_count;
    void *pieces = s->pieces;
    if (!csg_memory_reserve(s->memory, &pieces, &s->piece_room, first + count, sizeof *s->pieces))
        return NONE;
    s->pieces = pieces;
    for (size_t i = first; i < first + count; i++)
        s->pieces[i] = (uint32_t)i;
    s->piece_count += count;
    return (uint32_t)first;
}

bool csg_seam_reserve(csg_seam *s, size_t vertices, size_t arcs)
{
    void *room = s->arcs;
    while (2 * (s->count + vertices + 1) > s->size)
        if (!grow(s))
            return false;
    if (!csg_memory_reserve(s->memory, &room, &s->arc_room, s->arc_count + arcs, sizeof *s->arcs))
        return false;
    s->arcs = room;
    return true;
}

csg_seam_vertex *csg_seam_meet(csg_seam *s, uint32_t number, uint32_t piece, const float *at)
{
    csg_seam_vertex *v = &s->slots[slot_of(s, number)];
    if (v->number == NONE) {
        *v = (csg_seam_vertex){.number = number, .piece = piece, .arcs = NONE, .waiting = NONE};
        s->count++;
    } else if (v->piece == NONE) {
        v->piece = piece;
    } else if (piece != NONE) {
        csg_sets_join(s->pieces, v->piece, piece);
    }
    if (at) {
        v->is_placed = true;
        memcpy(v->at, at, sizeof v->at);
    }
    return v;
}

void csg_seam_add_arc(csg_seam *s, csg_seam_vertex *v, csg_link_arc arc)
{
    bool is_free = s->arc_count && s->free_arc != NONE;
    uint32_t place = is_free ? s->free_arc : (uint32_t)s->arc_count++;
    s->free_arc = is_free ? s->arcs[place].next : NONE;
    s->arcs[place] = (csg_seam_arc){.arc = arc, .next = v->arcs};
    v->arcs = place;
    v->arc_count++;
}

bool csg_seam_close(csg_seam *s, uint32_t number, bool *is_closed)
{
    csg_seam_vertex *v = find(s, number);
    void *link = s->link;
    *is_closed = false;
    if (!v || !v->arc_count || v->waiting != NONE)
        return true;
    if (!csg_memory_reserve(s->memory, &link, &s->link_room, v->arc_count, sizeof *s->link))
        return false;
    s->link = link;
    size_t count = 0;
    uint32_t last = NONE;
    for (uint32_t a = v->arcs; a != NONE; a = s->arcs[a].next) {
        s->link[count++] = s->arcs[a].arc;
        last = a;
    }
    *is_closed = csg_link_is_circle(s->link, count);
    if (*is_closed) {
        s->arcs[last].next = s->free_arc;
        s->free_arc = v->arcs;
        take_out(s, v);
    }
    return true;
}

/* ---- triangles ------------------------------------------------------------------------------ */

static uint32_t take_triangle(csg_seam *s)
{
    uint32_t place = s->free_triangle;
    if (s->triangle_count && place != NONE) {
        s->free_triangle = s->triangles[place].next[0];
        return place;
    }
    void *triangles = s->triangles;
    if (!csg_memory_reserve(s->memory, &triangles, &s->triangle_room, s->triangle_count + 1,
                            sizeof *s->triangles))
        return NONE;
    s->triangles = triangles;
    s->free_triangle = NONE;
    return (uint32_t)s->triangle_count++;
}

bool csg_seam_add_triangle(csg_seam *s, csg_seam_vertex *const vertices[3], const float *at,
                           csg_mesh_measures *measures)
{
    csg_seam_triangle t = {.missing = 0};
    bool is_missing[3];
    memcpy(t.at, at, sizeof t.at);
    for (int c = 0; c < 3; c++) {
        const csg_seam_vertex *v = vertices[c];
        is_missing[c] = v && !v->is_placed;
        if (v && v->is_placed)
            memcpy(t.at + 3 * c, v->at, sizeof v->at);
        t.missing += is_missing[c];
    }
    if (!t.missing) {
        csg_mesh_measures_put(measures, t.at, t.at + 3, t.at + 6);
        return true;
    }
    uint32_t place = take_triangle(s);
    if (place == NONE)
        return false;
    for (uint32_t c = 0; c < 3; c++)
        if (is_missing[c]) {
            t.next[c] = vertices[c]->waiting;
            vertices[c]->waiting = 3 * place + c;
        }
    s->triangles[place] = t;
    return true;
}

void csg_seam_settle(csg_seam *s, csg_seam_vertex *v, csg_mesh_measures *measures)
{
    while (v->waiting != NONE) {
        uint32_t place = v->waiting / 3, c = v->waiting % 3;
        csg_seam_triangle *t = &s->triangles[place];
        v->waiting = t->next[c];
        memcpy(t->at + 3 * c, v->at, sizeof v->at);
        if (--t->missing)
            continue;
        csg_mesh_measures_put(measures, t->at, t->at + 3, t->at + 6);
        t->next[0] = s->free_triangle;
        s->free_triangle = place;
    }
}

/* ---- all of it ------------------------------------------------------------------------------- */

uint64_t csg_seam_components(csg_seam *s)
{
    uint64_t count = s->components;
    for (size_t i = 0; i < s->piece_count; i++)
        count += s->pieces[i] == i;
    return count;
}

void csg_seam_release(csg_seam *s)
{
    csg_memory_release(s->memory, s->slots, s->size * sizeof *s->slots);
    csg_memory_release(s->memory, s->arcs, s->arc_room * sizeof *s->arcs);
    csg_memory_release(s->memory, s->triangles, s->triangle_room * sizeof *s->triangles);
    csg_memory_release(s->memory, s->link, s->link_room * sizeof *s->link);
    csg_memory_release(s->memory, s->pieces, s->piece_room * sizeof *s->pieces);
}
