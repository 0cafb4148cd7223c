/* SPDX-License-Identifier: MIT
 * csgmesh measure SCENE|MESH: volume, centroid, inertia and tight bounds, between proven bounds.
 * What is proven when a limit or Ctrl-C ends the work is printed too.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/interrupt.h"
#include "core/mesh_files.h"
#include "core/options.h"
#include "core/part_names.h"
#include "core/work.h"
#include "measure/measure_print.h"

static bool ask_interrupted(void *user)
{
    (void)user;
    return cli_interrupt_is_asked();
}

static csgm_measure_options measure_options(cli_app *app)
{
    const cli_options *o = app->options;
    csgm_measure_options options = csgm_measure_options_default();
    if (o->given[CLI_OPTION_measure_density])
        options.density = o->measure_density;
    if (o->given[CLI_OPTION_measure_to])
        options.tolerance = o->measure_to;
    options.part = o->measure_part;
    options.monitor = (csgm_monitor){
        .progress = cli_console_progress, .cancelled = ask_interrupted, .user = &app->console};
    return options;
}

static int no_memory(cli_app *app)
{
    return cli_usage_error(app, NULL, "out of memory");
}

static int find_part_of_field(cli_app *app, const char *path, const csgm_field *field)
{
    size_t count = 0;
    const char *name;
    while (csgm_field_part(field, count, &name))
        count++;
    const char **names = calloc(count + 1, sizeof *names);
    if (!names)
        return no_memory(app);
    for (size_t i = 0; i < count; i++)
        csgm_field_part(field, i, &names[i]);
    int status = cli_part_find(app, path, app->options->measure_part, names, count);
    free(names);
    return status;
}

static int find_part_of_mesh(cli_app *app, const char *path, const csgm_mesh_view *view)
{
    const char **names = calloc(view->part_count + 1, sizeof *names);
    if (!names)
        return no_memory(app);
    for (uint64_t i = 0; i < view->part_count; i++)
        names[i] = view->parts[i].name;
    int status =
        cli_part_find(app, path, app->options->measure_part, names, (size_t)view->part_count);
    free(names);
    return status;
}

/* What the checks come to: the worst of them. */
static int report_checks(cli_app *app, const cli_measured *measured)
{
    cli_truth worst = CLI_HOLDS;
    for (size_t i = 0; i < measured->checks.count; i++) {
        const cli_check *check = &measured->checks.items[i];
        worst = check->truth < worst ? check->truth : worst;
        if (check->truth == CLI_FAILS)
            cli_console_say(&app->console, CSGM_ERROR, NULL, "%s: this fails: %.400s",
                            measured->path, check->text);
        else if (check->truth == CLI_UNDECIDED)
            cli_console_say(
                &app->console, CSGM_ERROR, "a smaller --to makes the measures' intervals narrower",
                "%s: this can be neither proven nor refuted: %.400s", measured->path, check->text);
    }
    return worst == CLI_HOLDS ? CLI_DONE : worst == CLI_FAILS ? CLI_INPUT_AT_FAULT : CLI_TROUBLE;
}

/* status: of the measuring; what is proven is printed after a limit, too. What is checked decides
 * about the exit status: what is proven by then is proven. */
static int print(cli_app *app, const char *path, bool is_mesh, csgm_status status,
                 const csgm_measure_options *options, const csgm_measures *measures)
{
    bool is_stopped =
        status == CSGM_ERR_LIMIT || status == CSGM_ERR_MEMORY || status == CSGM_CANCELLED;
    const cli_options *o = app->options;
    cli_measured measured = {.path = path,
                             .part = options->part,
                             .is_mesh = is_mesh,
                             .measures = measures,
                             .density = options->density,
                             .to = options->tolerance};
    cli_console_end_progress(&app->console);
    if (status != CSGM_OK && !is_stopped)
        return cli_exit_status(status);
    if (status == CSGM_CANCELLED)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "interrupted: this is proven so far");
    else if (status == CSGM_OK && !measures->is_reached)
        cli_console_say(&app->console, CSGM_WARNING,
                        "where gradients have no bounds, intervals shrink slowly: a larger --to",
                        "%s could not be measured to %g: this is what is proven", path,
                        options->tolerance);
    if (!cli_checks_decide(&measured.checks, &o->measure_checks, measures)) {
        cli_checks_release(&measured.checks);
        return no_memory(app);
    }
    if (!o->measure_junit || strcmp(o->measure_junit, "-") != 0)
        (o->json ? cli_measure_json : cli_measure_text)(&measured);
    int result = is_stopped || !measures->is_reached ? CLI_TROUBLE : CLI_DONE;
    if (measured.checks.count)
        result = report_checks(app, &measured);
    if (o->measure_junit && cli_measure_junit(app, &measured) != CLI_DONE)
        result = CLI_TROUBLE;
    cli_checks_release(&measured.checks);
    return result;
}

static int measure_mesh(cli_app *app, const char *path, csgm_format format)
{
    csgm_mesh *mesh = NULL;
    csgm_measure_options options = measure_options(app);
    csgm_measures measures = csgm_measures_default();
    int status = cli_exit_status(csgm_mesh_read(app->context, path, format, &mesh));
    if (status == CLI_DONE) {
        csgm_mesh_view view = csgm_mesh_get_view(mesh);
        if (options.part)
            status = find_part_of_mesh(app, path, &view);
        if (status == CLI_DONE) {
            csgm_status made = csgm_measure_mesh(app->context, &view, &options, &measures);
            status = print(app, path, true, made, &options, &measures);
        }
    }
    csgm_mesh_destroy(mesh);
    return status;
}

static int measure_scene(cli_app *app, const char *path)
{
    cli_work work = {0};
    csgm_measure_options options = measure_options(app);
    csgm_measures measures = csgm_measures_default();
    int status = cli_work_load(app, &work, path);
    if (status == CLI_DONE)
        status = cli_exit_status(csgm_field_compile(app->context, work.scene, &work.field));
    if (status == CLI_DONE && options.part)
        status = find_part_of_field(app, path, work.field);
    if (status == CLI_DONE) {
        cli_interrupt_ask_first();
        csgm_status made = csgm_measure_field(app->context, work.field, &options, &measures);
        status = print(app, path, false, made, &options, &measures);
    }
    cli_work_release(&work);
    return status;
}

int cli_cmd_measure(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    csgm_format asked = CSGM_FORMAT_AUTO;
    if (operands->count != 1)
        return cli_usage_error(app, "as csgmesh measure mug.txt",
                               operands->count ? "one scene or mesh is measured at a time"
                                               : "no scene or mesh given");
    if (app->options->format) {
        asked = csgm_format_from_name(app->options->format);
        if (asked == CSGM_FORMAT_AUTO)
            return cli_usage_error(app, NULL, "unknown format '%s'", app->options->format);
    }
    int status = cli_checks_read(app, &app->options->measure_checks);
    if (status == CLI_DONE && app->options->measure_junit && !app->options->measure_checks.count)
        return cli_usage_error(app, "as --check 'volume < 1000'", "--junit needs a --check");
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status != CLI_DONE)
        return status;
    const char *path = operands->items[0];
    bool is_mesh = asked != CSGM_FORMAT_AUTO || cli_path_is_mesh(path);
    status = is_mesh ? measure_mesh(app, path, asked) : measure_scene(app, path);
    return cli_finish_stdout(app, status);
}
