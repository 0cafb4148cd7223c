/* SPDX-License-Identifier: MIT
 * Resolution, tries, and what is said at the end; see tolerance.h.
 */
#include "mesh/reshape/tolerance.h"

#include <math.h>

#include "base/clock.h"
#include "mesh/reshape/decimate.h"
#include "mesh/reshape/improve.h"
#include "mesh/reshape/refine.h"

/* ---- which resolution -------------------------------------------------------------------------
 */

/* How far the triangles of equal cells stray from the surface, but for a fiftieth of them, and
 * for those that cut off a crease: these do not get better with the square of the cell. */
static bool find_deviation(csg_remesh *r, double *out)
{
    static const double CUT = 0.1; /* of the longest side */
    size_t count = r->corners.triangle_count, n = 0;
    float *values = csg_memory_alloc(r->memory, count * sizeof *values);
    if (!values)
        return false;
    csg_remesh_values_at_centroids(r, values);
    for (uint32_t t = 0; t < count; t++) {
        csg_vec3 a = csg_remesh_corner(r, 3 * t), b = csg_remesh_corner(r, 3 * t + 1);
        double side = csg_vec3_norm(csg_vec3_sub(a, b)), f = fabs((double)values[t]);
        if (f < CUT * fmax(side, 0.5 * r->cell))
            values[n++] = (float)f;
    }
    *out = csg_remesh_common_value(values, n) / (double)r->probe.marching->field->tape.lipschitz;
    csg_memory_release(r->memory, values, count * sizeof *values);
    return true;
}

/* Cells whose triangles stray by six tenths of the error: theirs grows with their square. */
static csgm_status choose_cells(csg_remesh *r, csg_mesh_goal *goal)
{
    static const double ROOM = 1, CLOSE_ENOUGH = 0.8, LEAST_STEP = 0.25;
    double deviation;
    if (!find_deviation(r, &deviation))
        return csg_context_no_memory(r->work->context);
    double factor = sqrt(ROOM * goal->error / fmax(deviation, 1e-30));
    if (factor < CLOSE_ENOUGH && !goal->is_last)
        goal->cell_size = r->cell * fmax(factor, LEAST_STEP);
    return CSGM_OK;
}

/* ---- one try ----------------------------------------------------------------------------------
 */

/* With errors that double until few enough triangles are left. */
static csgm_status reach_share(csg_decimation *d, csg_mesh_goal *goal)
{
    csg_remesh *r = d->remesh;
    uint32_t least = (uint32_t)ceil(goal->share * (double)goal->begun);
    double most = 0.25 * csg_lattice_extent(&r->work->lattice);
    csgm_status status = CSGM_OK;
    r->error = r->cell / 64;
    for (;;) {
        status = csg_decimate(d, least);
        if (status != CSGM_OK || r->corners.live <= least + 1 || r->error * 2 > most)
            break;
        r->error *= 2;
    }
    goal->tight = r->corners.live > least + 1;
    return status;
}

static csgm_status thin_out(csg_remesh *r, csg_mesh_goal *goal, const csg_missed *missed)
{
    csg_decimation d;
    r->error = goal->care * goal->error;
    csgm_status status = csg_decimation_begin(&d, r, missed);
    if (status != CSGM_OK)
        return status;
    status = goal->share > 0 ? reach_share(&d, goal) : csg_decimate(&d, 4);
    goal->measured = csg_decimation_largest_distance(&d);
    csg_decimation_end(&d);
    return status;
}

/* The bound that is proven. */
static csgm_status prove(csg_remesh *r, csg_mesh_goal *goal)
{
    csg_distance_proof proof;
    goal->allowed = goal->error > 0 ? goal->error : r->error;
    goal->bound = INFINITY;
    if (goal->share >
        0) /* a proof might refine it again: every collapse was checked, that is all */
        return CSGM_OK;
    csgm_status status = csg_refine_until_near(r, goal->allowed, &proof);
    if (status != CSGM_OK)
        return status;
    goal->unproven = proof.stopped;
    goal->open = proof.stopped ? 0 : proof.open;
    goal->bound = goal->open || proof.stopped ? INFINITY : goal->allowed;
    goal->place = csg_vec3_add(proof.place, r->work->field->center);
    return CSGM_OK;
}

/* What the cells are too large for; where they are free, smaller ones are asked for. */
static csgm_status find_missed(csg_remesh *r, csg_mesh_goal *goal, csg_missed *missed)
{
    *missed = (csg_missed){0};
    if (!(goal->error > 0))
        return CSGM_OK;
    csgm_status status = csg_missed_find(r, goal->error, missed);
    if (status == CSGM_OK && goal->chooses && !goal->is_last && missed->farthest > goal->error)
        goal->cell_size = 0.5 * r->cell;
    goal->unfinished = missed->unfinished;
    return status;
}

static csgm_status reshape(csg_remesh *r, csg_mesh_goal *goal)
{
    goal->begun = r->corners.live;
    csgm_status status = goal->chooses ? choose_cells(r, goal) : CSGM_OK;
    if (status != CSGM_OK || goal->cell_size > 0)
        return status;
    bool thins = goal->error > 0 || goal->share > 0;
    csg_missed missed;
    status = find_missed(r, goal, &missed);
    if (status == CSGM_OK && thins && !(goal->cell_size > 0))
        status = thin_out(r, goal, &missed);
    csg_missed_release(&missed, r->memory);
    if (status != CSGM_OK || goal->cell_size > 0)
        return status;
    if (status == CSGM_OK && goal->improve)
        status = csg_improve(r, thins);
    if (status == CSGM_OK && thins && goal->chooses && goal->measured > goal->error &&
        !goal->is_last)
        goal->cell_size = 0.6 * r->cell; /* the lattice is too coarse for its own samples */
    else if (status == CSGM_OK && thins)
        status = prove(r, goal);
    if (status == CSGM_OK && goal->open && !goal->is_last)
        goal->cell_size = goal->chooses ? 0.6 * r->cell : r->cell;
    if (status == CSGM_OK && !(goal->cell_size > 0))
        status = csg_remesh_write_back(r, goal->normals != CSGM_NORMALS_NONE,
                                       goal->normals == CSGM_NORMALS_CREASE);
    return status;
}

csgm_status csg_mesh_reshape(csg_mesh_work *work)
{
    csg_remesh remesh;
    double begin_s = csg_clock_now_s();
    csgm_status status = csg_remesh_begin(&remesh, work);
    if (status == CSGM_OK) {
        status = reshape(&remesh, work->goal);
        csg_remesh_end(&remesh);
    }
    work->goal->reshape_s += csg_clock_now_s() - begin_s;
    return status;
}

/* ---- all tries ---------------------------------------------------------------------------------
 */

static void tell(csgm_context *context, const csg_mesh_goal *goal, bool chooses)
{
    if (goal->open)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL,
                       chooses ? "raise the tolerance"
                               : "raise -r, or give -e alone: it chooses the resolution",
                       "at %llu places the mesh could not be shown to be within %g of the surface, "
                       "first at %g,%g,%g",
                       (unsigned long long)goal->open, goal->allowed, goal->place.x, goal->place.y,
                       goal->place.z);
    if (goal->error > 0 && goal->measured > goal->error)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL, "raise -r, or the tolerance",
                       "a place of the surface is %g from the mesh, more than %g", goal->measured,
                       goal->error);
    if (goal->unproven)
        csg_diag_plain(
            &context->diags, CSG_DIAG_NOT_WITHIN, NULL, "raise the tolerance",
            "the distance of the mesh is %g as measured; to prove it below %g would take "
            "too long",
            goal->measured, goal->allowed);
    if (goal->unfinished)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL, "raise the tolerance",
                       "%llu stretches of the surface are too intricate to look for parts in them "
                       "that the mesh misses",
                       (unsigned long long)goal->unfinished);
    if (goal->tight)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL, NULL,
                       "fewer triangles were asked for than the shape allows");
}

static void fill_stats(csgm_mesh_stats *stats, const csg_mesh_goal *goal)
{
    stats->reshape_s = goal->reshape_s;
    stats->triangles_before = goal->begun;
    if (!(goal->error > 0) && !(goal->share > 0))
        return;
    stats->is_measured = true;
    stats->max_distance_bound = goal->bound;
    stats->max_distance_measured = goal->measured;
    stats->distance_allowed = goal->allowed;
    stats->open_places = goal->open;
}

static double longest_side(const csgm_field *field, const csgm_mesh_options *options)
{
    csg_box box = csg_box_is_empty(options->bounds) ? field->bounds : options->bounds;
    csg_vec3 size = csg_box_size(box);
    return fmax(size.x, fmax(size.y, size.z));
}

csgm_status csg_mesh_build_reshaped(csgm_context *context, const csgm_field *field,
                                    const csgm_mesh_options *options, const csg_mesh_share *share,
                                    csgm_mesh **out, csgm_mesh_stats *stats)
{
    enum { MOST_TRIES = 6, FIRST_CELLS = 64, MOST_CELLS = 768 };
    csgm_mesh_options base = *options;
    csg_mesh_goal goal = {
        .error = options->tolerance > 0 ? options->tolerance : options->simplify_error,
        .share = options->simplify_share,
        .improve = options->improve,
        .chooses = options->tolerance > 0 && !options->resolution && !(options->cell_size > 0),
        .normals = options->normals,
        .care = 0.85,
        .started_s = csg_clock_now_s()};
    base.normals = CSGM_NORMALS_NONE;
    if (goal.chooses)
        base.resolution = FIRST_CELLS;
    double least = longest_side(field, options) / MOST_CELLS;
    bool was_open = false; /* once more, with more care: what is open then stays so */
    csgm_status status;
    for (;; goal.tries++) {
        goal.is_last = goal.tries + 1 >= MOST_TRIES || was_open ||
                       (goal.chooses && base.cell_size > 0 && base.cell_size <= least) ||
                       (!goal.chooses && goal.tries + 1 >= 2);
        goal.cell_size = 0;
        status = csg_mesh_build_with(context, field, &base, share, &goal, out, stats);
        if (status != CSGM_OK || !(goal.cell_size > 0))
            break;
        csg_mesh_destroy(*out);
        was_open = goal.open > 0;
        if (was_open)
            goal.care *= 0.8;
        goal.open = 0;
        base.cell_size = fmax(goal.cell_size, goal.chooses ? least : 0);
    }
    if (status != CSGM_OK)
        return status;
    tell(context, &goal, goal.chooses);
    if (stats)
        fill_stats(stats, &goal);
    return CSGM_OK;
}
