/* SPDX-License-Identifier: MIT
 * Scene to mesh; see work.h.
 */
#include "core/work.h"

#include <math.h>

#include "core/options.h"
#include "core/sources.h"
#include "mesh/outputs.h"

int cli_work_check(cli_app *app)
{
    if (app->options->given[CLI_OPTION_resolution] && app->options->given[CLI_OPTION_cell_size])
        return cli_usage_error(app, NULL, "-r and -s both set the size of a cell: give one");
    if (app->options->given[CLI_OPTION_tolerance] && app->options->given[CLI_OPTION_simplify])
        return cli_usage_error(app, NULL,
                               "-e and --simplify both say what may be taken away: give one");
    const cli_options *o = app->options;
    bool equal_cells = o->given[CLI_OPTION_resolution] || o->given[CLI_OPTION_cell_size];
    if (o->given[CLI_OPTION_quality] && (equal_cells || o->given[CLI_OPTION_tolerance]))
        return cli_usage_error(
            app, NULL, "--quality chooses cells and tolerance: give it without -r, -s and -e");
    if (o->triangles &&
        (equal_cells || o->given[CLI_OPTION_tolerance] || o->given[CLI_OPTION_simplify]))
        return cli_usage_error(
            app, NULL,
            "--triangles chooses cells and tolerance: give it without -r, -s, -e and "
            "--simplify");
    if ((o->given[CLI_OPTION_quality] || o->triangles) && (o->certify || o->certify_size > 0))
        return cli_usage_error(app, "give -r",
                               "--certify looks at cells of one size, not at those of --quality or "
                               "--triangles");
    return CLI_DONE;
}

int cli_work_load(cli_app *app, cli_work *work, const char *path)
{
    csgm_status status = cli_app_load(app, path, &work->scene);
    if (status != CSGM_OK)
        return cli_exit_status(status);
    work->info = csgm_scene_get_info(work->scene);
    return cli_sources_guard_scene(app, work->scene);
}

double cli_work_tolerance(const cli_app *app, const cli_work *work, csgm_quality quality)
{
    const cli_options *o = app->options;
    if (o->resolution || o->given[CLI_OPTION_cell_size] || o->given[CLI_OPTION_tolerance] ||
        o->given[CLI_OPTION_simplify])
        return 0;
    csgm_box box = work->info.bounds;
    if (o->given[CLI_OPTION_bounds])
        box = (csgm_box){{fmax(box.min.x, o->bounds.min.x), fmax(box.min.y, o->bounds.min.y),
                          fmax(box.min.z, o->bounds.min.z)},
                         {fmin(box.max.x, o->bounds.max.x), fmin(box.max.y, o->bounds.max.y),
                          fmin(box.max.z, o->bounds.max.z)}};
    return csgm_quality_tolerance(quality, box);
}

static csgm_mesh_options mesh_options(cli_app *app, const cli_work *work)
{
    const cli_options *options = app->options;
    csgm_mesh_options mesh = csgm_mesh_options_default();
    if (options->given[CLI_OPTION_bounds])
        mesh.bounds = options->bounds;
    mesh.resolution = (uint32_t)options->resolution;
    mesh.cell_size = options->cell_size;
    mesh.tolerance = options->tolerance;
    if (options->simplify.is_share)
        mesh.simplify_share = options->simplify.value;
    else
        mesh.simplify_error = work->within > 0 ? work->within : options->simplify.value;
    mesh.quality = (csgm_quality)options->quality; /* in the enum's order */
    mesh.triangles = (uint64_t)options->triangles;
    mesh.improve = options->improve;
    mesh.normals = work->normals ? *work->normals : cli_outputs_normals(options);
    mesh.features = (csgm_features)options->features; /* the values stand in the enum's order */
    mesh.colors = cli_outputs_colors(options) && !work->drops_looks;
    mesh.prune = !options->no_prune;
    mesh.certify = options->certify || options->certify_size > 0;
    mesh.certify_size = options->certify_size;
    mesh.monitor = (csgm_monitor){.progress = cli_console_progress, .user = &app->console};
    return mesh;
}

static csgm_status compile(cli_app *app, cli_work *work)
{
    double begin_s = cli_now_s();
    csgm_status status = csgm_field_compile(app->context, work->scene, &work->field);
    work->compile_s = cli_now_s() - begin_s;
    return status;
}

int cli_work_mesh(cli_app *app, cli_work *work)
{
    csgm_mesh_options options = mesh_options(app, work);
    csgm_status status = work->field ? CSGM_OK : compile(app, work);
    work->stats = csgm_mesh_stats_default();
    if (status == CSGM_OK)
        status = csgm_mesh_build(app->context, work->field, &options, &work->mesh, &work->stats);
    cli_console_end_progress(&app->console);
    if (status == CSGM_OK && cli_app_is_refused(app))
        status = CSGM_ERR_SCENE;
    return cli_exit_status(status);
}

/* Within a tolerance that is proven where it can be: then its error is known of every point. */
static csgm_status mesh_level(cli_app *app, cli_work *work, double tolerance, size_t index)
{
    csgm_mesh_options options = mesh_options(app, work);
    csgm_mesh_stats stats = csgm_mesh_stats_default();
    csgm_level *level = &work->levels[index];
    options.resolution = 0;
    options.cell_size = options.simplify_error = options.simplify_share = 0;
    options.triangles = 0;
    options.certify = false;
    options.tolerance = tolerance;
    csgm_status status =
        csgm_mesh_build(app->context, work->field, &options, &work->level_meshes[index], &stats);
    if (status != CSGM_OK)
        return status;
    level->mesh = csgm_mesh_get_view(work->level_meshes[index]);
    level->measured = stats.max_distance_measured;
    level->is_proven = isfinite(stats.max_distance_bound);
    level->error = fmax(level->is_proven ? stats.max_distance_bound : tolerance, level->measured);
    return CSGM_OK;
}

int cli_work_mesh_levels(cli_app *app, cli_work *work, csgm_write_options *write_options)
{
    size_t wanted = (size_t)app->options->lod;
    csgm_status status = CSGM_OK;
    uint64_t before = csgm_mesh_get_view(work->mesh).triangle_count;
    double tolerance =
        app->options->tolerance > 0 ? app->options->tolerance
        : work->stats.tolerance > 0
            ? work->stats.tolerance
            : csgm_quality_tolerance((csgm_quality)app->options->quality, work->info.bounds);
    while (status == CSGM_OK && !work->is_leveled && work->level_count + 1 < wanted) {
        tolerance *= 4;
        status = mesh_level(app, work, tolerance, work->level_count);
        uint64_t count =
            status == CSGM_OK ? work->levels[work->level_count].mesh.triangle_count : 0;
        if (!count || count >= before)
            break;
        before = count;
        work->level_count++;
    }
    work->is_leveled = true;
    write_options->levels = work->levels;
    write_options->level_count = work->level_count;
    cli_console_end_progress(&app->console);
    return cli_exit_status(status);
}

int cli_work_mesh_file(cli_app *app, cli_work *work, const char *path, csgm_format format,
                       const csgm_write_options *write_options, uint64_t counts[2],
                       csgm_mesh_figures *figures)
{
    csgm_mesh_options options = mesh_options(app, work);
    uint32_t errors = app->console.errors;
    csgm_status status = work->field ? CSGM_OK : compile(app, work);
    counts[0] = counts[1] = 0;
    work->stats = csgm_mesh_stats_default();
    if (status == CSGM_OK && figures)
        status =
            csgm_mesh_build_file_figures(app->context, work->scene, work->field, &options, path,
                                         format, write_options, counts, &work->stats, figures);
    else if (status == CSGM_OK)
        status = csgm_mesh_build_file(app->context, work->field, &options, path, format,
                                      write_options, counts, &work->stats);
    cli_console_end_progress(&app->console);
    if (status == CSGM_ERR_SCENE && app->console.errors == errors)
        cli_console_say(&app->console, CSGM_ERROR, NULL,
                        "the mesh has no triangles: nothing was written");
    return cli_exit_status(status);
}

void cli_work_release(cli_work *work)
{
    for (size_t i = 0; i < CSGM_DETAILS_MOST; i++)
        csgm_mesh_destroy(work->level_meshes[i]);
    csgm_mesh_destroy(work->mesh);
    csgm_field_destroy(work->field);
    csgm_scene_destroy(work->scene);
}
