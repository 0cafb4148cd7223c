/* SPDX-License-Identifier: MIT
 * How deep the field falls, and how steep it really is near its surface, measured in the middle of
 * some of the cells that it passes through; see csg_tracer_find_slope. The proven bound, lambda, of
 * many soft operators inside each other is far above that: steps must keep to lambda, but what only
 * looks at how near the solid is (where a ray has arrived, how wide a shadow's edge is) would see
 * it everywhere.
 */
#include "render/tracer.h"

enum { SAMPLES = 1024 };

/* Twice as steep as was seen is still the same field. */
static const float LOOSE = 2;

static float slope_at(const csg_tracer *tracer, const csg_ray_cell *cell, csg_trace_room *room)
{
    csg_march *m = &room->march;
    csg_tape tape = tracer->field->tape;
    tape.nodes = cell->near_nodes;
    tape.count = cell->near_count;
    for (int lane = 0; lane < CSG_LANES; lane++) {
        m->x[lane] = cell->center[0];
        m->y[lane] = cell->center[1];
        m->z[lane] = cell->center[2];
    }
    tracer->kernel->gradients(&tape, m->x, m->y, m->z, 1, m->channel[0], m->channel[1],
                              m->channel[2], room->scratch, room->scratch_floats);
    float x = m->channel[0][0], y = m->channel[1][0], z = m->channel[2][0];
    float slope = sqrtf(x * x + y * y + z * z);
    return slope < INFINITY ? slope : 0;
}

/* Bounded fields (soft objects) are constant far away and tell no distance there. Others fall on:
 * the corners of a cube so large are deeper than anything that is looked for. */
static float depth_far_away(const csg_tracer *tracer, csg_trace_room *room)
{
    const float far = 64;
    const csg_ray_cell *root = &tracer->cells->cells[0];
    csg_march *m = &room->march;
    float depth = INFINITY;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        m->x[o] = root->center[0] + (o & 1 ? far : -far) * root->half;
        m->y[o] = root->center[1] + (o & 2 ? far : -far) * root->half;
        m->z[o] = root->center[2] + (o & 4 ? far : -far) * root->half;
    }
    for (int lane = CSG_OCTANTS; lane < CSG_LANES; lane++)
        m->x[lane] = m->y[lane] = m->z[lane] = 0;
    tracer->kernel->values(&tracer->field->tape, m->x, m->y, m->z, CSG_OCTANTS, m->f, room->scratch,
                           room->scratch_floats);
    for (int o = 0; o < CSG_OCTANTS; o++)
        if (m->f[o] < 0 && -m->f[o] < depth)
            depth = -m->f[o];
    return depth;
}

void csg_tracer_find_slope(csg_tracer *tracer, csg_trace_room *room)
{
    const csg_ray_cells *cells = tracer->cells;
    size_t stride = cells->count / SAMPLES + 1;
    float steepest = 0;
    tracer->depth = depth_far_away(tracer, room);
    for (size_t i = 0; i < cells->count; i += stride)
        if (cells->cells[i].is_leaf && cells->cells[i].has_surface)
            steepest = fmaxf(steepest, slope_at(tracer, &cells->cells[i], room));
    tracer->is_loose = LOOSE * steepest * tracer->inverse_lipschitz < 1 && steepest > 0;
    tracer->steepest = steepest > 0 ? steepest : 1 / tracer->inverse_lipschitz;
}
