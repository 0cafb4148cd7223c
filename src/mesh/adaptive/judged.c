/* SPDX-License-Identifier: MIT
 * Kept and found again; see judged.h.
 */
#include "mesh/adaptive/judged.h"

#include <string.h>

#include "grid/adaptive/shell.h"

static const csg_pierced NOTHING_PIERCED = {.edges = 0};

bool csg_judged_crease_of(const csg_face_side *side, unsigned part, csg_judged_crease *out)
{
    const csg_face_crease *found = &side->part[part];
    *out = (csg_judged_crease){.part = (uint8_t)part,
                               .is_smooth = found->is_smooth,
                               .is_torn = csg_face_side_is_torn(side)};
    csg_vec3_to_floats(out->at, found->at);
    csg_vec3_to_floats(out->gradient, found->gradient);
    return found->is_there;
}

/* Copies what an array has to *end, which is then behind it. */
static const void *copy_behind(uint8_t **end, const void *items, size_t bytes)
{
    const void *own = bytes ? *end : NULL;
    if (bytes)
        memcpy(*end, items, bytes);
    *end += bytes;
    return own;
}

const csg_judged *csg_judged_keep(csg_arena *arena, const csg_judged *judged)
{
    const bool has_pierced = judged->pierced && judged->pierced->edges;
    const size_t pierced = has_pierced ? sizeof *judged->pierced : 0;
    const size_t roots = judged->root_count * sizeof *judged->roots;
    const size_t creases = judged->crease_count * sizeof *judged->creases;
    const size_t apexes = judged->apex_count * sizeof *judged->apexes;
    csg_judged *own = csg_arena_alloc(arena, sizeof *own + pierced + roots + creases + apexes);
    if (!own)
        return NULL;
    *own = *judged;
    uint8_t *end = (uint8_t *)(own + 1);
    own->pierced =
        copy_behind(&end, judged->pierced, pierced); /* first: it is aligned like the struct */
    own->roots = copy_behind(&end, judged->roots, roots);
    own->creases = copy_behind(&end, judged->creases, creases);
    own->apexes = copy_behind(&end, judged->apexes, apexes);
    return own;
}

/* Without what other bricks have for their own. NULL: out of memory. */
static const csg_judged *keep_own(csg_arena *arena, const csg_judged *judged,
                                  const uint32_t around[CSG_BRICKS_AROUND])
{
    csg_judged_root roots[CSG_JUDGED_MOST_ROOTS];
    csg_judged_crease creases[CSG_JUDGED_MOST_CREASES];
    csg_judged own = *judged;
    unsigned low[3];
    own.roots = roots;
    own.creases = creases;
    own.root_count = own.crease_count = 0;
    for (unsigned i = 0; i < judged->root_count; i++) {
        int axis = csg_slot_place(judged->roots[i].slot, low);
        if (csg_brick_owns_edge(around, axis, low))
            roots[own.root_count++] = judged->roots[i];
    }
    for (unsigned i = 0; i < judged->crease_count; i++) {
        int axis = csg_slot_place(judged->creases[i].slot, low);
        if (csg_brick_owns_face(around, axis, low))
            creases[own.crease_count++] = judged->creases[i];
    }
    return csg_judged_keep(arena, &own);
}

bool csg_judged_keep_own(csg_arena *arena, csg_bricks *b, size_t first)
{
    for (size_t i = first; i < b->count; i++) {
        uint32_t around[CSG_BRICKS_AROUND];
        csg_brick *brick = &b->items[i];
        if (!brick->judged)
            continue;
        csg_bricks_around(b, (uint32_t)i, around);
        brick->judged = keep_own(arena, brick->judged, around);
        if (!brick->judged)
            return false;
    }
    return true;
}

/* What a record has of it, before the arrays. */
typedef struct judged_head {
    bool is_there, has_pierced;
    uint8_t root_count, crease_count, apex_count;
} judged_head;

bool csg_judged_pack(csg_memory *memory, const csg_judged *j, csg_records *records)
{
    judged_head head = {.is_there = j != NULL};
    if (j)
        head =
            (judged_head){true, j->pierced != NULL, j->root_count, j->crease_count, j->apex_count};
    bool done = csg_records_add(memory, records, &head, sizeof head);
    if (!j)
        return done;
    return done && csg_records_add(memory, records, j->roots, j->root_count * sizeof *j->roots) &&
           csg_records_add(memory, records, j->creases, j->crease_count * sizeof *j->creases) &&
           csg_records_add(memory, records, j->apexes, j->apex_count * sizeof *j->apexes) &&
           csg_records_add(memory, records, j->pierced, head.has_pierced ? sizeof *j->pierced : 0);
}

/* False: out of memory. */
static bool read_array(csg_arena *arena, csg_record_reader *reader, size_t item, size_t bytes,
                       const void **out)
{
    void *own = bytes ? csg_arena_alloc(arena, bytes) : NULL;
    if (own)
        csg_record_read(reader, item, own, bytes);
    *out = own;
    return own || !bytes;
}

bool csg_judged_unpack(csg_arena *arena, csg_record_reader *reader, size_t item,
                       const csg_judged **out)
{
    judged_head head;
    csg_record_read(reader, item, &head, sizeof head);
    *out = NULL;
    if (!head.is_there)
        return true;
    csg_judged *own = csg_arena_alloc(arena, sizeof *own);
    if (!own)
        return false;
    *own = (csg_judged){.root_count = head.root_count,
                        .crease_count = head.crease_count,
                        .apex_count = head.apex_count};
    *out = own;
    return read_array(arena, reader, item, head.root_count * sizeof *own->roots,
                      (const void **)&own->roots) &&
           read_array(arena, reader, item, head.crease_count * sizeof *own->creases,
                      (const void **)&own->creases) &&
           read_array(arena, reader, item, head.apex_count * sizeof *own->apexes,
                      (const void **)&own->apexes) &&
           read_array(arena, reader, item, head.has_pierced ? sizeof *own->pierced : 0,
                      (const void **)&own->pierced);
}

const csg_pierced *csg_judged_pierced(const csg_judged *judged)
{
    return judged && judged->pierced ? judged->pierced : &NOTHING_PIERCED;
}

const csg_judged_crease *csg_judged_crease_in(const csg_judged *judged, unsigned slot,
                                              unsigned part)
{
    for (unsigned i = 0; judged && i < judged->crease_count; i++)
        if (judged->creases[i].slot == slot && judged->creases[i].part == part)
            return &judged->creases[i];
    return NULL;
}

const csg_judged_apex *csg_judged_apex_of(const csg_judged *judged, unsigned cell, unsigned polygon,
                                          unsigned in_faces)
{
    for (unsigned i = 0; judged && i < judged->apex_count; i++) {
        const csg_judged_apex *apex = &judged->apexes[i];
        if (apex->cell == cell && apex->polygon == polygon)
            return apex->in_faces == in_faces ? apex : NULL;
    }
    return NULL;
}
