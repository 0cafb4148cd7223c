/* SPDX-License-Identifier: MIT
 * Which doubts of the scan are parts missed; see certify.h. Some are followed, evenly spread, each
 * with a tape for its surroundings.
 */
#include <math.h>

#include "field/kernels/dispatch.h"
#include "field/unit_slopes.h"
#include "grid/certify/certify.h"
#include "grid/certify/certify_reach.h"

enum {
    AROUND = 7, /* cells around an edge where its tape is valid */
    MOST_FOLLOWED = 64,
    MOST_NODES = 1000000 /* of tapes, looked through in all */
};

typedef struct scan_room {
    csg_pruner pruner;
    csg_arena tapes;
    csg_reach reach;
    csg_certify_is_lost *is_lost; /* NULL: all are */
    const void *user;
} scan_room;

static bool prepare(scan_room *room, const csgm_field *field, const csg_lattice *lattice,
                    const double middle[3], csg_tape *tape)
{
    const float c[3] = {(float)middle[0], (float)middle[1], (float)middle[2]};
    double h = lattice->cell_size, span = (double)field->tape.lipschitz * h;
    for (int axis = 0; axis < 3; axis++) {
        room->reach.low[axis] = middle[axis] - (AROUND - 2.5) * h;
        room->reach.high[axis] = middle[axis] + (AROUND - 2.5) * h;
    }
    room->reach.tape = tape;
    return csg_prune_cube(&room->pruner, &field->tape, c, (float)(AROUND * h * 1.7321)) &&
           csg_prune_shorten(&room->pruner, 0, (float)(2 * span), &room->tapes, tape);
}

/* From the middle of the edge to the other side of the surface, where there is one. */
static bool follow(scan_room *room, const csgm_field *field, const csg_lattice *lattice,
                   const csg_scan *doubt, csg_certify_place *place, bool *missed)
{
    csg_tape tape;
    csg_reach_end end;
    csg_arena_mark mark = csg_arena_get_mark(&room->tapes);
    double middle[1][3], value;
    for (int axis = 0; axis < 3; axis++)
        middle[0][axis] = (double)csg_lattice_coordinate(lattice, axis, doubt->point[axis]) +
                          (axis == doubt->axis ? lattice->cell_size / 2 : 0);
    if (!prepare(room, field, lattice, middle[0], &tape))
        return false;
    csg_reach_values(&room->reach, (const double(*)[3])middle, 1, &value);
    int sign = doubt->is_inside ? -1 : 1;
    csg_reach_state state = csg_reach_from(&room->reach, middle[0], sign * value, sign, NULL, &end);
    csg_arena_release_to(&room->tapes, mark);
    const csg_vec3 at = csg_vec3_make(end.at[0], end.at[1], end.at[2]);
    *missed = state == CSG_REACH_NONE && end.thickness > 0 &&
              (!room->is_lost || room->is_lost(room->user, at, end.thickness, sign < 0));
    if (*missed && end.thickness > place->thickness) {
        place->thickness = end.thickness;
        place->is_gap = sign < 0;
        place->at = csg_vec3_add(field->center, at);
    }
    return true;
}

static bool follow_some(scan_room *room, const csgm_field *field, const csg_lattice *lattice,
                        const csg_scan *doubts, size_t count, csg_certify_place *place)
{
    size_t most = MOST_NODES / field->tape.count + 4;
    most = most < MOST_FOLLOWED ? most : MOST_FOLLOWED;
    size_t step = (count + most - 1) / most;
    bool missed;
    for (size_t i = 0; i < count; i += step)
        if (!follow(room, field, lattice, &doubts[i], place, &missed))
            return false;
    return true;
}

bool csg_certify_doubts(csgm_context *context, const csgm_field *field, const csg_lattice *lattice,
                        csg_octree *octree, csg_certify_is_lost *is_lost, const void *user,
                        csg_certify_place *place, uint64_t *edges, csgm_status *status)
{
    size_t count;
    const csg_scan *doubts = csg_octree_doubts(octree, &count, edges);
    *status = CSGM_OK;
    *place = (csg_certify_place){.kind = CSG_CELL_MISSED, .cells = count};
    if (!count)
        return false;
    scan_room room = {.is_lost = is_lost,
                      .user = user,
                      .reach = {.kernel = csg_kernel_for(context->isa),
                                .lattice = lattice,
                                .scratch_floats = csg_kernel_scratch_floats(field->depth)}};
    csgm_field even;
    csg_arena_init(&room.tapes, &context->memory);
    bool done = csg_field_with_unit_slopes(field, &room.tapes, &even);
    room.reach.lipschitz = (double)even.tape.lipschitz;
    room.reach.noise = 4 * room.reach.lipschitz * (double)csg_octree_rounding(lattice);
    room.reach.band = 2 * room.reach.lipschitz * lattice->cell_size;
    csg_pruner_init(&room.pruner, &context->memory, room.reach.kernel,
                    csg_octree_rounding(lattice));
    size_t bytes = room.reach.scratch_floats * sizeof(float);
    room.reach.scratch = csg_memory_alloc(&context->memory, bytes);
    if (!doubts || !done || !room.reach.scratch ||
        !follow_some(&room, &even, lattice, doubts, count, place))
        *status = csg_context_no_memory(context);
    csg_memory_release(&context->memory, room.reach.scratch, bytes);
    csg_pruner_release(&room.pruner);
    csg_arena_reset(&room.tapes);
    return *status == CSGM_OK && place->thickness > 0;
}
