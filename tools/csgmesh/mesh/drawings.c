/* SPDX-License-Identifier: MIT
 * Drawings among the outputs; see drawings.h.
 */
#include "mesh/drawings.h"

#include <string.h>
#include <unistd.h>

#include "core/options.h"
#include "mesh/outputs.h"

csgm_drawing_format cli_drawings_format(const cli_options *options, size_t index)
{
    const char *path = options->outputs.items[index];
    csgm_drawing_format named = csgm_drawing_format_from_path(path);
    bool is_mesh = csgm_format_from_path(path) != CSGM_FORMAT_AUTO;
    bool asked = options->format &&
                 (options->outputs.count == 1 || (named == CSGM_DRAWING_NONE && !is_mesh));
    return asked ? csgm_drawing_format_from_name(options->format) : named;
}

size_t cli_drawings_count(const cli_options *options)
{
    size_t count = 0;
    for (size_t i = 0; i < options->outputs.count; i++)
        count += cli_drawings_format(options, i) != CSGM_DRAWING_NONE;
    return count;
}

csgm_flat cli_drawings_flat(const cli_options *options)
{
    size_t count = cli_drawings_count(options);
    if (!count)
        return CSGM_FLAT_PLATE;
    return count == options->outputs.count && !options->stats ? CSGM_FLAT_DRAWING : CSGM_FLAT_BOTH;
}

const char *cli_drawings_or_mesh_name(const char *name)
{
    csgm_format mesh = csgm_format_from_name(name);
    csgm_drawing_format drawing = csgm_drawing_format_from_name(name);
    return mesh != CSGM_FORMAT_AUTO       ? csgm_format_name(mesh)
           : drawing != CSGM_DRAWING_NONE ? csgm_drawing_format_name(drawing)
                                          : NULL;
}

static int check_layers(cli_app *app, const csgm_scene *scene)
{
    if (csgm_scene_layer_count(scene))
        return CLI_DONE;
    cli_console_say(&app->console, CSGM_ERROR, NULL,
                    "the scene has nothing to draw: nothing was written");
    return CLI_INPUT_AT_FAULT;
}

int cli_drawings_write_one(cli_app *app, const csgm_scene *scene, const char *path,
                           csgm_drawing_format format)
{
    csgm_write_options options = cli_outputs_options(app, NULL);
    int status = check_layers(app, scene);
    if (status == CLI_DONE)
        status = cli_exit_status(csgm_scene_draw(app->context, scene, path, format, &options));
    return status;
}

int cli_drawings_write(cli_app *app, const csgm_scene *scene)
{
    csgm_write_options options = cli_outputs_options(app, NULL);
    int worst = CLI_DONE;
    if (check_layers(app, scene) != CLI_DONE)
        return CLI_INPUT_AT_FAULT;
    for (size_t i = 0; i < app->options->outputs.count; i++) {
        const char *path = app->options->outputs.items[i];
        csgm_drawing_format format = cli_drawings_format(app->options, i);
        if (format == CSGM_DRAWING_NONE)
            continue;
        csgm_status status = strcmp(path, "-") == 0
                                 ? csgm_scene_draw_fd(app->context, scene, STDOUT_FILENO,
                                                      "standard output", format, &options)
                                 : csgm_scene_draw(app->context, scene, path, format, &options);
        int exit_status = cli_exit_status(status);
        worst = exit_status > worst ? exit_status : worst;
    }
    return worst;
}
