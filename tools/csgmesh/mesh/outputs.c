/* SPDX-License-Identifier: MIT
 * Output files; see outputs.h.
 */
#include "mesh/outputs.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

csgm_format cli_outputs_format(const cli_options *options, size_t index)
{
    csgm_format named = csgm_format_from_path(options->outputs.items[index]);
    bool asked = options->format && (options->outputs.count == 1 || named == CSGM_FORMAT_AUTO);
    return asked ? csgm_format_from_name(options->format) : named;
}

static bool is_gltf(csgm_format format)
{
    return format == CSGM_FORMAT_GLTF || format == CSGM_FORMAT_GLB;
}

static void formats_of_this_build(char *buffer, size_t size)
{
    size_t length = (size_t)snprintf(buffer, size, "formats:");
    for (int format = CSGM_FORMAT_AUTO + 1; format < CSGM_FORMAT_COUNT; format++)
        if (csgm_format_available((csgm_format)format, false) && length < size)
            length += (size_t)snprintf(buffer + length, size - length, " %s",
                                       csgm_format_name((csgm_format)format));
}

/* Nothing to write to: say what to add. */
static int refuse_no_output(cli_app *app, const char *scene_path)
{
    const char *slash = strrchr(scene_path, '/');
    const char *name = slash ? slash + 1 : scene_path;
    const char *dot = strrchr(name, '.');
    char hint[160];
    int stem = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    if (strcmp(name, "-") == 0)
        snprintf(hint, sizeof hint, "add -o part.glb (or .stl .ply .obj .off .gltf .drc .3mf)");
    else
        snprintf(hint, sizeof hint, "add -o %.*s.glb (or .stl .ply .obj .off .gltf .drc .3mf)",
                 stem < 80 ? stem : 80, name);
    return cli_usage_error(app, hint, "no output file");
}

static int check_format(cli_app *app, size_t index)
{
    const char *path = app->options.outputs.items[index];
    csgm_format format = cli_outputs_format(&app->options, index);
    char known[128];
    formats_of_this_build(known, sizeof known);
    if (format == CSGM_FORMAT_AUTO && strcmp(path, "-") == 0)
        return cli_usage_error(app, known, "standard output needs a format: add -f glb");
    if (format == CSGM_FORMAT_AUTO)
        return cli_usage_error(app, known, "the name '%s' tells no format", path);
    if (!csgm_format_available(format, false))
        return cli_usage_error(app, known, "this build cannot write %s (%s)",
                               csgm_format_name(format), path);
    return CLI_DONE;
}

static int refuse_path(cli_app *app, const char *path, int reason)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot write %s: %s", path, strerror(reason));
    return CLI_TROUBLE;
}

/* What fails now would fail after minutes of work too. */
static int check_place(cli_app *app, const char *path)
{
    struct stat status;
    char folder[4096];
    if (strcmp(path, "-") == 0)
        return CLI_DONE;
    if (!*path)
        return refuse_path(app, "''", ENOENT);
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode))
        return refuse_path(app, path, EISDIR);
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode))
        return CLI_DONE; /* a device or a pipe needs no folder to write in */
    const char *slash = strrchr(path, '/');
    size_t length = slash == path ? 1 : slash ? (size_t)(slash - path) : 0;
    if (length >= sizeof folder)
        return refuse_path(app, path, ENAMETOOLONG);
    snprintf(folder, sizeof folder, "%.*s", length ? (int)length : 1, length ? path : ".");
    return access(folder, W_OK | X_OK) == 0 ? CLI_DONE : refuse_path(app, path, errno);
}

/* Twice the same file, or two results on one stream. */
static int check_collisions(cli_app *app)
{
    const cli_options *options = &app->options;
    for (size_t i = 0; i < options->outputs.count; i++) {
        const char *path = options->outputs.items[i];
        for (size_t j = 0; j < i; j++)
            if (strcmp(path, options->outputs.items[j]) == 0)
                return cli_usage_error(app, NULL, "-o %s is given twice", path);
        if (options->stats && strcmp(path, options->stats) == 0)
            return cli_usage_error(app, "write one of them to a file",
                                   "-o and --stats both write to %s",
                                   strcmp(path, "-") ? path : "standard output");
    }
    return CLI_DONE;
}

/* The values of --normals, in their order. */
enum { AUTO, VERTEX, CREASE, NONE };

/* An option that no output of this run can follow is said to be so, not dropped in silence. */
static void warn_without_effect(cli_app *app)
{
    const cli_options *options = &app->options;
    bool gltf = false, draco = false, text = false, unit = false, crease = false;
    for (size_t i = 0; i < options->outputs.count; i++) {
        csgm_format format = cli_outputs_format(options, i);
        gltf = gltf || is_gltf(format);
        crease = crease || is_gltf(format) || format == CSGM_FORMAT_OBJ;
        unit = unit || is_gltf(format) || format == CSGM_FORMAT_3MF;
        draco = draco || format == CSGM_FORMAT_DRC || (options->draco && is_gltf(format));
        text = text || format == CSGM_FORMAT_PLY || format == CSGM_FORMAT_STL;
    }
    const struct {
        cli_option_id id;
        bool has_effect;
        const char *name, *wanted;
    } rows[] = {
        {CLI_OPTION_ascii, text, "ascii", "PLY or STL"},
        {CLI_OPTION_up, gltf, "up", "glTF or GLB"},
        {CLI_OPTION_unit, unit, "unit", "glTF, GLB or 3MF"},
        {CLI_OPTION_draco, gltf, "draco", "glTF or GLB"},
        {CLI_OPTION_draco_bits, draco, "draco-bits", "Draco (.drc, or --draco with .glb)"},
        {CLI_OPTION_draco_level, draco, "draco-level", "Draco (.drc, or --draco with .glb)"},
    };
    if (options->normals == CREASE && !crease)
        cli_console_say(&app->console, CSGM_WARNING, NULL,
                        "--normals crease has no effect: no output is OBJ, glTF or GLB");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (options->given[rows[i].id] && !rows[i].has_effect)
            cli_console_say(&app->console, CSGM_WARNING, NULL,
                            "--%s has no effect: no output is %s", rows[i].name, rows[i].wanted);
}

int cli_outputs_check(cli_app *app, const char *scene_path)
{
    const cli_options *options = &app->options;
    int status = CLI_DONE;
    if (options->format && csgm_format_from_name(options->format) == CSGM_FORMAT_AUTO) {
        char known[128];
        formats_of_this_build(known, sizeof known);
        return cli_usage_error(app, known, "unknown format '%s'", options->format);
    }
    if (!options->outputs.count && !options->stats)
        return refuse_no_output(app, scene_path);
    status = check_collisions(app);
    for (size_t i = 0; i < options->outputs.count && status == CLI_DONE; i++) {
        status = check_place(app, options->outputs.items[i]);
        if (status == CLI_DONE)
            status = check_format(app, i);
    }
    if (status == CLI_DONE)
        warn_without_effect(app);
    return status;
}

csgm_normals cli_outputs_normals(const cli_options *options)
{
    if (options->normals != AUTO)
        return options->normals == VERTEX   ? CSGM_NORMALS_VERTEX
               : options->normals == CREASE ? CSGM_NORMALS_CREASE
                                            : CSGM_NORMALS_NONE;
    for (size_t i = 0; i < options->outputs.count; i++) {
        csgm_format format = cli_outputs_format(options, i);
        if (format == CSGM_FORMAT_OBJ || is_gltf(format))
            return CSGM_NORMALS_CREASE;
    }
    return CSGM_NORMALS_VERTEX;
}

csgm_write_options cli_outputs_options(const cli_options *options)
{
    csgm_write_options write = csgm_write_options_default();
    write.ascii = options->ascii;
    write.draco = options->draco;
    write.y_up = options->up == 0;
    write.sync = !options->no_sync;
    write.only_if_changed = options->if_changed;
    write.unit = (csgm_unit)options->unit; /* the values of --unit stand in the enum's order */
    if (options->given[CLI_OPTION_draco_bits]) {
        write.draco_position_bits = options->draco_bits.position;
        write.draco_normal_bits = options->draco_bits.normal;
        write.draco_color_bits = options->draco_bits.color;
    }
    if (options->given[CLI_OPTION_draco_level])
        write.draco_level = options->draco_level;
    return write;
}

int cli_outputs_write(cli_app *app, const csgm_mesh_view *mesh)
{
    csgm_write_options options = cli_outputs_options(&app->options);
    int worst = CLI_DONE;
    for (size_t i = 0; i < app->options.outputs.count; i++) {
        const char *path = app->options.outputs.items[i];
        csgm_format format = cli_outputs_format(&app->options, i);
        csgm_status status = strcmp(path, "-") == 0
                                 ? csgm_mesh_write_fd(app->context, mesh, STDOUT_FILENO,
                                                      "standard output", format, &options)
                                 : csgm_mesh_write(app->context, mesh, path, format, &options);
        int exit_status = cli_exit_status(status);
        worst = exit_status > worst ? exit_status : worst;
    }
    return worst;
}
