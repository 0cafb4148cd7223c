/* SPDX-License-Identifier: MIT
 * See places.h.
 */
#include "clearance/places.h"

#include <float.h>
#include <math.h>

enum { STEPS = 10, CLIMBS = 24 };

static csg_measure_worker *worker_of(const csg_clear_part *part, uint32_t worker)
{
    return &part->walk.workers[worker];
}

static csg_vec3 to_own(const csg_clear_part *part, csg_vec3 at)
{
    return csg_vec3_sub(at, csg_clear_part_origin(part));
}

/* Value and gradient at one point. */
static double look_at(const csg_clear_part *part, uint32_t worker, csg_vec3 own, csg_vec3 *gradient)
{
    float x[3][CSG_LANES], f[CSG_LANES], g[3][CSG_LANES], at[3];
    csg_vec3_to_floats(at, own);
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < CSG_LANES; i++)
            x[axis][i] = at[axis];
    part->walk.kernel->values_and_gradients(&part->field->tape, x[0], x[1], x[2], 1, f, g[0], g[1],
                                            g[2], worker_of(part, worker)->scratch,
                                            part->walk.scratch_floats);
    *gradient = csg_vec3_make((double)g[0][0], (double)g[1][0], (double)g[2][0]);
    return (double)f[0];
}

bool csg_clear_is_inside(const csg_clear_part *part, uint32_t worker, csg_vec3 at,
                         bool *out_of_memory)
{
    csg_pruner *pruner = &worker_of(part, worker)->pruner;
    csg_vec3 own = to_own(part, at);
    float center[3];
    csg_vec3_to_floats(center, own);
    double moved = csg_vec3_norm(csg_vec3_sub(csg_vec3_from_floats(center), own));
    if (!csg_prune_cube(pruner, &part->field->tape, center, (float)(moved * (1 + 1e-6)))) {
        *out_of_memory = true;
        return false;
    }
    return csg_prune_state(pruner, 0) == CSG_CELL_INSIDE;
}

/* Of eight points ever farther in, the first that is inside. */
static bool push_in(const csg_clear_part *part, uint32_t worker, csg_vec3 own, csg_vec3 inward,
                    csg_vec3 *out, bool *out_of_memory)
{
    float c[3][CSG_OCTANTS], at[3];
    csg_pruner *pruner = &worker_of(part, worker)->pruner;
    double by = 0, first = 0.5 * (double)pruner->rounding;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        csg_vec3_to_floats(at, csg_vec3_add(own, csg_vec3_scale(inward, by)));
        for (int axis = 0; axis < 3; axis++)
            c[axis][o] = at[axis];
        by = by > 0 ? 2 * by : first;
    }
    if (!csg_prune_octants(pruner, &part->field->tape, c[0], c[1], c[2], 0)) {
        *out_of_memory = true;
        return false;
    }
    for (int o = 0; o < CSG_OCTANTS; o++)
        if (csg_prune_state(pruner, o) == CSG_CELL_INSIDE) {
            const float found[3] = {c[0][o], c[1][o], c[2][o]};
            *out = csg_vec3_add(csg_clear_part_origin(part), csg_vec3_from_floats(found));
            return true;
        }
    return false;
}

bool csg_clear_settle(const csg_clear_part *part, uint32_t worker, csg_vec3 near, csg_vec3 *out,
                      bool *out_of_memory)
{
    csg_vec3 own = to_own(part, near), g = {0, 0, 0};
    double close = (double)worker_of(part, worker)->pruner.rounding;
    double level = 3 * close * (double)part->field->tape.steepest; /* what is proven to be inside */
    for (int step = 0; step < STEPS; step++) {
        double f = look_at(part, worker, own, &g);
        double steep = csg_vec3_dot(g, g);
        if (!(steep > 1e-12) || !isfinite(f))
            return false;
        own = csg_vec3_sub(own, csg_vec3_scale(g, (f - level) / steep));
        if (fabs(f - level) < 0.25 * level)
            break;
    }
    return push_in(part, worker, own, csg_vec3_normalize(g), out, out_of_memory);
}

bool csg_clear_find_common(const csg_clear_part *a, const csg_clear_part *b, uint32_t worker,
                           csg_vec3 from, double step, csg_vec3 *out, bool *out_of_memory)
{
    csg_vec3 at = from;
    double best = -INFINITY, last = -INFINITY;
    bool found = false;
    for (int i = 0; i < CLIMBS; i++) {
        csg_vec3 ga, gb;
        double fa = look_at(a, worker, to_own(a, at), &ga),
               fb = look_at(b, worker, to_own(b, at), &gb);
        double f = fmin(fa, fb);
        if (f > 0 && f > best && csg_clear_is_inside(a, worker, at, out_of_memory) &&
            csg_clear_is_inside(b, worker, at, out_of_memory)) {
            best = f;
            *out = at;
            found = true;
        }
        if (!isfinite(f))
            return found;
        if (f <= last)
            step *= 0.5;
        last = f;
        csg_vec3 g = fa < fb ? ga : gb;
        double steep = csg_vec3_norm(g);
        if (!(steep > 1e-6))
            return found;
        /* no farther than the surface, where that is what is missing */
        double by = f < 0 ? fmin(step, 1.5 * -f / steep + 0.1 * step) : step;
        at = csg_vec3_add(at, csg_vec3_scale(g, by / steep));
    }
    return found;
}
