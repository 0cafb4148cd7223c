/* SPDX-License-Identifier: MIT
 * The order of a comparison: the same triangles? else distances of points, averages, the maximum
 * between bounds, volumes; then attributes, topology and the verdict. Within it lengths are in the
 * frame's units, in the report in those of the scene.
 */
#include <string.h>

#include "base/mesh_codes.h"
#include "base/trace.h"
#include "diff/attributes.h"
#include "diff/diff.h"
#include "diff/distances.h"
#include "diff/field.h"
#include "diff/match.h"
#include "diff/maximum.h"
#include "diff/volume.h"

typedef struct comparison {
    csg_diff_pair pair;
    const csgm_diff_options *options;
    csgm_diff *diff;
    csgm_diff_report *report;
    csg_diff_match match;
    bool same; /* the same triangles */
    bool is_empty[2];
    bool counts_all; /* added and removed material alike */
    double limit;    /* the tolerance as applied, frame units */
    double slack;
    csg_box differing;
    double started_s;
    atomic_bool *timed_out;
} comparison;

static double to_scene(const comparison *c, double length)
{
    return length * c->pair.frame.unscale;
}

/* ---- figures -------------------------------------------------------------------------------- */

static void fill_figures(comparison *c)
{
    for (int i = 0; i < 2; i++) {
        const csg_diff_side *side = &c->pair.sides[i];
        c->report->figures[i] =
            (csgm_diff_figures){.vertices = side->view->vertex_count,
                                .triangles = side->view->triangle_count,
                                .check = side->check,
                                .is_closed = side->is_closed,
                                .has_normals = side->view->normals,
                                .has_colors = side->view->colors,
                                .parts = side->view->part_count ? side->view->part_count : 1};
    }
}

static void set_tolerance(comparison *c)
{
    const csgm_diff_options *o = c->options;
    csgm_diff_report *r = c->report;
    csg_diff_pair *pair = &c->pair;
    c->slack = fmax(pair->sides[0].slack, pair->sides[1].slack);
    pair->precision = fmax(pair->precision, 4 * c->slack);
    double diagonal = csg_box_is_empty(r->figures[0].check.bounds)
                          ? 0
                          : csg_vec3_norm(csg_box_size(r->figures[0].check.bounds));
    double relative = o->tolerance_relative > 0 ? o->tolerance_relative * diagonal : 0;
    r->tolerance = fmax(o->tolerance, relative);
    r->precision = to_scene(c, pair->precision);
    c->limit = fmax(r->tolerance * pair->frame.scale, pair->precision);
    r->is_turned = pair->sides[1].turn != CSG_DIFF_AS_IT_IS;
    r->turn = (int)pair->sides[1].turn;
    c->counts_all =
        o->material == CSGM_DIFF_ANY_MATERIAL || !((pair->sides[0].is_closed || c->is_empty[0]) &&
                                                   (pair->sides[1].is_closed || c->is_empty[1]));
}

/* ---- distances ------------------------------------------------------------------------------ */

/* What need not be known better than below it. */
static double indifferent(const comparison *c)
{
    return isfinite(c->limit) ? fmax(0, c->limit - 2 * c->slack) : 0;
}

static void set_first_place(comparison *c, const csg_diff_maximum *search, csgm_diff_distance *out)
{
    const csg_diff_side *other = &c->pair.sides[1 - search->from];
    bool in_face;
    if (!search->is_found)
        return;
    csg_triangle_hit nearest = csg_tree_nearest(&other->tree, search->at, 0);
    csg_vec3 foot = csg_triangle_foot(&other->tree.triangles[nearest.place], search->at, &in_face);
    out->worst[0] = (csgm_diff_place){csg_triangle_frame_leave(&c->pair.frame, search->at),
                                      csg_triangle_frame_leave(&c->pair.frame, foot),
                                      to_scene(c, search->lower)};
    out->worst_count = 1;
}

static void take_maximum(comparison *c, const csg_diff_maximum *search, csgm_diff_distance *out)
{
    out->is_measured = true;
    out->lower = to_scene(c, fmax(0, search->lower - c->slack));
    out->upper = to_scene(c, search->upper + c->slack);
    out->is_refined = search->is_refined &&
                      (out->upper <= 1.01 * out->lower || out->upper <= to_scene(c, c->limit) ||
                       search->upper <= search->floor);
    set_first_place(c, search, out);
}

static csgm_status measure_direction(comparison *c, int from)
{
    CSG_ZONE(c->pair.context, from ? "from B to A" : "from A to B");
    csgm_diff_distance *out = &c->report->distance[from];
    csg_diff_maximum search = {.from = from,
                               .tolerance = indifferent(c),
                               .verdict_only = c->options->verdict_only && c->counts_all};
    csgm_status status = CSGM_OK;
    if (!c->options->verdict_only) {
        csgm_diff_place largest;
        bool compares_colors = from == 1 && !(c->options->ignored & CSGM_DIFF_IGNORE_COLORS) &&
                               c->pair.sides[0].view->colors && c->pair.sides[1].view->colors;
        status = csg_diff_measure_samples(&c->pair, from, c->options->samples, out,
                                          compares_colors ? &c->report->colors : NULL, &largest);
        search.lower = largest.distance;
        search.at = largest.at;
        search.is_found = true;
    }
    if (status == CSGM_OK)
        status = csg_diff_find_maximum(&c->pair, &search);
    if (status != CSGM_OK)
        return status;
    take_maximum(c, &search, out);
    c->differing = csg_box_hull(c->differing, search.differing);
    if (!c->options->verdict_only)
        csg_diff_find_worst(&c->pair, from, out);
    return CSGM_OK;
}

/* Where the surfaces meet, ever smaller pieces would be needed to tell the sides: what is below
 * this part of the largest distance is not told from nothing. */
static const double COUNTED_FLOOR = 1e-3;

/* Added material is bounded by what of B lies outside A and by what of A lies inside B. */
static csgm_status measure_counted(comparison *c)
{
    csgm_diff_distance *out = &c->report->counted;
    bool added = c->options->material == CSGM_DIFF_ADDED;
    double most = fmax(c->report->distance[0].upper, c->report->distance[1].upper);
    *out = (csgm_diff_distance){.is_measured = true, .is_refined = true};
    for (int from = 0; from < 2; from++) {
        csg_diff_maximum search = {.from = from,
                                   .wanted = (from == 1) == added ? CSG_DIFF_POINTS_OUTSIDE
                                                                  : CSG_DIFF_POINTS_INSIDE,
                                   .tolerance = indifferent(c),
                                   .floor = COUNTED_FLOOR * c->pair.frame.scale * most,
                                   .verdict_only = c->options->verdict_only};
        csgm_status status = csg_diff_find_maximum(&c->pair, &search);
        if (status != CSGM_OK)
            return status;
        csgm_diff_distance found = {.lower = -1};
        take_maximum(c, &search, &found);
        out->is_refined = out->is_refined && found.is_refined;
        out->upper = fmax(out->upper, found.upper);
        if (found.lower > out->lower) {
            out->lower = found.lower;
            out->worst[0] = found.worst[0];
            out->worst_count = found.worst_count;
        }
    }
    return CSGM_OK;
}

static csgm_status measure_distances(comparison *c)
{
    CSG_ZONE(c->pair.context, "distances");
    csgm_status status = csg_diff_measure_points(&c->pair);
    for (int from = 0; from < 2 && status == CSGM_OK; from++)
        status = measure_direction(c, from);
    if (status == CSGM_OK && !c->counts_all)
        status = measure_counted(c);
    return status;
}

/* One side has nothing to be near to, or they are the same. */
static void set_known_distances(comparison *c)
{
    for (int from = 0; from < 2; from++) {
        double d = c->is_empty[from] || c->same ? 0 : INFINITY;
        c->report->distance[from] = (csgm_diff_distance){.is_measured = true,
                                                         .lower = d,
                                                         .upper = d,
                                                         .is_refined = true,
                                                         .is_sampled = true,
                                                         .mean = d,
                                                         .rms = d,
                                                         .percentile_95 = d,
                                                         .percentile_99 = d};
    }
}

/* ---- volumes -------------------------------------------------------------------------------- */

/* Of a side that stands alone. */
static double whole_volume(const comparison *c, int i)
{
    return c->is_empty[i] ? 0 : fabs(c->pair.sides[i].check.volume);
}

static csgm_status measure_volume(comparison *c)
{
    CSG_ZONE(c->pair.context, "volume");
    csgm_diff_volume *out = &c->report->volume;
    for (int i = 0; i < 2; i++)
        if (!c->is_empty[i] && !c->pair.sides[i].is_closed)
            return CSGM_OK;
    if (c->options->verdict_only && !c->same && !isfinite(c->options->tolerance_volume))
        return CSGM_OK;
    if (!c->same && !c->is_empty[0] && !c->is_empty[1])
        return csg_diff_measure_volume(&c->pair, c->differing, c->options->samples, out);
    *out = (csgm_diff_volume){.is_measured = true};
    if (c->same) {
        out->both = whole_volume(c, 0);
    } else {
        out->only_a = whole_volume(c, 0);
        out->only_b = whole_volume(c, 1);
        out->ratio = out->only_a + out->only_b > 0;
    }
    return CSGM_OK;
}

/* ---- attributes and topology ---------------------------------------------------------------- */

static csgm_status compare_attributes(comparison *c)
{
    CSG_ZONE(c->pair.context, "attributes");
    uint32_t ignored = c->options->ignored;
    csgm_diff_report *r = c->report;
    if (c->is_empty[0] || c->is_empty[1])
        return CSGM_OK;
    if (c->same && !(ignored & CSGM_DIFF_IGNORE_NORMALS))
        csg_diff_compare_normals(&c->pair, &c->match, &r->normals);
    if (c->same && !(ignored & CSGM_DIFF_IGNORE_COLORS))
        csg_diff_compare_colors(&c->pair, &c->match, &r->colors);
    if (!c->same && !(ignored & CSGM_DIFF_IGNORE_COLORS) &&
        r->figures[0].has_colors != r->figures[1].has_colors)
        r->colors = (csgm_diff_attribute){true, 255, 1};
    if (!(ignored & CSGM_DIFF_IGNORE_NAMES))
        return csg_diff_compare_names(&c->pair, ignored & CSGM_DIFF_IGNORE_ORDER, &r->names);
    return CSGM_OK;
}

static bool topology_differs(const csgm_diff_report *r)
{
    const csgm_diff_figures *a = &r->figures[0], *b = &r->figures[1];
    if (a->check.components != b->check.components || a->is_closed != b->is_closed)
        return true;
    return a->is_closed && a->check.nonmanifold_edges == 0 && b->check.nonmanifold_edges == 0 &&
           a->check.genus != b->check.genus;
}

/* ---- the verdict ---------------------------------------------------------------------------- */

static bool empty_counts(const comparison *c)
{
    if (c->is_empty[0] == c->is_empty[1])
        return false;
    bool is_removed = c->is_empty[1];
    return c->counts_all || is_removed == (c->options->material == CSGM_DIFF_REMOVED);
}

static uint32_t reasons_of(const comparison *c)
{
    const csgm_diff_report *r = c->report;
    const csgm_diff_options *o = c->options;
    uint32_t reasons = empty_counts(c) ? CSGM_DIFF_REASON_EMPTY : 0;
    if (r->level == CSGM_DIFF_NOT_EQUAL && !c->is_empty[0] && !c->is_empty[1])
        reasons |= CSGM_DIFF_REASON_DISTANCE;
    double volume = o->material == CSGM_DIFF_ADDED     ? r->volume.only_b
                    : o->material == CSGM_DIFF_REMOVED ? r->volume.only_a
                                                       : r->volume.only_a + r->volume.only_b;
    double whole = r->volume.only_a + r->volume.only_b + r->volume.both;
    if (isfinite(o->tolerance_volume) && !c->same &&
        (!r->volume.is_measured || volume > o->tolerance_volume * whole))
        reasons |= CSGM_DIFF_REASON_VOLUME;
    if (c->is_empty[0] || c->is_empty[1])
        return reasons;
    if (!(o->ignored & CSGM_DIFF_IGNORE_TOPOLOGY) && topology_differs(r))
        reasons |= CSGM_DIFF_REASON_TOPOLOGY;
    if (r->normals.is_compared && r->normals.share > 0)
        reasons |= CSGM_DIFF_REASON_NORMALS;
    if (r->colors.is_compared && r->colors.share > (c->same ? 0 : 0.005))
        reasons |= CSGM_DIFF_REASON_COLORS;
    if (r->names.is_compared && r->names.largest > 0)
        reasons |= CSGM_DIFF_REASON_NAMES;
    return reasons;
}

/* What counts is not told from nothing: neither is anything known to count. */
static bool is_uncounted(const comparison *c)
{
    const csgm_diff_report *r = c->report;
    double most = fmax(r->distance[0].upper, r->distance[1].upper);
    return r->counted.lower <= to_scene(c, c->limit) &&
           r->counted.upper <= 1.01 * COUNTED_FLOOR * most + to_scene(c, c->slack);
}

static void judge(comparison *c)
{
    csgm_diff_report *r = c->report;
    double limit = to_scene(c, c->limit);
    for (int i = 0; i < 2; i++) {
        r->hausdorff_lower = fmax(r->hausdorff_lower, r->distance[i].lower);
        r->hausdorff_upper = fmax(r->hausdorff_upper, r->distance[i].upper);
    }
    bool is_within =
        c->counts_all ? r->hausdorff_upper <= limit : r->counted.upper <= limit || is_uncounted(c);
    if (c->same)
        r->level = CSGM_DIFF_SAME_TRIANGLES;
    else if (is_within && !c->is_empty[0] && !c->is_empty[1])
        r->level = CSGM_DIFF_WITHIN_TOLERANCE;
    r->reasons = reasons_of(c);
    r->is_different = r->reasons != 0;
}

/* ---- distances of vertices ------------------------------------------------------------------ */

static csgm_status keep_vertex_distances(comparison *c)
{
    for (int i = 0; i < 2; i++) {
        const csg_diff_side *side = &c->pair.sides[i];
        if (c->is_empty[0] || c->is_empty[1])
            continue;
        size_t count = (size_t)side->view->vertex_count;
        float *out = csg_memory_alloc(&c->pair.context->memory, count * sizeof *out);
        if (!out)
            return csg_context_no_memory(c->pair.context);
        c->diff->distances[i] = out;
        memset(out, 0, count * sizeof *out);
        if (c->same)
            continue;
        /* vertices that no triangle uses have no distance of their own */
        for (size_t k = 0; k < 3 * side->chain.count; k++) {
            uint32_t vertex = side->view->indices[k];
            out[vertex] = (float)to_scene(c, side->distance[side->point_of[vertex]]);
        }
    }
    return CSGM_OK;
}

/* ---- the run -------------------------------------------------------------------------------- */

static csgm_status measure_fields(comparison *c)
{
    CSG_ZONE(c->pair.context, "field");
    const csgm_scene *const scenes[2] = {c->options->scene_b, c->options->scene_a};
    csgm_status status = CSGM_OK;
    for (int from = 0; from < 2 && status == CSGM_OK; from++)
        if (scenes[from] && !c->is_empty[from])
            status = csg_diff_measure_field(&c->pair, from, scenes[from], c->options->samples,
                                            &c->report->field[from]);
    return status;
}

static csgm_status compare(comparison *c, const csgm_mesh_view *a, const csgm_mesh_view *b)
{
    csg_diff_pair *pair = &c->pair;
    csgm_status status =
        csg_diff_pair_make(pair, pair->context, a, b, c->options->ignored & CSGM_DIFF_IGNORE_UP);
    pair->monitor = &c->options->monitor;
    pair->timed_out = c->timed_out;
    if (pair->context->limits.timeout_s > 0)
        pair->deadline_s = c->started_s + pair->context->limits.timeout_s;
    if (status == CSGM_OK)
        status = csg_diff_match_make(pair, &c->match, &c->same);
    if (status == CSGM_OK)
        status = csg_diff_pair_prepare(pair, !c->same);
    if (status != CSGM_OK)
        return status;
    for (int i = 0; i < 2; i++)
        c->is_empty[i] = pair->sides[i].chain.count == 0;
    fill_figures(c);
    set_tolerance(c);
    if (c->same || c->is_empty[0] || c->is_empty[1])
        set_known_distances(c);
    else
        status = measure_distances(c);
    if (status == CSGM_OK)
        status = measure_volume(c);
    if (status == CSGM_OK)
        status = compare_attributes(c);
    if (status == CSGM_OK)
        status = measure_fields(c);
    if (status == CSGM_OK && !c->options->verdict_only)
        status = keep_vertex_distances(c);
    if (status == CSGM_OK)
        judge(c);
    return status;
}

static csgm_status tell_timeout(csgm_context *context)
{
    csg_diag_plain(&context->diags, CSG_DIAG_TIMEOUT, NULL, "raise --timeout, or give a --tol",
                   "comparing took longer than the limit of %g s", context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}

csgm_status csg_diff_run(csgm_context *context, const csgm_mesh_view *a, const csgm_mesh_view *b,
                         const csgm_diff_options *options, csgm_diff **out)
{
    CSG_ZONE(context, "diff");
    csgm_diff *diff = csg_memory_alloc(&context->memory, sizeof *diff);
    if (!diff)
        return csg_context_no_memory(context);
    *diff = (csgm_diff){.context = context, .views = {*a, *b}};
    comparison c = {.pair = {.context = context},
                    .options = options,
                    .diff = diff,
                    .report = &diff->report,
                    .differing = csg_box_empty(),
                    .started_s = csg_clock_now_s()};
    atomic_bool timed_out = false;
    c.timed_out = &timed_out;
    csgm_status status = compare(&c, a, b);
    if (status != CSGM_OK && atomic_load(&timed_out))
        status = tell_timeout(context);
    csg_diff_pair_release(&c.pair);
    if (status == CSGM_OK)
        *out = diff;
    else
        csg_diff_destroy(diff);
    return status;
}

void csg_diff_destroy(csgm_diff *diff)
{
    if (!diff)
        return;
    csg_memory *memory = &diff->context->memory;
    for (int i = 0; i < 2; i++)
        csg_memory_release(memory, diff->distances[i],
                           (size_t)diff->views[i].vertex_count * sizeof(float));
    csg_memory_release(memory, diff, sizeof *diff);
}
