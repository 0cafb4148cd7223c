/* SPDX-License-Identifier: MIT
 * csgmesh render SCENE|MESH -o OUT.png: a picture, or one for each step of a turntable.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/commands.h"
#include "core/options.h"
#include "core/textfile.h"
#include "core/work.h"
#include "mesh/depfile.h"
#include "render/picture_options.h"

enum { MOST_TURNS = 3600 };

/* What is drawn: one of both. */
typedef struct subject {
    cli_work work;
    csgm_mesh *mesh;
} subject;

static int load(cli_app *app, const char *path, subject *out)
{
    csgm_format format = csgm_format_from_path(path);
    if (format != CSGM_FORMAT_AUTO)
        return cli_exit_status(csgm_mesh_read(app->context, path, format, &out->mesh));
    int status = cli_work_load(app, &out->work, path);
    if (status == CLI_DONE)
        status =
            cli_exit_status(csgm_field_compile(app->context, out->work.scene, &out->work.field));
    return status;
}

static void release(subject *s)
{
    csgm_mesh_destroy(s->mesh);
    cli_work_release(&s->work);
}

/* ---- options that do not fit ----------------------------------------------------------- */

static void warn_without_effect(cli_app *app, bool is_mesh)
{
    static const struct {
        cli_option_id id;
        const char *name;
        bool of_mesh;
    } rows[] = {
        {CLI_OPTION_wireframe, "wireframe", true},
        {CLI_OPTION_shading, "shading", true},
        {CLI_OPTION_slice, "slice", false},
        {CLI_OPTION_bounds, "bounds", false},
        {CLI_OPTION_evaluator, "evaluator", false},
        {CLI_OPTION_defines, "define", false},
        {CLI_OPTION_parameter_set, "parameter-set", false},
        {CLI_OPTION_depfile, "depfile", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (app->options->given[rows[i].id] && rows[i].of_mesh != is_mesh)
            cli_console_say(&app->console, CSGM_WARNING, NULL, "--%s has no effect on a %s",
                            rows[i].name, is_mesh ? "mesh" : "scene");
    const char *plain = app->options->slice ? "section" : "picture by the lazy evaluator";
    if (app->options->edges && !is_mesh && (app->options->slice || app->options->evaluator))
        cli_console_say(&app->console, CSGM_WARNING, NULL, "--edges has no effect on a %s", plain);
}

static int check(cli_app *app, csgm_image_format *format)
{
    const cli_options *options = app->options;
    if (options->operands.count != 1)
        return cli_usage_error(app, "as csgmesh render mug.txt -o mug.png",
                               options->operands.count ? "one scene or mesh at a time"
                                                       : "no scene or mesh given");
    if (options->outputs.count != 1 && !(options->outputs.count == 0 && options->stats))
        return cli_usage_error(app, "add -o mug.png (or .ppm)",
                               options->outputs.count ? "a picture goes to one file"
                                                      : "no output file");
    if (options->turntable > MOST_TURNS)
        return cli_usage_error(app, NULL, "--turntable makes at most %d pictures", MOST_TURNS);
    const char *path = options->outputs.count ? options->outputs.items[0] : NULL;
    *format = path ? csgm_image_format_from_path(path) : CSGM_IMAGE_AUTO;
    if (options->format) {
        char name[16];
        snprintf(name, sizeof name, ".%.10s", options->format);
        *format = csgm_image_format_from_path(name);
        if (*format == CSGM_IMAGE_AUTO)
            return cli_usage_error(app, "png or ppm", "unknown format of pictures '%.40s'",
                                   options->format);
    }
    if (!path)
        return CLI_DONE;
    if (*format == CSGM_IMAGE_AUTO && strcmp(path, "-") == 0)
        *format = csgm_image_format_available(CSGM_IMAGE_PNG) ? CSGM_IMAGE_PNG : CSGM_IMAGE_PPM;
    if (*format == CSGM_IMAGE_AUTO)
        return cli_usage_error(app, "pictures are .png or .ppm", "the name '%s' tells no format",
                               path);
    if (!csgm_image_format_available(*format))
        return cli_usage_error(app, "write a .ppm",
                               "this build cannot write PNG pictures (made without libpng)");
    if (strcmp(path, "-") == 0 && options->turntable)
        return cli_usage_error(app, NULL, "a turntable is several files, not standard output");
    if (options->stats && strcmp(path, options->stats) == 0)
        return cli_usage_error(app, "write one of them to a file",
                               "-o and --stats both write to %s",
                               strcmp(path, "-") ? path : "standard output");
    return CLI_DONE;
}

/* ---- statistics ------------------------------------------------------------------------ */

static void add_stats(csgm_render_stats *sum, const csgm_render_stats *more)
{
    sum->prepare_s += more->prepare_s;
    sum->trace_s += more->trace_s;
    sum->cells += more->cells;
    sum->rays += more->rays;
    sum->shadow_rays += more->shadow_rays;
    sum->hits += more->hits;
    sum->point_evaluations += more->point_evaluations;
    sum->gradient_evaluations += more->gradient_evaluations;
    sum->interval_evaluations += more->interval_evaluations;
    sum->primitive_evaluations += more->primitive_evaluations;
    sum->top_level_evaluations += more->top_level_evaluations;
    sum->total_evaluations += more->total_evaluations;
    sum->memory_peak_bytes = more->memory_peak_bytes;
}

static void put_stats(FILE *out, const cli_app *app, const csgm_render_options *options,
                      uint64_t pictures, const csgm_render_stats *stats)
{
    cli_json json = cli_json_make(out, true);
    bool lazy = options->evaluator == CSGM_EVALUATOR_LAZY;
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    cli_json_count(&json, "pictures", pictures);
    cli_json_count(&json, "width", options->width);
    cli_json_count(&json, "height", options->height);
    cli_json_string(&json, "evaluator", lazy ? "lazy" : "fast");
    cli_json_open(&json, "evaluations", '{');
    if (lazy) {
        cli_json_count(&json, "top_level", stats->top_level_evaluations);
        cli_json_count(&json, "total", stats->total_evaluations);
    } else {
        cli_json_count(&json, "interval", stats->interval_evaluations);
        cli_json_count(&json, "points", stats->point_evaluations);
        cli_json_count(&json, "gradient", stats->gradient_evaluations);
        cli_json_count(&json, "primitive", stats->primitive_evaluations);
    }
    cli_json_end(&json, '}');
    cli_json_count(&json, "cells", stats->cells);
    cli_json_count(&json, "rays", stats->rays);
    cli_json_count(&json, "shadow_rays", stats->shadow_rays);
    cli_json_count(&json, "hits", stats->hits);
    cli_json_open(&json, "time_s", '{');
    cli_json_number(&json, "prepare", stats->prepare_s);
    cli_json_number(&json, "trace", stats->trace_s);
    cli_json_number(&json, "total", cli_now_s() - app->start_s);
    cli_json_end(&json, '}');
    cli_json_count(&json, "memory_peak_bytes", stats->memory_peak_bytes);
    cli_json_count(&json, "threads", csgm_context_threads(app->context));
    cli_json_string(&json, "simd", csgm_context_isa(app->context));
    cli_json_end(&json, '}');
}

static int write_stats(cli_app *app, const csgm_render_options *options, uint64_t pictures,
                       const csgm_render_stats *stats)
{
    cli_text text;
    if (cli_text_open(&text))
        put_stats(text.out, app, options, pictures, stats);
    return cli_text_write(app, &text, app->options->stats);
}

/* ---- pictures -------------------------------------------------------------------------- */

/* "out.png" -> "out-007.png"; the result is the caller's to free. */
static char *name_of_turn(const char *path, uint64_t turn, uint64_t turns)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - path) : strlen(path);
    size_t size = strlen(path) + 32;
    char *name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s-%0*llu%s", (int)stem, path, turns > 1000 ? 4 : 3,
                 (unsigned long long)turn, path + stem);
    return name;
}

static csgm_status save(cli_app *app, const csgm_image *image, csgm_image_format format,
                        uint64_t turn)
{
    const cli_options *options = app->options;
    if (!options->outputs.count)
        return CSGM_OK;
    const char *path = options->outputs.items[0];
    if (strcmp(path, "-") == 0)
        return csgm_image_write_fd(app->context, image, STDOUT_FILENO, "standard output", format);
    if (!options->turntable)
        return csgm_image_write(app->context, image, path, format);
    char *name = name_of_turn(path, turn, options->turntable);
    if (!name) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
        return CSGM_ERR_MEMORY;
    }
    csgm_status status = csgm_image_write(app->context, image, name, format);
    free(name);
    return status;
}

static csgm_status draw(cli_app *app, const subject *s, const csgm_render_options *options,
                        csgm_image **image, csgm_render_stats *stats)
{
    csgm_status status;
    if (s->mesh) {
        csgm_mesh_view view = csgm_mesh_get_view(s->mesh);
        status = csgm_render_mesh(app->context, &view, options, image, stats);
    } else {
        status = csgm_render_scene(app->context, s->work.field, options, image, stats);
    }
    cli_console_end_progress(&app->console);
    if (status != CSGM_OK || !cli_app_is_refused(app))
        return status;
    csgm_image_destroy(*image);
    return CSGM_ERR_SCENE;
}

static int draw_all(cli_app *app, const subject *s, csgm_render_options *options,
                    csgm_image_format format)
{
    uint64_t turns = app->options->turntable ? app->options->turntable : 1;
    double azimuth_deg = options->camera.azimuth_deg;
    csgm_render_stats sum = {0};
    csgm_status status = CSGM_OK;
    for (uint64_t turn = 0; turn < turns && status == CSGM_OK; turn++) {
        csgm_image *image = NULL;
        csgm_render_stats stats;
        options->camera.azimuth_deg = azimuth_deg + 360.0 * (double)turn / (double)turns;
        status = draw(app, s, options, &image, &stats);
        if (status != CSGM_OK)
            break;
        add_stats(&sum, &stats);
        status = save(app, image, format, turn);
        csgm_image_destroy(image);
    }
    if (status != CSGM_OK)
        return cli_exit_status(status);
    return app->options->stats ? write_stats(app, options, turns, &sum) : CLI_DONE;
}

/* The rule for Make or Ninja: of a turntable the targets are all its files. */
static int write_rule(cli_app *app, const subject *s)
{
    cli_list given = app->options->outputs, turns = {0};
    if (!app->options->turntable || !given.count)
        return cli_depfile_write(app, s->work.scene);
    char **names = calloc(app->options->turntable, sizeof *names);
    bool done = names != NULL;
    for (turns.items = (const char **)names; done && turns.count < app->options->turntable;
         turns.count++) {
        names[turns.count] = name_of_turn(given.items[0], turns.count, app->options->turntable);
        done = names[turns.count] != NULL;
    }
    int status = CLI_TROUBLE;
    app->options->outputs = turns;
    if (done)
        status = cli_depfile_write(app, s->work.scene);
    else
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    app->options->outputs = given;
    for (size_t i = 0; i < turns.count; i++)
        free(names[i]);
    free(names);
    return status;
}

int cli_cmd_render(cli_app *app)
{
    csgm_render_options options;
    csgm_image_format format = CSGM_IMAGE_AUTO;
    subject s = {.mesh = NULL};
    int status = check(app, &format);
    if (status == CLI_DONE)
        status = cli_depfile_check(app);
    if (status == CLI_DONE)
        status = cli_picture_options(app, &options);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status == CLI_DONE)
        status = load(app, app->options->operands.items[0], &s);
    if (status == CLI_DONE)
        warn_without_effect(app, s.mesh != NULL);
    if (status == CLI_DONE)
        status = draw_all(app, &s, &options, format);
    if (status == CLI_DONE && app->options->depfile && !s.mesh)
        status = write_rule(app, &s);
    release(&s);
    return status;
}
