/* SPDX-License-Identifier: MIT
 * What is kept of a search for the next one; see missed.h.
 */
#include <stdlib.h>

#include "mesh/distance/missed.h"

static int compare_stretches(const void *a, const void *b)
{
    const csg_missed_stretch *p = a, *q = b;
    return p->cube != q->cube ? (p->cube > q->cube) - (p->cube < q->cube)
                              : (p->path > q->path) - (p->path < q->path);
}

const csg_missed_stretch *csg_missed_find_stretch(const csg_missed *missed, uint64_t cube,
                                                  uint64_t path)
{
    const csg_missed_stretch key = {.cube = cube, .path = path};
    return missed->stretch_count ? bsearch(&key, missed->stretches, missed->stretch_count,
                                           sizeof key, compare_stretches)
                                 : NULL;
}

void csg_missed_keep(const csg_remesh *r, csg_missed *missed, csg_missed_before *before)
{
    csg_missed_before_release(before, r->memory);
    if (!csg_written_triangles_list(r, &before->triangles))
        return;
    before->missed = *missed;
    *missed = (csg_missed){0};
}

void csg_missed_before_release(csg_missed_before *before, csg_memory *memory)
{
    csg_missed_release(&before->missed, memory);
    csg_written_triangles_release(&before->triangles, memory);
}

void csg_missed_release(csg_missed *missed, csg_memory *memory)
{
    csg_memory_release(memory, missed->points, missed->capacity * sizeof *missed->points);
    csg_memory_release(memory, missed->stretches,
                       missed->stretch_capacity * sizeof *missed->stretches);
    *missed = (csg_missed){0};
}
