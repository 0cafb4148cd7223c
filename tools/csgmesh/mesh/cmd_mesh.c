/* SPDX-License-Identifier: MIT
 * csgmesh [mesh] SCENE -o FILE...: scene -> mesh -> files, statistics and a dependency rule.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "convert/convert.h"
#include "core/commands.h"
#include "core/facts.h"
#include "core/mesh_files.h"
#include "core/options.h"
#include "core/textfile.h"
#include "core/work.h"
#include "mesh/certify.h"
#include "mesh/depfile.h"
#include "mesh/drawings.h"
#include "mesh/outputs.h"

typedef struct run_report {
    csgm_mesh_check check;
    double max_abs_field;
    uint64_t vertices_measured; /* for max_abs_field */
    double write_s, total_s;
    uint64_t peak_rss_bytes; /* of the work, before the mesh was inspected */
} run_report;

static uint64_t peak_rss_bytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (uint64_t)usage.ru_maxrss * 1024; /* Linux counts KiB */
}

/* ---- statistics ------------------------------------------------------------------------ */

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

static void put_results(cli_json *json, const cli_work *work, const run_report *report)
{
    csgm_mesh_view view = csgm_mesh_get_view(work->mesh);
    cli_json_open(json, "mesh", '{');
    cli_facts_mesh_json(json, &view, &report->check);
    if (work->stats.triangles_before)
        cli_json_count(json, "triangles_before", work->stats.triangles_before);
    cli_json_end(json, '}');
    cli_json_open(json, "quality", '{');
    cli_json_number(json, "max_abs_field", report->max_abs_field);
    cli_json_count(json, "vertices_measured", report->vertices_measured);
    if (work->stats.is_measured)
        put_distance(json, &work->stats);
    cli_json_number(json, "min_angle_deg", report->check.min_angle_deg);
    cli_json_number(json, "max_aspect", report->check.max_aspect);
    cli_json_count(json, "degenerate",
                   report->check.degenerate_triangles + report->check.zero_area_triangles);
    cli_json_end(json, '}');
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

/* What each file holds, by reading it: formats round, weld and split. false: it cannot be read
 * (reported). */
static bool put_file(cli_json *json, cli_app *app, size_t index)
{
    const char *path = app->options->outputs.items[index];
    csgm_format format = cli_outputs_format(app->options, index);
    csgm_mesh *mesh;
    csgm_mesh_view view = {.positions = NULL};
    csgm_mesh_check check;
    struct stat info;
    if (strcmp(path, "-") == 0 || !csgm_format_available(format, true) ||
        (stat(path, &info) == 0 && !S_ISREG(info.st_mode)))
        return true;
    csgm_status status = csgm_mesh_read(app->context, path, format, &mesh);
    if (status == CSGM_OK) {
        view = csgm_mesh_get_view(mesh);
        status = csgm_mesh_inspect(app->context, &view, &check);
    }
    if (status == CSGM_OK) {
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "name", path);
        cli_json_string(json, "format", csgm_format_name(format));
        cli_facts_mesh_json(json, &view, &check);
        cli_json_end(json, '}');
    }
    csgm_mesh_destroy(mesh);
    if (status != CSGM_OK)
        cli_console_say(&app->console, CSGM_ERROR, NULL,
                        "--stats: %s has been written and cannot be read back", path);
    return status == CSGM_OK;
}

static bool put_statistics(FILE *out, cli_app *app, const cli_work *work, const run_report *report)
{
    cli_json json = cli_json_make(out, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    cli_json_open(&json, "scene", '{');
    cli_facts_scene_json(&json, &work->info);
    cli_json_end(&json, '}');
    put_work(&json, work);
    put_results(&json, work, report);
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

static int write_statistics(cli_app *app, const cli_work *work, run_report *report)
{
    csgm_mesh_view view = csgm_mesh_get_view(work->mesh);
    csgm_status status = csgm_mesh_inspect(app->context, &view, &report->check);
    if (status != CSGM_OK)
        return cli_exit_status(status);
    report->max_abs_field = csgm_mesh_max_abs_field(work->scene, &view, &report->vertices_measured);
    cli_text text;
    bool all_read = !cli_text_open(&text) || put_statistics(text.out, app, work, report);
    int written = cli_text_write(app, &text, app->options->stats);
    return all_read ? written : CLI_TROUBLE;
}

/* ---- the run --------------------------------------------------------------------------- */

static void tell_result(cli_app *app, uint64_t triangle_count, const run_report *report)
{
    if (!app->console.is_terminal || app->console.quiet || app->console.json)
        return;
    for (size_t i = 0; i < app->options->outputs.count; i++)
        fprintf(stderr, "%s%s", i ? ", " : "", app->options->outputs.items[i]);
    fprintf(stderr, "%s%llu triangles, %.2f s\n", app->options->outputs.count ? ": " : "",
            (unsigned long long)triangle_count, report->total_s);
}

/* The outputs that could be written get their names; with -Werror none does after a warning. */
static int name_outputs(cli_app *app, int status)
{
    bool refused = cli_app_is_refused(app);
    if (refused && status == CLI_DONE)
        status = CLI_INPUT_AT_FAULT;
    csgm_status named = csgm_files_release(app->context, !refused);
    return status == CLI_DONE ? cli_exit_status(named) : status;
}

static int write_all(cli_app *app, cli_work *work, run_report *report)
{
    csgm_mesh_view view = csgm_mesh_get_view(work->mesh);
    if (view.triangle_count == 0 && app->options->outputs.count) {
        cli_console_say(&app->console, CSGM_ERROR, NULL,
                        "the mesh has no triangles: nothing was written");
        return CLI_INPUT_AT_FAULT;
    }
    double begin_s = cli_now_s();
    int status = cli_outputs_write(app, work);
    status = name_outputs(app, status);
    if (status == CLI_DONE && app->options->depfile)
        status = cli_depfile_write(app, work->scene);
    double end_s = cli_now_s();
    report->write_s = end_s - begin_s;
    report->total_s = end_s - app->start_s;
    report->peak_rss_bytes = peak_rss_bytes();
    if (status == CLI_DONE)
        tell_result(app, view.triangle_count, report);
    if (status == CLI_DONE)
        cli_certify_tell(app, &work->stats.certify);
    if (status == CLI_DONE && app->options->stats)
        status = write_statistics(app, work, report);
    return status;
}

/* One file and nothing else to do with the mesh: it need not be in memory as a whole. -Werror must
 * hear the warnings of meshing before a file is there. */
static bool goes_straight_to_file(const cli_options *options)
{
    return options->outputs.count == 1 && !cli_drawings_count(options) &&
           !options->given[CLI_OPTION_lod] && strcmp(options->outputs.items[0], "-") != 0 &&
           !options->stats && options->warnings == 0;
}

static int mesh_to_file(cli_app *app, cli_work *work, run_report *report)
{
    csgm_write_options write_options = cli_outputs_options(app, app->options->operands.items[0]);
    uint64_t triangle_count;
    int status =
        cli_work_mesh_file(app, work, app->options->outputs.items[0],
                           cli_outputs_format(app->options, 0), &write_options, &triangle_count);
    status = name_outputs(app, status);
    if (status == CLI_DONE && app->options->depfile)
        status = cli_depfile_write(app, work->scene);
    report->total_s = cli_now_s() - app->start_s;
    if (status == CLI_DONE)
        tell_result(app, triangle_count, report);
    if (status == CLI_DONE)
        cli_certify_tell(app, &work->stats.certify);
    return status;
}

/* Drawings are written first; where they are all that is asked for, the scene is not meshed. */
static int draw_scene(cli_app *app, const cli_work *work)
{
    int status = app->flat == CSGM_FLAT_PLATE ? CLI_DONE : cli_drawings_write(app, work->scene);
    if (app->flat == CSGM_FLAT_DRAWING)
        status = name_outputs(app, status);
    if (status == CLI_DONE && app->flat == CSGM_FLAT_DRAWING && app->options->depfile)
        status = cli_depfile_write(app, work->scene);
    return status;
}

/* --cells: what the mesh was made from. A mesh that failed has none. */
static int write_cells(cli_app *app, int status)
{
    const char *path = app->options->cells;
    csgm_mesh *cells;
    csgm_status made = csgm_survey_end(app->context, &cells);
    if (status != CLI_DONE || made != CSGM_OK) {
        csgm_mesh_destroy(cells);
        return status != CLI_DONE ? status : cli_exit_status(made);
    }
    csgm_mesh_view view = csgm_mesh_get_view(cells);
    csgm_write_options given = cli_outputs_options(app, app->options->operands.items[0]);
    csgm_write_options options = csgm_write_options_default();
    options.unit = given.unit;
    options.y_up = given.y_up;
    if (view.triangle_count)
        status =
            cli_exit_status(csgm_mesh_write(app->context, &view, path, CSGM_FORMAT_AUTO, &options));
    else
        cli_console_say(&app->console, CSGM_WARNING, NULL,
                        "--cells: the mesh is not made from cells, so %s was not written", path);
    csgm_mesh_destroy(cells);
    return status;
}

static int mesh_scene(cli_app *app, const char *path)
{
    cli_work work = {0};
    run_report report = {0};
    app->flat = cli_drawings_flat(app->options);
    int status = cli_work_load(app, &work, path);
    if (status == CLI_DONE)
        status = cli_exit_status(csgm_files_hold(app->context));
    if (status == CLI_DONE)
        status = draw_scene(app, &work);
    bool is_meshed = status == CLI_DONE && app->flat != CSGM_FLAT_DRAWING;
    if (status == CLI_DONE && !is_meshed && app->options->cells)
        cli_console_say(&app->console, CSGM_WARNING, NULL,
                        "--cells has no effect: the scene is drawn and not meshed");
    if (is_meshed && app->options->cells)
        status = cli_exit_status(csgm_survey_begin(app->context));
    if (status != CLI_DONE) {
        is_meshed = false;
    } else if (is_meshed && goes_straight_to_file(app->options)) {
        status = mesh_to_file(app, &work, &report);
    } else if (is_meshed) {
        status = cli_work_mesh(app, &work);
        if (status == CLI_DONE)
            status = write_all(app, &work, &report);
    }
    if (is_meshed && app->options->cells)
        status = write_cells(app, status);
    cli_work_release(&work);
    return status;
}

int cli_cmd_mesh(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    if (operands->count == 0)
        return cli_usage_error(app, "as csgmesh mug.txt -o mug.glb; csgmesh --help shows more",
                               "no scene given");
    if (operands->count > 1)
        return cli_usage_error(app, "an output file is given as -o FILE",
                               "one scene at a time: '%s' is one too many", operands->items[1]);
    if (cli_path_is_mesh(operands->items[0]))
        return cli_convert_operand(app, operands->items[0]);
    if (app->options->smooth)
        return cli_usage_error(app, "blends and offset() round a scene",
                               "--smooth is for meshes, not for scenes");
    int status = cli_outputs_check(app, operands->items[0]);
    if (status == CLI_DONE)
        status = cli_work_check(app);
    if (status == CLI_DONE)
        status = cli_depfile_check(app);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    return status == CLI_DONE ? mesh_scene(app, operands->items[0]) : status;
}
