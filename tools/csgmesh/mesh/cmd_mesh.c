/* SPDX-License-Identifier: MIT
 * csgmesh [mesh] SCENE -o FILE...: scene -> mesh -> files, statistics and a dependency rule.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "convert/convert.h"
#include "core/commands.h"
#include "core/mesh_files.h"
#include "core/options.h"
#include "core/work.h"
#include "mesh/certify.h"
#include "mesh/depfile.h"
#include "mesh/drawings.h"
#include "mesh/outputs.h"
#include "mesh/statistics.h"

/* ---- the run --------------------------------------------------------------------------- */

static void tell_result(cli_app *app, uint64_t triangle_count, const cli_report *report)
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

static int write_all(cli_app *app, cli_work *work, cli_report *report)
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
    report->peak_rss_bytes = cli_peak_rss_bytes();
    if (status == CLI_DONE)
        tell_result(app, view.triangle_count, report);
    if (status == CLI_DONE)
        cli_certify_tell(app, &work->stats.certify);
    if (status == CLI_DONE && app->options->stats)
        status = cli_statistics_write(app, work, report);
    return status;
}

/* One file and nothing else to do with the mesh: it need not be in memory as a whole. -Werror must
 * hear the warnings of meshing before a file is there. */
static bool can_go_straight_to_file(const cli_options *options)
{
    return options->outputs.count == 1 && !cli_drawings_count(options) &&
           !options->given[CLI_OPTION_lod] && strcmp(options->outputs.items[0], "-") != 0 &&
           options->warnings == 0;
}

static bool has_equal_cells(const cli_options *options)
{
    return options->resolution || options->given[CLI_OPTION_cell_size];
}

static bool is_streamed(const cli_options *options, size_t index)
{
    return csgm_format_traits(cli_outputs_format(options, index)) & CSGM_IS_STREAMED;
}

static int mesh_to_file(cli_app *app, cli_work *work, cli_report *report)
{
    csgm_mesh_figures *figures = app->options->stats ? &report->figures : NULL;
    csgm_write_options write_options = cli_outputs_options(app, app->options->operands.items[0]);
    uint64_t counts[2];
    int status =
        cli_work_mesh_file(app, work, app->options->outputs.items[0],
                           cli_outputs_format(app->options, 0), &write_options, counts, figures);
    report->vertices = counts[0];
    report->triangles = counts[1];
    status = name_outputs(app, status);
    if (status == CLI_DONE && app->options->depfile)
        status = cli_depfile_write(app, work->scene);
    report->total_s = cli_now_s() - app->start_s;
    if (status == CLI_DONE)
        tell_result(app, counts[1], report);
    if (status == CLI_DONE)
        cli_certify_tell(app, &work->stats.certify);
    return status;
}

/* Into a file that takes the mesh while it is made, so that it need not be in memory. */
static bool can_be_streamed(const cli_options *options)
{
    return can_go_straight_to_file(options) && has_equal_cells(options) && is_streamed(options, 0);
}

/* The mesh's figures are known when the file is there: of one that is streamed, or of equal cells
 * on their way into memory. */
static int file_with_statistics(cli_app *app, cli_work *work, cli_report *report)
{
    double begin_s = cli_now_s();
    int status = mesh_to_file(app, work, report);
    double before_s = work->compile_s + work->stats.octree_s + work->stats.mesh_s;
    report->write_s = is_streamed(app->options, 0) ? work->stats.mesh_s /* one and the same */
                                                   : fmax(cli_now_s() - begin_s - before_s, 0);
    report->peak_rss_bytes = cli_peak_rss_bytes();
    return status == CLI_DONE ? cli_statistics_write(app, work, report) : status;
}

/* With full statistics a mesh is wanted in memory; one that is too large for it goes straight to
 * its file, where it can, and they say less. */
static int mesh_in_memory(cli_app *app, cli_work *work, cli_report *report)
{
    const cli_options *options = app->options;
    bool has_other_way = options->stats && can_be_streamed(options);
    app->does_without_memory = has_other_way;
    int status = cli_work_mesh(app, work);
    app->does_without_memory = false;
    if (status == CLI_DONE)
        return write_all(app, work, report);
    return has_other_way && app->ran_out_of_memory ? file_with_statistics(app, work, report)
                                                   : status;
}

/* After E0901: what takes less memory than that which was asked for. */
static void tell_what_needs_less(cli_app *app)
{
    static const int CELLS[] = {
        [CSGM_QUALITY_NORMAL] = 256, [CSGM_QUALITY_DRAFT] = 64, [CSGM_QUALITY_FINE] = 1024};
    const cli_options *options = app->options;
    bool alone = can_go_straight_to_file(options) && is_streamed(options, 0);
    if (!has_equal_cells(options))
        cli_console_say(
            &app->console, CSGM_NOTE, NULL,
            "cells that follow the shape need all of their lattice in memory; equal cells "
            "do not: -r %d%s",
            CELLS[options->quality], alone ? "" : ", with one output that is PLY, STL or GLB");
    else if (!alone)
        cli_console_say(&app->console, CSGM_NOTE, NULL,
                        "one PLY, STL or GLB file alone is written while the mesh is made, which "
                        "needs far less memory");
    else if (options->features == CSGM_FEATURES_SHARP)
        cli_console_say(
            &app->console, CSGM_NOTE, NULL,
            "what is known of sharp edges takes memory, too: --features smooth has none");
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
    cli_report report = {.figures = csgm_mesh_figures_default()};
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
    } else if (is_meshed && can_go_straight_to_file(app->options) && !app->options->stats) {
        status = mesh_to_file(app, &work, &report);
    } else if (is_meshed && can_go_straight_to_file(app->options) &&
               has_equal_cells(app->options) && !app->options->stats_full) {
        status = file_with_statistics(app, &work, &report);
    } else if (is_meshed) {
        status = mesh_in_memory(app, &work, &report);
    }
    if (is_meshed && status == CLI_TROUBLE && app->ran_out_of_memory)
        tell_what_needs_less(app);
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
