/* SPDX-License-Identifier: MIT
 * The JSON of --stats; see statistics.h.
 */
#include "mesh/statistics.h"

#include <math.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "core/facts.h"
#include "core/options.h"
#include "core/textfile.h"
#include "mesh/certify.h"
#include "mesh/outputs.h"

uint64_t cli_peak_rss_bytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (uint64_t)usage.ru_maxrss * 1024; /* Linux counts KiB */
}

static void put_work(cli_json *json, const cli_work *work)
{
    const csgm_mesh_stats *stats = &work->stats;
    cli_json_open(json, "grid", '{');
    cli_json_number(json, "cell_size", stats->cell_size);
    cli_json_open(json, "cells", '[');
    for (int i = 0; i < 3; i++)
        cli_json_count(json, NULL, stats->cells[i]);
    cli_json_end(json, ']');
    cli_json_end(json, '}');
    cli_facts_lattice_json(json, stats);
    cli_json_open(json, "evaluations", '{');
    cli_json_count(json, "interval", stats->interval_evaluations);
    cli_json_count(json, "points", stats->point_evaluations);
    cli_json_count(json, "gradient", stats->gradient_evaluations);
    cli_json_count(json, "primitive", stats->primitive_evaluations);
    cli_json_number(json, "mean_tape_length", stats->mean_tape_length);
    cli_json_end(json, '}');
    cli_json_open(json, "octree", '{');
    cli_json_count(json, "visited", stats->cells_visited);
    cli_json_count(json, "pruned_outside", stats->pruned_outside);
    cli_json_count(json, "pruned_inside", stats->pruned_inside);
    cli_json_count(json, "leaf_blocks", stats->leaf_blocks);
    cli_json_count(json, "unresolved_cells", stats->unresolved_cells);
    cli_json_end(json, '}');
    cli_certify_json(json, &stats->certify);
    cli_json_open(json, "features", '{');
    cli_json_count(json, "vertices", stats->feature_vertices);
    cli_json_count(json, "left_smooth", stats->smooth_features);
    cli_json_count(json, "fading", stats->fading_features);
    cli_json_end(json, '}');
}

static void put_distance(cli_json *json, const csgm_mesh_stats *stats)
{
    cli_json_number(json, "distance_allowed", stats->distance_allowed);
    if (isfinite(stats->max_distance_bound))
        cli_json_number(json, "max_distance_bound", stats->max_distance_bound);
    cli_json_number(json, "max_distance_measured", stats->max_distance_measured);
    cli_json_count(json, "open_places", stats->open_places);
}

static void put_mesh(cli_json *json, const cli_work *work, const cli_report *report)
{
    cli_json_open(json, "mesh", '{');
    if (report->figures.is_checked) {
        csgm_file_figures mesh = csgm_file_figures_default();
        mesh.vertices = report->vertices;
        mesh.triangles = report->triangles;
        mesh.check = report->figures.check;
        cli_facts_mesh_json(json, &mesh);
    } else {
        cli_json_count(json, "vertices", report->vertices);
        cli_json_count(json, "triangles", report->triangles);
    }
    if (work->stats.triangles_before)
        cli_json_count(json, "triangles_before", work->stats.triangles_before);
    cli_json_end(json, '}');
}

static void put_quality(cli_json *json, const cli_work *work, const cli_report *report)
{
    const csgm_mesh_figures *figures = &report->figures;
    cli_json_open(json, "quality", '{');
    if (figures->vertices_measured) {
        cli_json_number(json, "max_abs_field", figures->max_abs_field);
        cli_json_count(json, "vertices_measured", figures->vertices_measured);
    }
    if (work->stats.is_measured)
        put_distance(json, &work->stats);
    if (figures->is_checked) {
        cli_json_number(json, "min_angle_deg", figures->check.min_angle_deg);
        cli_json_number(json, "max_aspect", figures->check.max_aspect);
        cli_json_count(json, "degenerate",
                       figures->check.degenerate_triangles + figures->check.zero_area_triangles);
    }
    cli_json_end(json, '}');
}

static void put_times(cli_json *json, const cli_work *work, const cli_report *report)
{
    cli_json_open(json, "time_s", '{');
    cli_json_number(json, "parse", work->info.parse_s);
    cli_json_number(json, "evaluate", work->info.evaluate_s);
    cli_json_number(json, "compile", work->compile_s);
    cli_json_number(json, "octree", work->stats.octree_s);
    cli_json_number(json, "mesh", work->stats.mesh_s);
    if (work->stats.triangles_before)
        cli_json_number(json, "reshape", work->stats.reshape_s);
    cli_json_number(json, "write", report->write_s);
    cli_json_number(json, "total", report->total_s);
    cli_json_end(json, '}');
}

/* A file's name and, in full, what it holds, by reading it: formats round, weld and split. Without
 * the room for that, nor for going through it in runs, it has its name alone. false: it cannot be
 * read (reported). */
static bool put_file(cli_json *json, cli_app *app, size_t index)
{
    const char *path = app->options->outputs.items[index];
    csgm_format format = cli_outputs_format(app->options, index);
    csgm_file_figures mesh = csgm_file_figures_default();
    struct stat info;
    if (strcmp(path, "-") == 0 || !csgm_format_available(format, true) ||
        (stat(path, &info) == 0 && !S_ISREG(info.st_mode)))
        return true;
    bool is_read = app->options->stats_full;
    csgm_status status =
        is_read ? csgm_mesh_file_inspect(app->context, path, format, &mesh) : CSGM_OK;
    if (status == CSGM_OK || status == CSGM_ERR_MEMORY) {
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "name", path);
        cli_json_string(json, "format", csgm_format_name(format));
        if (is_read && status == CSGM_OK)
            cli_facts_mesh_json(json, &mesh);
        cli_json_end(json, '}');
    } else {
        cli_console_say(&app->console, CSGM_ERROR, NULL,
                        "--stats: %s has been written and cannot be read back", path);
    }
    return status == CSGM_OK || status == CSGM_ERR_MEMORY;
}

static bool put_statistics(FILE *out, cli_app *app, const cli_work *work, const cli_report *report)
{
    cli_json json = cli_json_make(out, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    cli_json_open(&json, "scene", '{');
    cli_facts_scene_json(&json, &work->info);
    cli_json_end(&json, '}');
    put_work(&json, work);
    put_mesh(&json, work, report);
    put_quality(&json, work, report);
    put_times(&json, work, report);
    cli_json_open(&json, "files", '[');
    bool all_read = true;
    for (size_t i = 0; i < app->options->outputs.count; i++)
        all_read = put_file(&json, app, i) && all_read;
    cli_json_end(&json, ']');
    cli_json_count(&json, "peak_rss_bytes", report->peak_rss_bytes);
    cli_json_count(&json, "threads", csgm_context_threads(app->context));
    cli_json_string(&json, "simd", csgm_context_isa(app->context));
    cli_json_end(&json, '}');
    return all_read;
}

/* The figures of a mesh that has gone by and is no closed manifold are those of its file. */
static csgm_status measure_file(cli_app *app, cli_report *report)
{
    csgm_file_figures mesh = csgm_file_figures_default();
    csgm_status status = csgm_mesh_file_inspect(app->context, app->options->outputs.items[0],
                                                cli_outputs_format(app->options, 0), &mesh);
    report->figures.is_checked = status == CSGM_OK;
    report->figures.check = mesh.check;
    return status == CSGM_ERR_MEMORY ? CSGM_OK : status;
}

/* What is not known yet. */
static csgm_status measure(cli_app *app, const cli_work *work, cli_report *report)
{
    csgm_mesh_figures *figures = &report->figures;
    if (figures->is_checked)
        return CSGM_OK;
    if (!work->mesh)
        return measure_file(app, report);
    csgm_mesh_view view = csgm_mesh_get_view(work->mesh);
    report->vertices = view.vertex_count;
    report->triangles = view.triangle_count;
    csgm_status status = csgm_mesh_inspect(app->context, &view, &figures->check);
    figures->is_checked = status == CSGM_OK;
    figures->max_abs_field =
        csgm_mesh_max_abs_field(work->scene, &view, &figures->vertices_measured);
    return status == CSGM_ERR_MEMORY ? CSGM_OK : status;
}

int cli_statistics_write(cli_app *app, const cli_work *work, cli_report *report)
{
    cli_text text;
    app->does_without_memory = true;
    csgm_status status = measure(app, work, report);
    bool mesh_is_too_large = !report->figures.is_checked;
    app->ran_out_of_memory = false;
    bool all_read =
        status != CSGM_OK || !cli_text_open(&text) || put_statistics(text.out, app, work, report);
    bool files_are_too_large = app->ran_out_of_memory;
    app->ran_out_of_memory |= mesh_is_too_large;
    app->does_without_memory = false;
    if (status != CSGM_OK)
        return cli_exit_status(status);
    if (app->ran_out_of_memory)
        cli_console_say(&app->console, CSGM_WARNING, "raise the limit with --max-memory",
                        "--stats: area, volume, topology and angles of a %s that is too large "
                        "for the memory were not found out%s",
                        mesh_is_too_large ? "mesh" : "file",
                        app->options->stats_full && !files_are_too_large ? ", but those of its file"
                                                                         : "");
    int written = cli_text_write(app, &text, app->options->stats);
    return all_read ? written : CLI_TROUBLE;
}
