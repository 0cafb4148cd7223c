/* SPDX-License-Identifier: MIT
 * csgmesh info FILE...: what is in a mesh file or in a scene. A scene is meshed in memory for its
 * area, volume and topology.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/commands.h"
#include "core/facts.h"
#include "core/options.h"
#include "core/work.h"

static int inspect(cli_app *app, const csgm_mesh *mesh, csgm_file_figures *found)
{
    csgm_mesh_view view = csgm_mesh_get_view(mesh);
    csgm_mesh_check check;
    csgm_status status = csgm_mesh_inspect(app->context, &view, &check);
    if (status == CSGM_OK)
        *found = cli_facts_of_mesh(&view, &check);
    return cli_exit_status(status);
}

static void put_mesh_member(cli_json *json, const csgm_file_figures *mesh)
{
    cli_json_open(json, "mesh", '{');
    cli_facts_mesh_json(json, mesh);
    cli_json_number(json, "min_angle_deg", mesh->check.min_angle_deg);
    cli_json_count(json, "unused_vertices", mesh->check.unused_vertices);
    cli_json_count(json, "zero_area_triangles", mesh->check.zero_area_triangles);
    cli_json_bool(json, "normals", mesh->has_normals);
    cli_json_bool(json, "colors", mesh->has_colors);
    cli_json_end(json, '}');
}

static int info_of_mesh(cli_app *app, const char *path, csgm_format format)
{
    csgm_file_figures mesh = csgm_file_figures_default();
    int status = cli_exit_status(csgm_mesh_file_inspect(app->context, path, format, &mesh));
    if (status == CLI_DONE && app->options->json) {
        cli_json json = cli_json_make(stdout, true);
        cli_json_begin(&json, '{');
        cli_json_string(&json, "file", path);
        cli_json_string(&json, "format", csgm_format_name(format));
        put_mesh_member(&json, &mesh);
        cli_json_end(&json, '}');
    } else if (status == CLI_DONE) {
        printf("%s: a mesh (%s)\n", path, csgm_format_name(format));
        cli_facts_mesh_text(&mesh);
    }
    return status;
}

static bool is_finite(csgm_box box)
{
    return isfinite(box.min.x + box.min.y + box.min.z + box.max.x + box.max.y + box.max.z);
}

static void print_scene_json(const char *path, const cli_work *work, const csgm_file_figures *mesh)
{
    const char *file;
    cli_json json = cli_json_make(stdout, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "file", path);
    cli_json_open(&json, "scene", '{');
    cli_facts_scene_json(&json, &work->info);
    cli_json_bool(&json, "colors", work->info.has_colors);
    cli_json_end(&json, '}');
    cli_json_open(&json, "files", '[');
    for (size_t i = 0; (file = csgm_scene_dependency(work->scene, i)); i++)
        cli_json_string(&json, NULL, file);
    cli_json_end(&json, ']');
    if (mesh) {
        cli_json_number(&json, "cell_size", work->stats.cell_size);
        cli_facts_lattice_json(&json, &work->stats);
        put_mesh_member(&json, mesh);
    }
    cli_json_end(&json, '}');
}

static void print_scene_text(const char *path, const cli_work *work, const csgm_file_figures *mesh)
{
    printf("%s: a scene\n", path);
    cli_facts_scene_text(&work->info);
    const char *file;
    for (size_t i = 0; (file = csgm_scene_dependency(work->scene, i)); i++)
        printf("  %-12s %s\n", i ? "" : "files", file);
    if (mesh) {
        cli_facts_lattice_text(&work->stats);
        cli_facts_mesh_text(mesh);
    }
}

static int info_of_scene(cli_app *app, const char *path)
{
    cli_work work = {0};
    csgm_file_figures mesh = csgm_file_figures_default();
    bool is_meshed = false;
    int status = cli_work_load(app, &work, path);
    if (status == CLI_DONE &&
        (app->options->given[CLI_OPTION_bounds] ||
         (is_finite(work.info.bounds) && work.info.bounds.min.x <= work.info.bounds.max.x))) {
        status = cli_work_mesh(app, &work);
        is_meshed = status == CLI_DONE;
    }
    if (is_meshed)
        status = inspect(app, work.mesh, &mesh);
    if (status == CLI_DONE)
        (app->options->json ? print_scene_json : print_scene_text)(path, &work,
                                                                   is_meshed ? &mesh : NULL);
    cli_work_release(&work);
    return status;
}

int cli_cmd_info(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    csgm_format asked = CSGM_FORMAT_AUTO;
    if (!operands->count)
        return cli_usage_error(app, "as csgmesh info mug.glb", "no mesh or scene given");
    if (app->options->format) {
        asked = csgm_format_from_name(app->options->format);
        if (asked == CSGM_FORMAT_AUTO)
            return cli_usage_error(app, NULL, "unknown format '%s'", app->options->format);
    }
    int worst = cli_work_check(app);
    if (worst == CLI_DONE)
        worst = cli_app_open(app);
    for (size_t i = 0; app->context && i < operands->count; i++) {
        const char *path = operands->items[i];
        csgm_format format = asked ? asked : csgm_format_from_path(path);
        int status = format ? info_of_mesh(app, path, format) : info_of_scene(app, path);
        worst = status > worst ? status : worst;
    }
    return cli_finish_stdout(app, worst);
}
