/* SPDX-License-Identifier: MIT
 * Read, reshape, write; see convert.h.
 */
#include "convert/convert.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/facts.h"
#include "core/options.h"
#include "csgmesh/reshaping.h"
#include "mesh/drawings.h"
#include "mesh/outputs.h"

typedef struct conversion {
    const char *path;
    csgm_mesh *read, *made; /* made: NULL where nothing was changed */
    csgm_reshape_stats stats;
    csgm_mesh_view view; /* what is written */
} conversion;

static bool is_reshaped(const cli_options *o)
{
    return o->given[CLI_OPTION_simplify] || o->triangles || o->improve || o->smooth;
}

int cli_convert_check(cli_app *app)
{
    const cli_options *o = app->options;
    if (o->given[CLI_OPTION_simplify] && o->triangles)
        return cli_usage_error(
            app, NULL, "--simplify and --triangles both say how many triangles stay: give one");
    if (o->smooth > 10000)
        return cli_usage_error(app, NULL, "--smooth wants at most 10000 rounds");
    if (is_reshaped(o) && !csgm_reshape_available())
        return cli_usage_error(
            app, "without --simplify, --triangles, --improve and --smooth it converts",
            "this build has no OpenMesh, which changes meshes");
    for (size_t i = 0; i < o->outputs.count; i++)
        if (cli_drawings_format(o, i) != CSGM_DRAWING_NONE)
            return cli_usage_error(app, "write a mesh, such as .stl; a flat scene is drawn as .svg",
                                   "a mesh has no outlines to draw (%s)", o->outputs.items[i]);
    return CLI_DONE;
}

static csgm_status reshape(cli_app *app, conversion *c)
{
    const cli_options *o = app->options;
    csgm_reshape_options options = csgm_reshape_options_default();
    if (o->simplify.is_share)
        options.simplify_share = o->simplify.value;
    else
        options.simplify_error = o->simplify.value;
    options.triangles = o->triangles;
    options.improve = o->improve;
    options.smooth = (uint32_t)o->smooth;
    options.monitor = (csgm_monitor){.progress = cli_console_progress, .user = &app->console};
    c->stats = csgm_reshape_stats_default();
    csgm_status status = csgm_mesh_reshape(app->context, &c->view, &options, &c->made, &c->stats);
    cli_console_end_progress(&app->console);
    if (status == CSGM_OK)
        c->view = csgm_mesh_get_view(c->made);
    return status;
}

static int load(cli_app *app, conversion *c)
{
    csgm_status status =
        csgm_mesh_read(app->context, c->path, csgm_format_from_path(c->path), &c->read);
    if (status != CSGM_OK)
        return cli_exit_status(status);
    c->view = csgm_mesh_get_view(c->read);
    if (app->options->colors != 0)
        c->view.colors = NULL;
    if (!c->view.triangle_count) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "%s has no triangles: nothing was written",
                        c->path);
        return CLI_INPUT_AT_FAULT;
    }
    return is_reshaped(app->options) ? cli_exit_status(reshape(app, c)) : CLI_DONE;
}

/* What changed, and by how much: it is not known before, and cannot be seen in the file. */
static void tell_change(cli_app *app, const conversion *c)
{
    if (!c->made)
        return;
    csgm_mesh_view before = csgm_mesh_get_view(c->read);
    cli_console_say(
        &app->console, CSGM_NOTE, NULL, "%s: %llu of %llu triangles, %.4g to %.4g from %s (proven)",
        c->path, (unsigned long long)c->view.triangle_count,
        (unsigned long long)before.triangle_count, c->stats.distance_lower, c->stats.distance_upper,
        c->stats.mended_triangles == before.triangle_count ? "what was read"
                                                           : "what was read and mended");
}

static int put_json(cli_app *app, const conversion *c, cli_json *json)
{
    csgm_mesh_check check;
    csgm_mesh_view before = csgm_mesh_get_view(c->read);
    csgm_status status = csgm_mesh_inspect(app->context, &c->view, &check);
    if (status != CSGM_OK)
        return cli_exit_status(status);
    cli_json_open(json, NULL, '{');
    cli_json_string(json, "from", c->path);
    cli_json_open(json, "to", '[');
    for (size_t i = 0; i < app->options->outputs.count; i++)
        cli_json_string(json, NULL, app->options->outputs.items[i]);
    cli_json_end(json, ']');
    cli_json_count(json, "triangles_read", before.triangle_count);
    csgm_file_figures mesh = cli_facts_of_mesh(&c->view, &check);
    cli_facts_mesh_json(json, &mesh);
    if (c->made) {
        cli_json_count(json, "triangles_mended", c->stats.mended_triangles);
        cli_json_open(json, "distance", '[');
        cli_json_number(json, NULL, c->stats.distance_lower);
        cli_json_number(json, NULL, c->stats.distance_upper);
        cli_json_end(json, ']');
        cli_json_number(json, "min_angle_deg", check.min_angle_deg);
        cli_json_number(json, "max_aspect", check.max_aspect);
    }
    cli_json_end(json, '}');
    return CLI_DONE;
}

static int write(cli_app *app, const conversion *c)
{
    const cli_options *o = app->options;
    int status = cli_exit_status(csgm_files_hold(app->context));
    for (size_t i = 0; i < o->outputs.count; i++)
        cli_convert_warn_of_losses(app, c->read, &c->view, o->outputs.items[i],
                                   cli_outputs_format(o, i));
    if (status == CLI_DONE) {
        csgm_write_options options = cli_outputs_options(app, c->path);
        if (!o->given[CLI_OPTION_unit])
            csgm_mesh_unit(c->read, &options.unit);
        status = cli_outputs_write_view(app, &c->view, &options);
    }
    bool refused = cli_app_is_refused(app);
    if (refused && status == CLI_DONE)
        status = CLI_INPUT_AT_FAULT;
    csgm_status named = csgm_files_release(app->context, !refused);
    return status == CLI_DONE ? cli_exit_status(named) : status;
}

int cli_convert_file(cli_app *app, const char *path, cli_json *json)
{
    conversion c = {.path = path};
    int status = load(app, &c);
    if (status == CLI_DONE)
        status = write(app, &c);
    if (status == CLI_DONE)
        tell_change(app, &c);
    if (status == CLI_DONE && json)
        status = put_json(app, &c, json);
    csgm_mesh_destroy(c.made);
    csgm_mesh_destroy(c.read);
    return status;
}

/* Options of scenes. */
static void warn_without_effect(cli_app *app)
{
    char label[40];
    for (size_t at = 0; cli_options_unfit(app->options, CLI_CONVERT, &at, label, sizeof label);)
        cli_console_say(&app->console, CSGM_WARNING, NULL, "%s has no effect on a mesh", label);
}

int cli_convert_operand(cli_app *app, const char *path)
{
    int status = cli_convert_check(app);
    if (status == CLI_DONE)
        status = cli_outputs_check(app, path);
    if (status != CLI_DONE)
        return status;
    warn_without_effect(app);
    return cli_convert_run(app);
}
