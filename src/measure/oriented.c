/* SPDX-License-Identifier: MIT
 * Oriented boxes; see oriented.h. What they stand on is how far the solid reaches along directions:
 * of fields by branch and bound (extent.h), of meshes by all of their vertices.
 */
#include "measure/oriented.h"

#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "field/field.h"
#include "measure/measure.h"
#include "measure/mesh_points.h"
#include "measure/orientation.h"
#include "measure/properties.h"

/* ---- what is told ------------------------------------------------------------------------------
 */

static double largest_of(csg_vec3 v)
{
    double most = fmax(v.x, fmax(v.y, v.z)), least = fmin(v.x, fmin(v.y, v.z));
    return most >= -least ? most : least;
}

/* Of directions that are of unit length and at right angles to a few units in the last place, so
 * that a box along them is off by as much. */
static void tell(const csg_orientation *o, csg_vec3 origin, double size, csgm_oriented_box *out)
{
    static const double ROUNDING = 0x1p-46;
    int order[3] = {0, 1, 2};
    double edges[3];
    for (int k = 0; k < 3; k++)
        edges[k] = o->reaches[k].high + o->reaches[3 + k].high;
    for (int i = 0; i < 3; i++) /* the longest first */
        for (int k = i; k > 0 && edges[order[k - 1]] < edges[order[k]]; k--) {
            int other = order[k];
            order[k] = order[k - 1];
            order[k - 1] = other;
        }
    double slack = ROUNDING * (size + csg_vec3_norm(origin));
    csgm_interval volume = {1, 1};
    for (int i = 0; i < 3; i++) {
        const csg_support_point *back = &o->reaches[order[i]], *forth = &o->reaches[3 + order[i]];
        csg_vec3 axis = o->axes[order[i]];
        double at = csg_vec3_dot(axis, origin);
        csgm_interval least = {at - back->high - slack, at - back->low + slack},
                      most = {at + forth->low - slack, at + forth->high + slack};
        bool turn = largest_of(axis) < 0;
        out->axes[i] = turn ? csg_vec3_scale(axis, -1) : axis;
        out->ends[i] = turn ? (csgm_interval){-most.high, -most.low} : least;
        out->ends[3 + i] = turn ? (csgm_interval){-least.high, -least.low} : most;
        out->edges[i] =
            (csgm_interval){fmax(most.low - least.high, 0), most.high - least.low + slack};
        volume.low *= out->edges[i].low;
        volume.high *= out->edges[i].high;
    }
    out->volume = csg_interval_grown(volume.low, volume.high, ROUNDING);
    out->volume.low = fmax(out->volume.low, 0);
}

static bool is_close(const csg_orientation *o, double tolerance)
{
    bool close = true;
    for (int i = 0; i < CSG_BOX_FACES; i++)
        close &= o->reaches[i].is_found && o->reaches[i].high - o->reaches[i].low <= tolerance;
    return close;
}

/* ---- fields ------------------------------------------------------------------------------------
 */

typedef struct of_field {
    csg_measure_walk *walk;
    uint64_t most_cubes, cubes;
} of_field;

static csgm_status reach_of_field(void *user, const csg_vec3 *directions, size_t count,
                                  double tolerance, csg_support_point *out)
{
    of_field *f = user;
    csgm_status status =
        csg_measure_reaches(f->walk, directions, count, tolerance, f->most_cubes, out);
    for (size_t i = 0; i < count; i++)
        f->cubes += out[i].cubes;
    return status;
}

csgm_status csg_oriented_box_of_field(csgm_context *context, const csgm_field *field,
                                      const csgm_measure_options *options, csgm_oriented_box *out)
{
    CSG_ZONE(context, "oriented box");
    enum { SHARE = 256 /* of all cubes, for one direction */ };
    csg_mesh_watch watch = {0};
    csg_measure_walk walk;
    csg_orientation found;
    csgm_status status = csg_measure_check_bounds(context, field->bounds);
    if (status != CSGM_OK)
        return status;
    double size = csg_box_longest_side(field->bounds), tolerance = options->tolerance * size;
    csg_mesh_watch_begin(&watch, context, &options->monitor, 0);
    csg_mesh_take(&watch, CSGM_STAGE_MEASURE, 1);
    status = csg_measure_walk_begin(&walk, context, field, &watch);
    if (status == CSGM_OK) {
        of_field of = {.walk = &walk, .most_cubes = options->most_cubes / SHARE + 1};
        status =
            csg_orientation_find(&context->memory, reach_of_field, &of, size, tolerance, &found);
        if (status == CSGM_ERR_MEMORY)
            csg_context_no_memory(context);
        tell(&found, field->center, size, out);
        out->cubes = of.cubes;
        out->is_reached = is_close(&found, 1.001 * tolerance);
    }
    csg_measure_walk_release(&walk);
    return status;
}

/* ---- meshes ------------------------------------------------------------------------------------
 */

typedef struct of_mesh {
    csgm_context *context;
    csg_mesh_watch *watch;
    csg_mesh_points points;
    const csg_vec3 *directions;
    csg_support_point *out;
} of_mesh;

static bool reach_of_points(void *user, uint32_t worker, size_t index)
{
    of_mesh *m = user;
    csg_vec3 d = m->directions[index];
    csg_support_point *out = &m->out[index];
    double most = -INFINITY;
    (void)worker;
    if (csg_mesh_should_stop(m->watch))
        return false;
    for (size_t i = 0; i < m->points.count; i++) {
        double at = csg_vec3_dot(d, m->points.items[i]);
        if (at > most) {
            most = at;
            out->at = m->points.items[i];
        }
    }
    out->low = out->high = most;
    out->is_found = true;
    return true;
}

static csgm_status reach_of_mesh(void *user, const csg_vec3 *directions, size_t count,
                                 double tolerance, csg_support_point *out)
{
    of_mesh *m = user;
    (void)tolerance;
    m->directions = directions;
    m->out = out;
    for (size_t i = 0; i < count; i++)
        out[i] = (csg_support_point){.low = -INFINITY, .high = INFINITY};
    if (csg_pool_run(m->context->pool, count, reach_of_points, NULL, m))
        return CSGM_OK;
    return csg_mesh_why_stopped(m->watch);
}

csgm_status csg_oriented_box_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                     const csgm_measure_options *options, csgm_oriented_box *out)
{
    CSG_ZONE(context, "oriented box");
    static const double OF_MESHES = 1e-9; /* how much smaller another box must be */
    csg_mesh_watch watch = {0};
    of_mesh of = {.context = context, .watch = &watch};
    csg_orientation found;
    if (!mesh->triangle_count)
        return csg_measure_refuse_empty(context);
    csg_mesh_watch_begin(&watch, context, &options->monitor, 0);
    csg_mesh_take(&watch, CSGM_STAGE_MEASURE, 1);
    csgm_status status = csg_mesh_points_gather(&of.points, context, mesh);
    if (status == CSGM_OK) {
        double size = of.points.size;
        status = csg_orientation_find(&context->memory, reach_of_mesh, &of, size, OF_MESHES * size,
                                      &found);
        if (status == CSGM_ERR_MEMORY)
            csg_context_no_memory(context);
        tell(&found, csg_vec3_add(of.points.origin, mesh->origin), size, out);
        out->is_reached = status == CSGM_OK;
    }
    csg_mesh_points_release(&of.points, context);
    return status;
}
