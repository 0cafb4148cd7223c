/* SPDX-License-Identifier: MIT
 * Meshes of others in the public interface: mended, smoothed, then thinned out and improved until
 * the distance that diff proves is what was asked for.
 */
#include <math.h>

#include "api/options.h"
#include "api/view.h"
#include "base/mesh_codes.h"
#include "csgmesh/reshaping.h"
#include "diff/diff.h"
#include "mesh/foreign/foreign.h"
#include "mesh/view.h"

csgm_reshape_options csgm_reshape_options_default(void)
{
    return (csgm_reshape_options){.struct_size = sizeof(csgm_reshape_options)};
}

csgm_reshape_stats csgm_reshape_stats_default(void)
{
    return (csgm_reshape_stats){.struct_size = sizeof(csgm_reshape_stats)};
}

bool csgm_mesh_unit(const csgm_mesh *mesh, csgm_unit *unit)
{
    if (!mesh || !unit || !mesh->says_unit)
        return false;
    *unit = mesh->unit;
    return true;
}

const char *csgm_mesh_left_out(const csgm_mesh *mesh)
{
    return mesh ? mesh->left_out : NULL;
}

bool csgm_reshape_available(void)
{
    return csg_halfedges_available();
}

static bool is_sound(const csgm_reshape_options *o)
{
    int goals = (o->simplify_error > 0) + (o->simplify_share > 0) + (o->triangles > 0);
    return goals <= 1 && o->simplify_error >= 0 && isfinite(o->simplify_error) &&
           o->simplify_share >= 0 && o->simplify_share < 1;
}

typedef struct task {
    csgm_context *context;
    const csgm_reshape_options *options;
    csg_mesh_watch watch;
    csgm_mesh *mended; /* and smoothed: what the rest is measured against */
    csgm_mesh *first;  /* mended alone, where it was smoothed */
} task;

/* Is the largest distance within the tolerance? That is proven either way; `lower` and `upper` are
 * what was known by then. */
static csgm_status compare(task *t, const csgm_mesh *from, const csgm_mesh *to, double tolerance,
                           double *lower, double *upper)
{
    csgm_diff_options options = csgm_diff_options_default();
    csgm_mesh_view a = csg_mesh_view(from), b = csg_mesh_view(to);
    csgm_diff *diff;
    options.tolerance = tolerance;
    options.ignored = CSGM_DIFF_IGNORE_ORDER | CSGM_DIFF_IGNORE_NORMALS | CSGM_DIFF_IGNORE_COLORS |
                      CSGM_DIFF_IGNORE_NAMES | CSGM_DIFF_IGNORE_TOPOLOGY;
    options.samples = 4096;
    options.verdict_only = true;
    options.monitor = t->options->monitor;
    csgm_status status = csg_diff_run(t->context, &a, &b, &options, &diff);
    if (status != CSGM_OK)
        return status;
    const csgm_diff_report *r = csgm_diff_get_report(diff);
    bool is_same = r->level == CSGM_DIFF_SAME_TRIANGLES;
    *lower = is_same ? 0 : r->hausdorff_lower;
    *upper = is_same ? 0 : r->is_different ? INFINITY : r->hausdorff_upper;
    csg_diff_destroy(diff);
    return CSGM_OK;
}

/* The largest distance to within a sixth: where much is equally far, as after thinning out, more
 * would take minutes. What is found is enlarged until it is proven to be enough. */
static csgm_status measure(task *t, const csgm_mesh *from, const csgm_mesh *to, double *lower,
                           double *upper)
{
    static const double WIDTH = 1.15;
    double found, tolerance = 0;
    *lower = 0;
    for (;;) {
        csgm_status status = compare(t, from, to, tolerance, &found, upper);
        *lower = fmax(*lower, found);
        if (status != CSGM_OK || *upper <= fmax(tolerance, *lower) || !isfinite(found))
            return status;
        tolerance = WIDTH * fmax(*lower, tolerance);
    }
}

static csgm_status prepare(task *t, const csgm_mesh_view *mesh)
{
    csg_foreign_goals mend = {.tells = true};
    csg_foreign_goals smooth = {.smooth = t->options->smooth};
    csgm_status status = csg_foreign_reshape(&t->watch, mesh, &mend, &t->mended);
    if (status != CSGM_OK || !smooth.smooth)
        return status;
    csgm_mesh_view view = csg_mesh_view(t->mended);
    csg_mesh_take(&t->watch, CSGM_STAGE_RESHAPE, 0.5);
    t->first = t->mended;
    t->mended = NULL;
    return csg_foreign_reshape(&t->watch, &view, &smooth, &t->mended);
}

static double share_of(const task *t)
{
    const csgm_reshape_options *o = t->options;
    double have = (double)t->mended->triangle_count;
    if (o->triangles && have > 0)
        return (double)o->triangles < have ? (double)o->triangles / have : 0;
    return o->simplify_share;
}

/* Changes what was prepared; with a bound anew, within less, until diff proves it. */
static csgm_status change(task *t, csgm_mesh **out, csgm_reshape_stats *stats)
{
    enum { TRIES = 6 };
    const csgm_reshape_options *o = t->options;
    csgm_mesh_view view = csg_mesh_view(t->mended);
    double allowed = o->simplify_error, lower = 0, upper = INFINITY;
    if (!(allowed > 0) && o->improve)
        allowed = csgm_quality_tolerance(CSGM_QUALITY_NORMAL, csg_view_bounds(&view));
    bool is_bounded = o->simplify_error > 0 || (o->improve && !(share_of(t) > 0));
    double within = 0.8 * allowed; /* OpenMesh looks at vertices, and at one side of it */
    csgm_status status = CSGM_OK;
    for (int i = 0; i < TRIES && status == CSGM_OK; i++) {
        csg_foreign_goals goals = {.within = o->simplify_error > 0 ? within : 0,
                                   .share = share_of(t),
                                   .improve = o->improve ? within / 2 : 0};
        csg_mesh_take(&t->watch, CSGM_STAGE_RESHAPE, 0.8);
        csgm_mesh_destroy(*out);
        *out = NULL;
        status = csg_foreign_reshape(&t->watch, &view, &goals, out);
        if (status != CSGM_OK || !is_bounded)
            break;
        status = compare(t, t->mended, *out, allowed, &lower, &upper);
        if (status == CSGM_OK && upper <= allowed)
            break;
        within *= status == CSGM_OK ? fmin(0.7, 0.8 * allowed / lower) : 1;
    }
    if (status == CSGM_OK && is_bounded && !(upper <= allowed)) {
        csgm_mesh_destroy(*out); /* what was read is as near as can be */
        *out = NULL;
        status = csg_foreign_reshape(&t->watch, &view, &(csg_foreign_goals){.within = 0}, out);
        lower = upper = 0;
    }
    stats->distance_lower = lower;
    stats->distance_upper = upper;
    return status;
}

static csgm_status reshape(task *t, const csgm_mesh_view *mesh, csgm_mesh **out,
                           csgm_reshape_stats *stats)
{
    const csgm_reshape_options *o = t->options;
    csgm_status status = prepare(t, mesh);
    if (status != CSGM_OK)
        return status;
    stats->mended_triangles = (t->first ? t->first : t->mended)->triangle_count;
    if (o->simplify_error > 0 || share_of(t) > 0 || o->improve) {
        status = change(t, out, stats);
    } else {
        *out = t->mended;
        t->mended = NULL;
    }
    const csgm_mesh *from = t->first ? t->first : t->mended;
    bool is_known = !t->first && stats->distance_upper < INFINITY;
    if (status == CSGM_OK && from && !is_known)
        status = measure(t, from, *out, &stats->distance_lower, &stats->distance_upper);
    return status;
}

csgm_status csgm_mesh_reshape(csgm_context *context, const csgm_mesh_view *mesh,
                              const csgm_reshape_options *options, csgm_mesh **out,
                              csgm_reshape_stats *stats)
{
    csgm_reshape_options own = csgm_reshape_options_default();
    csgm_reshape_stats made = csgm_reshape_stats_default();
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !csg_view_is_sound(mesh) || !csg_options_adopt(&own, sizeof own, options) ||
        !is_sound(&own) || !csg_struct_is_known(stats, sizeof *stats) ||
        !csg_view_is_finite(mesh) || !csg_view_is_in_range(mesh))
        return CSGM_ERR_ARGUMENT;
    bool asks = own.simplify_error > 0 || own.simplify_share > 0 || own.triangles || own.improve ||
                own.smooth;
    if (asks && !csg_halfedges_available()) {
        csg_diag_plain(&context->diags, CSG_DIAG_NO_LIBRARY, NULL, NULL,
                       "this build has no OpenMesh, which changes meshes of others");
        return CSGM_ERR_UNSUPPORTED;
    }
    task t = {.context = context, .options = &own};
    csg_mesh_watch_begin(&t.watch, context, &own.monitor, 0);
    csg_mesh_take(&t.watch, CSGM_STAGE_RESHAPE, 0.1);
    csgm_status status = reshape(&t, mesh, out, &made);
    csgm_mesh_destroy(t.first);
    csgm_mesh_destroy(t.mended);
    if (status != CSGM_OK) {
        csgm_mesh_destroy(*out);
        *out = NULL;
        return status;
    }
    csg_struct_deliver(stats, &made);
    return CSGM_OK;
}
