/* SPDX-License-Identifier: MIT
 * Tapes around points; see around.h.
 */
#include "mesh/features/around.h"

#include <math.h>
#include <string.h>

#include "grid/octree/octree.h"

void csg_feature_around_begin(csg_feature_around *around, csg_memory *memory, const csg_marching *m)
{
    if (around->memory)
        return;
    around->memory = memory;
    csg_pruner_init(&around->pruner, memory, m->kernel, csg_octree_rounding(m->lattice));
    csg_arena_init(&around->arena, memory);
    around->empty = csg_arena_get_mark(&around->arena);
    around->half = -1;
}

void csg_feature_around_release(csg_feature_around *around)
{
    if (!around->memory)
        return;
    csg_pruner_release(&around->pruner);
    csg_arena_reset(&around->arena);
    *around = (csg_feature_around){0};
}

bool csg_feature_around_holds(const csg_feature_around *around, float x, float y, float z)
{
    return around->memory && fabsf(x - around->center[0]) <= around->half &&
           fabsf(y - around->center[1]) <= around->half &&
           fabsf(z - around->center[2]) <= around->half;
}

void csg_feature_around_move(csg_feature_around *around, csg_memory *memory, const csg_marching *m,
                             const float center[3], float half)
{
    csg_feature_around_begin(around, memory, m);
    memcpy(around->center, center, sizeof around->center);
    around->half = half;
    around->tape = m->field->tape;
    csg_arena_release_to(&around->arena, around->empty);
    /* twice the band of the octree, so that what is asked of it lies well inside */
    float band = 2 * m->field->tape.lipschitz * (float)m->lattice->cell_size + 2 * m->noise;
    float radius = 1.7321f * half; /* sqrt(3) */
    bool done = csg_prune_cube(&around->pruner, &m->field->tape, center, radius);
    if (done && csg_prune_state(&around->pruner, 0) == CSG_CELL_SURFACE)
        done = csg_prune_shorten(&around->pruner, 0, band, &around->arena, &around->tape);
    if (!done) {
        around->tape = m->field->tape;
        around->out_of_memory = true;
    }
}
