/* SPDX-License-Identifier: MIT
 * csgmesh slice SCENE -o OUT.svg --layer H: the contours of layers, straight from the field.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/interrupt.h"
#include "core/json.h"
#include "core/options.h"
#include "core/part_names.h"
#include "core/work.h"
#include "csgmesh/slicing.h"
#include "mesh/outputs.h"

static bool ask_interrupted(void *user)
{
    (void)user;
    return cli_interrupt_is_asked();
}

static csgm_slice_options slice_options(cli_app *app)
{
    const cli_options *o = app->options;
    csgm_slice_options options = csgm_slice_options_default();
    options.height = o->layer;
    if (o->given[CLI_OPTION_most_layer]) {
        options.most_height = o->most_layer;
        options.cusp = o->cusp;
    }
    if (o->given[CLI_OPTION_tolerance])
        options.tolerance = o->tolerance;
    if (o->given[CLI_OPTION_pixel])
        options.pixel = o->pixel;
    options.part = o->part;
    options.unit = cli_outputs_unit(o);
    options.sync = !o->no_sync;
    options.monitor = (csgm_monitor){
        .progress = cli_console_progress, .cancelled = ask_interrupted, .user = &app->console};
    return options;
}

/* The names of the formats that this build has: " .svg" and so on. */
static void list_formats(char *text, size_t size)
{
    size_t length = 0;
    for (int i = CSGM_LAYERS_NONE + 1; i < CSGM_LAYERS_COUNT && length < size; i++)
        if (csgm_layers_format_available((csgm_layers_format)i))
            length += (size_t)snprintf(text + length, size - length, " .%s",
                                       csgm_layers_format_name((csgm_layers_format)i));
}

static int find_format(cli_app *app, const char *path, csgm_layers_format *out)
{
    char known[80], hint[120];
    list_formats(known, sizeof known);
    snprintf(hint, sizeof hint, "layers are written as%s", known);
    const char *named = app->options->format;
    *out = named ? csgm_layers_format_from_name(named) : csgm_layers_format_from_path(path);
    if (*out != CSGM_LAYERS_NONE && !csgm_layers_format_available(*out))
        return cli_usage_error(app, hint, "this build cannot write %s", path);
    if (*out != CSGM_LAYERS_NONE)
        return CLI_DONE;
    if (named)
        return cli_usage_error(app, hint, "layers have no format '%.80s'", named);
    if (strcmp(path, "-") == 0)
        return cli_usage_error(app, hint, "standard output needs a format: add -f svg");
    return cli_usage_error(app, hint, "the name '%s' tells no format of layers", path);
}

static int check_usage(cli_app *app, csgm_layers_format *format)
{
    const cli_options *o = app->options;
    if (o->operands.count != 1)
        return cli_usage_error(app, "as csgmesh slice mug.txt --layer 0.2 -o layers.svg",
                               o->operands.count ? "one scene is sliced at a time"
                                                 : "no scene given");
    if (o->outputs.count != 1)
        return cli_usage_error(app, "as -o layers.svg",
                               o->outputs.count ? "layers go to one file" : "no output file");
    if (!o->given[CLI_OPTION_layer])
        return cli_usage_error(app, "as --layer 0.2", "how high is a layer?");
    if (o->given[CLI_OPTION_cusp] != o->given[CLI_OPTION_most_layer])
        return cli_usage_error(app, "as --layer 0.05 --most-layer 0.3 --cusp 0.02",
                               "--most-layer and --cusp go together");
    if (o->given[CLI_OPTION_most_layer] && !(o->most_layer > o->layer))
        return cli_usage_error(app, NULL, "--most-layer must be more than --layer");
    int status = find_format(app, o->outputs.items[0], format);
    return status == CLI_DONE ? cli_outputs_check_place(app, o->outputs.items[0]) : status;
}

static void print_text(const csgm_slice_stats *s)
{
    printf("layers    %llu", (unsigned long long)s->layers);
    if (s->highest > s->lowest * (1 + 1e-9))
        printf(", from %g to %g high", s->lowest, s->highest);
    printf("\n");
    printf("contours  %llu, of %llu points\n", (unsigned long long)s->contours,
           (unsigned long long)s->points);
    printf("within    %g; what is not shown is thinner\n", s->tolerance);
    printf("volume    %g\n", s->volume);
    if (s->sampled)
        printf("heights   sampled in %llu cubes of %g, where normals have no bounds\n",
               (unsigned long long)s->sampled, s->sampled_edge);
    if (s->unsettled)
        printf("unsettled %llu cubes of %g: something thinner than %g may be there\n",
               (unsigned long long)s->unsettled, s->smallest, s->tolerance);
}

static void print_json(const char *scene, const char *path, const csgm_slice_options *options,
                       const csgm_slice_stats *s)
{
    cli_json json = cli_json_make(stdout, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "scene", scene);
    if (options->part)
        cli_json_string(&json, "part", options->part);
    cli_json_string(&json, "file", path);
    cli_json_number(&json, "layer", options->height);
    if (options->most_height > 0) {
        cli_json_number(&json, "most_layer", options->most_height);
        cli_json_number(&json, "cusp", options->cusp);
        cli_json_number(&json, "lowest", s->lowest);
        cli_json_number(&json, "highest", s->highest);
        cli_json_count(&json, "sampled", s->sampled);
    }
    cli_json_count(&json, "layers", s->layers);
    cli_json_count(&json, "contours", s->contours);
    cli_json_count(&json, "points", s->points);
    cli_json_number(&json, "tolerance", s->tolerance);
    cli_json_number(&json, "volume", s->volume);
    cli_json_count(&json, "unsettled", s->unsettled);
    cli_json_number(&json, "smallest", s->smallest);
    cli_json_end(&json, '}');
}

/* Has the scene a part of that name? */
static int check_part(cli_app *app, const char *scene, const csgm_field *field)
{
    const char *wanted = app->options->part;
    size_t count;
    if (!wanted)
        return CLI_DONE;
    const char **names = cli_part_names(field, &count);
    int status = names ? cli_part_find(app, scene, wanted, names, count)
                       : cli_usage_error(app, NULL, "out of memory");
    free(names);
    return status;
}

static int slice_scene(cli_app *app, const char *scene, csgm_layers_format format)
{
    cli_work work = {0};
    const char *path = app->options->outputs.items[0];
    csgm_slice_options options = slice_options(app);
    csgm_slice_stats stats = csgm_slice_stats_default();
    bool is_stdout = strcmp(path, "-") == 0;
    int status = cli_work_load(app, &work, scene);
    if (status == CLI_DONE)
        status = cli_exit_status(csgm_field_compile(app->context, work.scene, &work.field));
    if (status == CLI_DONE)
        status = check_part(app, scene, work.field);
    if (status == CLI_DONE) {
        cli_interrupt_ask_first();
        csgm_status made =
            is_stdout ? csgm_slice_field_fd(app->context, work.field, STDOUT_FILENO,
                                            "standard output", format, &options, &stats)
                      : csgm_slice_field(app->context, work.field, path, format, &options, &stats);
        cli_console_end_progress(&app->console);
        if (made == CSGM_CANCELLED)
            cli_console_say(&app->console, CSGM_ERROR, NULL, "interrupted: %s was not written",
                            path);
        status = cli_exit_status(made);
    }
    cli_work_release(&work);
    if (status == CLI_DONE && app->options->json)
        print_json(scene, path, &options, &stats);
    else if (status == CLI_DONE && !is_stdout)
        print_text(&stats);
    return status;
}

int cli_cmd_slice(cli_app *app)
{
    csgm_layers_format format = CSGM_LAYERS_NONE;
    int status = check_usage(app, &format);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status != CLI_DONE)
        return status;
    return cli_finish_stdout(app, slice_scene(app, app->options->operands.items[0], format));
}
