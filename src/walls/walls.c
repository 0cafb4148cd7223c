/* SPDX-License-Identifier: MIT
 * Walls and gaps; see walls.h. The two are searches of their own, each on one thread.
 */
#include "walls/walls.h"

#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "field/field.h"
#include "measure/measure.h"
#include "walls/cubes.h"

enum { WALL, GAP, KINDS };

/* How exactly a segment begins along a normal. */
static const double STRAIGHT_DEG = 0.1;
/* How closely lengths are to be known where nothing is asked for. */
static const double OF_SIZE = 1e-4, OF_LENGTH = 1.0 / 32, FINEST = 1.0 / 500;

typedef struct job {
    csgm_context *context;
    csg_mesh_watch watch;
    csg_wall_angles angles;
    double tolerance, share, finest;
    uint64_t most_pairs;
    csg_wall_found found[KINDS];
    bool done[KINDS], out_of_memory[KINDS], overlooks[KINDS];
    const csg_measure_walk *walk;
} job;

static void begin(job *j, csgm_context *context, const csgm_wall_options *options, double size)
{
    *j = (job){.context = context,
               .angles = csg_wall_angles_make(STRAIGHT_DEG, options->angle_deg),
               .tolerance = (options->tolerance > 0 ? options->tolerance : OF_SIZE) * size,
               .share = options->tolerance > 0 ? 0 : OF_LENGTH,
               .finest = options->finest > 0 ? options->finest : FINEST * size,
               .most_pairs = options->most_pairs};
    csg_mesh_watch_begin(&j->watch, context, &options->monitor, 0);
    csg_mesh_take(&j->watch, CSGM_STAGE_MEASURE, 1);
    for (int i = 0; i < KINDS; i++)
        j->found[i].best.apart = INFINITY;
}

static csg_wall_task task_of(job *j, int kind, csg_wall_source source)
{
    return (csg_wall_task){.source = source,
                           .tolerance = j->tolerance,
                           .share = j->share,
                           .most_pairs = j->most_pairs,
                           .memory = &j->context->memory,
                           .watch = &j->watch,
                           .out_of_memory = &j->out_of_memory[kind]};
}

static csgm_span span_of(const job *j, int kind, csg_vec3 origin)
{
    const csg_wall_found *found = &j->found[kind];
    csgm_span span = {.length = {found->low, found->best.apart}};
    span.overlooked = j->overlooks[kind] ? j->finest : 0;
    span.is_shown = found->best.apart < INFINITY;
    for (int i = 0; i < 2 && span.is_shown; i++)
        span.at[i] = csg_vec3_add(found->best.at[i], origin);
    return span;
}

static bool is_close(const job *j, const csg_wall_found *found)
{
    double most = fmax(j->tolerance, j->share * found->best.apart);
    return found->low >= INFINITY || found->best.apart - found->low <= 1.001 * most;
}

static csgm_status tell(job *j, csg_vec3 origin, csgm_walls *out)
{
    bool done = j->done[WALL] && j->done[GAP];
    out->wall = span_of(j, WALL, origin);
    out->gap = span_of(j, GAP, origin);
    out->pairs = j->found[WALL].pairs + j->found[GAP].pairs;
    out->is_reached = done && is_close(j, &j->found[WALL]) && is_close(j, &j->found[GAP]);
    if (j->out_of_memory[WALL] || j->out_of_memory[GAP])
        return csg_context_no_memory(j->context);
    return done ? CSGM_OK : csg_mesh_why_stopped(&j->watch);
}

/* ---- fields ------------------------------------------------------------------------------------
 */

static bool search_field(void *user, uint32_t worker, size_t kind)
{
    job *j = user;
    csg_wall_cubes cubes;
    bool is_there;
    const csg_wall_side side = {.walk = j->walk,
                                .worker = &j->walk->workers[worker],
                                .turn = kind == GAP ? 1 : -1,
                                .angles = j->angles,
                                .tolerance = j->tolerance,
                                .finest = j->finest,
                                .out_of_memory = &j->out_of_memory[kind]};
    j->done[kind] = csg_wall_cubes_begin(&cubes, &side, &is_there);
    if (!j->done[kind]) {
        j->out_of_memory[kind] = true;
    } else if (!is_there) {
        j->found[kind].low = INFINITY;
    } else {
        const csg_wall_task task = task_of(j, (int)kind, csg_wall_cubes_source(&cubes));
        j->done[kind] = csg_wall_search(&task, &j->found[kind]);
        j->overlooks[kind] = cubes.overlooks;
    }
    csg_wall_cubes_release(&cubes);
    return j->done[kind];
}

csgm_status csg_walls_of_field(csgm_context *context, const csgm_field *field,
                               const csgm_wall_options *options, csgm_walls *out)
{
    CSG_ZONE(context, "walls");
    job j;
    csg_measure_walk walk;
    csgm_status status = csg_measure_check_bounds(context, field->bounds);
    if (status != CSGM_OK)
        return status;
    begin(&j, context, options, csg_box_longest_side(field->bounds));
    j.walk = &walk;
    if (csg_measure_walk_open(&walk, context, field, &j.watch)) {
        csg_pool_run(context->pool, KINDS, search_field, NULL, &j);
        status = tell(&j, field->center, out);
    } else {
        status = csg_context_no_memory(context);
    }
    csg_measure_walk_release(&walk);
    return status;
}
