/* SPDX-License-Identifier: MIT
 * Output files; see outputs.h.
 */
#include "mesh/outputs.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/format_lists.h"
#include "core/options.h"
#include "mesh/drawings.h"

csgm_format cli_outputs_format(const cli_options *options, size_t index)
{
    csgm_format named = csgm_format_from_path(options->outputs.items[index]);
    bool asked = options->format && (options->outputs.count == 1 || named == CSGM_FORMAT_AUTO);
    return asked ? csgm_format_from_name(options->format) : named;
}

/* Nothing to write to: say what to add. */
static int refuse_no_output(cli_app *app, const char *scene_path)
{
    const char *slash = strrchr(scene_path, '/');
    const char *name = strcmp(scene_path, "-") == 0 ? "part" : slash ? slash + 1 : scene_path;
    const char *dot = strrchr(name, '.');
    char hint[256], known[160];
    int stem = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    cli_formats_list(known, sizeof known, " .", CSGM_IS_WRITTEN);
    snprintf(hint, sizeof hint, "add -o %.*s.glb (formats:%s)", stem < 80 ? stem : 80, name, known);
    return cli_usage_error(app, hint, "no output file");
}

/* Why no file of this format can be written, on the console. */
static int refuse_format(cli_app *app, const char *known, csgm_format format, const char *path)
{
    if (csgm_format_traits(format) & CSGM_IS_WRITTEN)
        return cli_usage_error(app, known, "this build cannot write %s (%s)",
                               csgm_format_name(format), path);
    return cli_usage_error(app, known, "csgmesh reads %s files and cannot write them (%s)",
                           csgm_format_title(format), path);
}

static int check_format(cli_app *app, size_t index)
{
    const char *path = app->options->outputs.items[index];
    csgm_format format = cli_outputs_format(app->options, index);
    char known[200];
    if (cli_drawings_format(app->options, index) != CSGM_DRAWING_NONE)
        return CLI_DONE;
    cli_formats_of_this_build(known, sizeof known);
    if (format == CSGM_FORMAT_AUTO && strcmp(path, "-") == 0)
        return cli_usage_error(app, known, "standard output needs a format: add -f glb");
    if (format == CSGM_FORMAT_AUTO)
        return cli_usage_error(app, known, "the name '%s' tells no format", path);
    return csgm_format_available(format, false) ? CLI_DONE
                                                : refuse_format(app, known, format, path);
}

static int refuse_path(cli_app *app, const char *path, int reason)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot write %s: %s", path, strerror(reason));
    return CLI_TROUBLE;
}

/* What fails now would fail after minutes of work too. */
int cli_outputs_check_place(cli_app *app, const char *path)
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

/* The values of --normals, in their order. */
enum { AUTO, VERTEX, CREASE, NONE };

/* The values of --compress, in their order. */
enum { UNCOMPRESSED, MESHOPT, DRACO, MESHOPT_KHR };

static bool is_meshopt(const cli_options *options)
{
    return options->compress == MESHOPT || options->compress == MESHOPT_KHR;
}

bool cli_outputs_draco(const cli_options *options)
{
    return options->draco || options->compress == DRACO;
}

/* An option that no output of this run can follow is said to be so, not dropped in silence. */
static void warn_without_effect(cli_app *app)
{
    const cli_options *options = app->options;
    static const struct {
        cli_option_id id;
        const char *name;
        uint32_t heeded_by; /* formats with one of these traits */
    } rows[] = {
        {CLI_OPTION_ascii, "--ascii", CSGM_HEEDS_ASCII},
        {CLI_OPTION_up, "--up", CSGM_HEEDS_UP},
        {CLI_OPTION_unit, "--unit", CSGM_HEEDS_UNIT},
        {CLI_OPTION_meta, "--meta", CSGM_HEEDS_METADATA},
        {CLI_OPTION_draco, "--draco", CSGM_HEEDS_DRACO},
        {CLI_OPTION_compress, "--compress", CSGM_HEEDS_MESHOPT},
        {CLI_OPTION_uv, "--uv", CSGM_HEEDS_UV},
        {CLI_OPTION_lod, "--lod", CSGM_HEEDS_LEVELS},
        {CLI_OPTION_draco_bits, "--draco-bits", CSGM_HEEDS_DRACO_BITS},
        {CLI_OPTION_draco_level, "--draco-level", CSGM_HEEDS_DRACO_BITS},
    };
    uint32_t traits = 0; /* of all outputs together */
    char wanted[160];
    for (size_t i = 0; i < options->outputs.count; i++)
        traits |= cli_drawings_format(options, i) != CSGM_DRAWING_NONE
                      ? CSGM_HEEDS_UNIT
                      : csgm_format_traits(cli_outputs_format(options, i));
    if ((options->draco || options->compress) && traits & CSGM_HEEDS_DRACO)
        traits |= CSGM_HEEDS_DRACO_BITS;
    if (options->normals == CREASE && !(traits & CSGM_KEEPS_CREASES))
        cli_console_say(&app->console, CSGM_WARNING, NULL,
                        "--normals crease has no effect: no output is %s",
                        cli_formats_in_words(wanted, sizeof wanted, CSGM_KEEPS_CREASES));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (options->given[rows[i].id] && !(traits & rows[i].heeded_by))
            cli_console_say(
                &app->console, CSGM_WARNING, NULL, "%s has no effect: no output is %s%s",
                rows[i].name, cli_formats_in_words(wanted, sizeof wanted, rows[i].heeded_by),
                rows[i].heeded_by == CSGM_HEEDS_DRACO_BITS ? " (.drc, or --draco with .glb)" : "");
}

int cli_outputs_check_contents(cli_app *app)
{
    const cli_list *given = &app->options->meta;
    for (size_t i = 0; i < given->count; i++) {
        const char *value = strchr(given->items[i], '=');
        if (!value || value == given->items[i] || !value[1])
            return cli_usage_error(app, "as --meta title=Mug", "--meta wants KEY=VALUE, not '%s'",
                                   given->items[i]);
    }
    if (app->options->given[CLI_OPTION_lod] &&
        (app->options->lod < 2 || app->options->lod > CSGM_DETAILS_MOST + 1))
        return cli_usage_error(app, NULL, "--lod wants 2 to %d levels, the first one too",
                               CSGM_DETAILS_MOST + 1);
    if (app->options->draco && is_meshopt(app->options))
        return cli_usage_error(app, NULL, "--draco and --compress meshopt exclude each other");
    if (app->options->uv && cli_outputs_draco(app->options))
        return cli_usage_error(app, NULL,
                               "--uv is not written with Draco: take --compress meshopt");
    if (given->count > CLI_META_MOST)
        return cli_usage_error(app, NULL, "--meta may be given %d times at most", CLI_META_MOST);
    return CLI_DONE;
}

static int check_cells(cli_app *app, const char *path)
{
    char known[200];
    if (csgm_format_available(csgm_format_from_path(path), false))
        return cli_outputs_check_place(app, path);
    cli_formats_of_this_build(known, sizeof known);
    return cli_usage_error(app, known, "--cells: '%s' names no format of meshes", path);
}

int cli_outputs_check(cli_app *app, const char *scene_path)
{
    const cli_options *options = app->options;
    int status = CLI_DONE;
    if (options->format && csgm_format_from_name(options->format) == CSGM_FORMAT_AUTO &&
        csgm_drawing_format_from_name(options->format) == CSGM_DRAWING_NONE) {
        char known[200];
        cli_formats_of_this_build(known, sizeof known);
        return cli_usage_error(app, known, "unknown format '%s'", options->format);
    }
    if (!options->outputs.count && !options->stats && !options->cells)
        return refuse_no_output(app, scene_path);
    if (cli_outputs_check_contents(app) != CLI_DONE)
        return CLI_TROUBLE;
    for (size_t i = 0; i < options->outputs.count && status == CLI_DONE; i++) {
        status = cli_outputs_check_place(app, options->outputs.items[i]);
        if (status == CLI_DONE)
            status = check_format(app, i);
    }
    if (status == CLI_DONE && options->cells)
        status = check_cells(app, options->cells);
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
    for (size_t i = 0; i < options->outputs.count; i++)
        if (csgm_format_traits(cli_outputs_format(options, i)) & CSGM_KEEPS_CREASES)
            return CSGM_NORMALS_CREASE;
    return CSGM_NORMALS_VERTEX;
}

bool cli_format_keeps_looks(csgm_format format)
{
    return (csgm_format_traits(format) & (CSGM_KEEPS_COLORS | CSGM_KEEPS_MATERIALS)) != 0;
}

bool cli_outputs_colors(const cli_options *options)
{
    bool asked = !options->outputs.count;
    for (size_t i = 0; i < options->outputs.count; i++) {
        csgm_format format = cli_outputs_format(options, i);
        asked |=
            format == CSGM_FORMAT_AUTO || cli_format_keeps_looks(format); /* a picture, for one */
    }
    return asked && options->colors == 0;
}

/* The name alone: no file says where a folder is. */
static void describe(cli_app *app, const char *scene_path, csgm_write_options *write)
{
    const cli_list *given = &app->options->meta;
    if (scene_path && strcmp(scene_path, "-") != 0) {
        snprintf(app->source, sizeof app->source, "source=%s", cli_file_name(scene_path));
        app->metadata[write->metadata_count++] = app->source;
    }
    for (size_t i = 0; i < given->count && i < CLI_META_MOST; i++)
        app->metadata[write->metadata_count++] = given->items[i];
    write->metadata = app->metadata;
}

csgm_unit cli_outputs_unit(const cli_options *options)
{
    static const csgm_unit units[] = {CSGM_UNIT_MM, CSGM_UNIT_CM, CSGM_UNIT_M, CSGM_UNIT_IN,
                                      CSGM_UNIT_NONE}; /* the values of --unit */
    return units[options->unit];
}

csgm_write_options cli_outputs_options(cli_app *app, const char *scene_path)
{
    const cli_options *options = app->options;
    csgm_write_options write = csgm_write_options_default();
    write.ascii = options->ascii;
    write.draco = cli_outputs_draco(options);
    write.meshopt = is_meshopt(options);
    write.meshopt_khr = options->compress == MESHOPT_KHR;
    write.uv = (csgm_uv)options->uv; /* its values stand in the enum's order */
    write.y_up = options->up == 0;
    write.sync = !options->no_sync;
    write.only_if_changed = options->if_changed;
    write.unit = cli_outputs_unit(options);
    if (options->given[CLI_OPTION_draco_bits]) {
        write.draco_position_bits = options->draco_bits.position;
        write.draco_normal_bits = options->draco_bits.normal;
        write.draco_color_bits = options->draco_bits.color;
    }
    if (options->given[CLI_OPTION_draco_level])
        write.draco_level = options->draco_level;
    describe(app, scene_path, &write);
    return write;
}

int cli_outputs_write_view(cli_app *app, const csgm_mesh_view *mesh,
                           const csgm_write_options *options)
{
    int worst = CLI_DONE;
    for (size_t i = 0; i < app->options->outputs.count; i++) {
        const char *path = app->options->outputs.items[i];
        csgm_format format = cli_outputs_format(app->options, i);
        if (cli_drawings_format(app->options, i) != CSGM_DRAWING_NONE)
            continue; /* it is written already */
        csgm_status status = strcmp(path, "-") == 0
                                 ? csgm_mesh_write_fd(app->context, mesh, STDOUT_FILENO,
                                                      "standard output", format, options)
                                 : csgm_mesh_write(app->context, mesh, path, format, options);
        int exit_status = cli_exit_status(status);
        worst = exit_status > worst ? exit_status : worst;
    }
    return worst;
}

int cli_outputs_write(cli_app *app, cli_work *work)
{
    csgm_mesh_view view = csgm_mesh_get_view(work->mesh);
    csgm_write_options options = cli_outputs_options(app, app->options->operands.items[0]);
    int status = CLI_DONE;
    bool leveled = false;
    for (size_t i = 0; i < app->options->outputs.count; i++)
        leveled |=
            (csgm_format_traits(cli_outputs_format(app->options, i)) & CSGM_HEEDS_LEVELS) != 0;
    if (leveled && app->options->given[CLI_OPTION_lod])
        status = cli_work_mesh_levels(app, work, &options);
    return status == CLI_DONE ? cli_outputs_write_view(app, &view, &options) : status;
}
