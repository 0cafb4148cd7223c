/* SPDX-License-Identifier: MIT
 * Which resolution, how often, and what is said at the end; see tries.h.
 */
#include "mesh/pipeline/tries.h"

#include <math.h>

#include "base/clock.h"
#include "base/mesh_codes.h"

/* follows: the cells follow the shape, there is no -r to raise. */
static const char *hint_at_far_place(const csgm_mesh_options *options, bool follows)
{
    if (!follows)
        return "raise -r, or the tolerance";
    if (options->tolerance > 0)
        return "raise the tolerance";
    if (options->simplify_error > 0 || options->quality == CSGM_QUALITY_FINE)
        return "-e keeps within a tolerance, and proves it";
    return "--quality fine comes nearer, -e keeps within a tolerance and proves it";
}

static void report_misses(csgm_context *context, const csg_mesh_goal *goal,
                          const csgm_mesh_options *options, bool follows)
{
    if (goal->open)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL,
                       goal->chooses || follows
                           ? "raise the tolerance"
                           : "raise -r, or give -e alone: its cells follow the shape",
                       "at %llu places the mesh could not be shown to be within %g of the surface, "
                       "first at %g,%g,%g",
                       (unsigned long long)goal->open, goal->allowed, goal->place.x, goal->place.y,
                       goal->place.z);
    if (goal->error > goal->asked)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL,
                       "mesh thin or intricate parts by themselves, or give -r",
                       "a tolerance of %g would take too many cells: the mesh is within %g",
                       goal->asked, goal->error);
    bool has_count = goal->triangles || goal->share > 0; /* then the error grows until it is met */
    if (goal->error > 0 && !has_count && goal->measured > goal->error)
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_WITHIN, NULL,
                       hint_at_far_place(options, follows),
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

static csg_box box_of(const csgm_field *field, const csgm_mesh_options *options)
{
    return csg_box_is_empty(options->bounds) ? field->bounds : options->bounds;
}

static double longest_side(const csgm_field *field, const csgm_mesh_options *options)
{
    return csg_box_longest_side(box_of(field, options));
}

double csg_mesh_tries_tolerance(const csgm_field *field, const csgm_mesh_options *options,
                                const csg_mesh_share *share)
{
    csg_box bounds = box_of(field, options);
    if (!share) /* parts have one tolerance */
        bounds = csg_mesh_box_within(bounds, field->bounds);
    return csg_mesh_quality_tolerance(options->quality, bounds);
}

csgm_status csg_mesh_build_tries(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, const csg_mesh_share *share,
                                 csgm_mesh *own, csgm_mesh **out, csgm_mesh_stats *stats)
{
    enum { MOST_TRIES = 6, FIRST_CELLS = 64, MOST_CELLS = 768 };
    csgm_mesh_options base = *options;
    bool follows = csg_mesh_is_adaptive(options); /* its cells follow the shape */
    bool proves = options->tolerance > 0;
    csg_mesh_goal goal = {.error = proves ? options->tolerance : options->simplify_error,
                          .share = options->simplify_share,
                          .improve = options->improve,
                          .triangles = options->triangles,
                          .proves = !follows || proves,
                          .sharp = options->features == CSGM_FEATURES_SHARP,
                          .chooses = !follows && proves && !options->resolution &&
                                     !(options->cell_size > 0),
                          .follows = follows,
                          .own = own,
                          .finer = 1,
                          .normals = options->normals,
                          .care = 0.85,
                          .started_s = csg_clock_now_s()};
    base.normals = CSGM_NORMALS_NONE;
    if (follows && !(goal.error > 0))
        goal.error = csg_mesh_tries_tolerance(field, options, share);
    goal.asked = goal.error;
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
        status = follows ? csg_mesh_build_adaptive(context, field, &base, share, &goal, out, stats)
                         : csg_mesh_build_field(context, field, &base, share, &goal, out, stats);
        if (status != CSGM_OK || !(goal.cell_size > 0))
            break;
        csg_mesh_destroy(*out);
        *out = NULL; /* the next try may fail */
        was_open = goal.open > 0;
        if (was_open)
            goal.care *= 0.8;
        goal.finer *= 0.25; /* whole parts are missing, a closer look did not help */
        goal.measured = 0;
        goal.open = 0;
        base.cell_size = fmax(goal.cell_size, goal.chooses ? least : 0);
    }
    if (status != CSGM_OK)
        return status;
    report_misses(context, &goal, options, follows);
    if (stats)
        fill_stats(stats, &goal);
    return CSGM_OK;
}
