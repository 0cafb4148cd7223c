/* SPDX-License-Identifier: MIT
 * Kept and found again; see judged.h.
 */
#include "mesh/adaptive/judged.h"

#include <string.h>

static const csg_pierced NOTHING_PIERCED = {.edges = 0};

/* False: out of memory. */
static bool copy(csg_arena *arena, const void *items, size_t bytes, const void **out)
{
    *out = NULL;
    if (!bytes)
        return true;
    void *own = csg_arena_alloc(arena, bytes);
    if (own)
        memcpy(own, items, bytes);
    *out = own;
    return own != NULL;
}

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

const csg_judged *csg_judged_keep(csg_arena *arena, const csg_judged *judged)
{
    csg_judged *own = csg_arena_alloc(arena, sizeof *own);
    if (!own)
        return NULL;
    *own = *judged;
    bool done = copy(arena, judged->roots, judged->root_count * sizeof *judged->roots,
                     (const void **)&own->roots) &&
                copy(arena, judged->creases, judged->crease_count * sizeof *judged->creases,
                     (const void **)&own->creases) &&
                copy(arena, judged->apexes, judged->apex_count * sizeof *judged->apexes,
                     (const void **)&own->apexes) &&
                copy(arena, judged->pierced,
                     judged->pierced && judged->pierced->edges ? sizeof *judged->pierced : 0,
                     (const void **)&own->pierced);
    return done ? own : NULL;
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
