/* SPDX-License-Identifier: MIT
 * csgmesh measure SCENE|MESH: volume, centroid, inertia and tight bounds, between proven bounds, of
 * all and of each part.
 * What is proven when a limit or Ctrl-C ends the work is printed too.
 */
#include <math.h>
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

/* Where nobody says how closely, it is as close as some seconds allow. */
static bool is_asked_closely(const cli_app *app)
{
    return app->options->given[CLI_OPTION_measure_to];
}

static csgm_measure_options measure_options(cli_app *app)
{
    enum { CUBES_OF_SECONDS = 1 << 21 };
    const cli_options *o = app->options;
    csgm_measure_options options = csgm_measure_options_default();
    if (o->given[CLI_OPTION_measure_density])
        options.density = o->measure_density;
    if (is_asked_closely(app))
        options.tolerance = o->measure_to;
    else
        options.most_cubes = CUBES_OF_SECONDS;
    options.part = o->part;
    options.monitor = (csgm_monitor){
        .progress = cli_console_progress, .cancelled = ask_interrupted, .user = &app->console};
    return options;
}

static csgm_face_options face_options(cli_app *app)
{
    const cli_options *o = app->options;
    csgm_face_options options = csgm_face_options_default();
    if (o->given[CLI_OPTION_measure_overhang])
        options.overhang_deg = o->measure_overhang;
    if (o->given[CLI_OPTION_measure_draft])
        options.draft_deg = o->measure_draft;
    if (o->measure_upward.count)
        options.up = o->measure_upward.items[0];
    return options;
}

static csgm_wall_options wall_options(cli_app *app)
{
    const cli_options *o = app->options;
    csgm_wall_options options = csgm_wall_options_default();
    if (is_asked_closely(app))
        options.tolerance = o->measure_to;
    if (o->given[CLI_OPTION_measure_finest])
        options.finest = o->measure_finest;
    if (o->given[CLI_OPTION_measure_wall_angle])
        options.angle_deg = o->measure_wall_angle;
    options.monitor = (csgm_monitor){
        .progress = cli_console_progress, .cancelled = ask_interrupted, .user = &app->console};
    return options;
}

static int no_memory(cli_app *app)
{
    return cli_usage_error(app, NULL, "out of memory");
}

/* ---- what is measured --------------------------------------------------------------------------
 */

/* What is measured, how, and the names of its parts. */
typedef struct subject {
    const char *path;
    cli_measured_solid solid;
    unsigned groups; /* of figures */
    const char **names;
    size_t count;
} subject;

/* False: out of memory. */
static bool find_names(subject *s)
{
    if (s->solid.field) {
        s->names = cli_part_names(s->solid.field, &s->count);
        return s->names != NULL;
    }
    s->names = calloc((size_t)s->solid.mesh.part_count + 1, sizeof *s->names);
    for (uint64_t i = 0; s->names && i < s->solid.mesh.part_count; i++)
        if (s->solid.mesh.parts[i].name)
            s->names[s->count++] = s->solid.mesh.parts[i].name;
    return s->names != NULL;
}

static csgm_status measure(cli_app *app, const subject *s, const csgm_measure_options *options,
                           cli_figures *out)
{
    const cli_figure_options all = {*options, face_options(app), wall_options(app)};
    return cli_figures_measure(app->context, &s->solid, &all, s->groups, out);
}

static bool is_stopped(csgm_status status)
{
    return status == CSGM_ERR_LIMIT || status == CSGM_ERR_MEMORY || status == CSGM_CANCELLED;
}

/* As many as could be, in the order of their names; what stopped it, of the last one. */
static csgm_status measure_parts(cli_app *app, const subject *s, csgm_measure_options options,
                                 cli_measured_part *parts, size_t *count)
{
    csgm_status status = CSGM_OK;
    for (*count = 0; *count < s->count && status == CSGM_OK; ++*count) {
        cli_measured_part *part = &parts[*count];
        options.part = part->name = s->names[*count];
        status = measure(app, s, &options, &part->figures);
        if (status != CSGM_OK && !is_stopped(status)) {
            cli_console_say(&app->console, CSGM_ERROR, NULL,
                            "%s: so part \"%.200s\" has no measures", s->path, part->name);
            return status;
        }
    }
    return status;
}

/* ---- what is said ------------------------------------------------------------------------------
 */

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

static void say_how_far(cli_app *app, const cli_measured *measured, csgm_status status,
                        bool is_reached)
{
    if (status == CSGM_CANCELLED)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "interrupted: this is proven so far");
    else if (status == CSGM_OK && !is_reached)
        cli_console_say(&app->console, CSGM_WARNING,
                        "where gradients have no bounds, intervals shrink slowly: a larger --to",
                        "%s could not be measured to %g: this is what is proven", measured->path,
                        measured->to);
}

/* What a check on walls or gaps does not speak of. */
static void say_what_is_overlooked(cli_app *app, const cli_measured *measured)
{
    const csgm_walls *walls = &measured->figures->walls;
    double most = fmax(walls->wall.overlooked, walls->gap.overlooked);
    if (measured->checks.count && most > 0)
        cli_console_say(
            &app->console, CSGM_WARNING, "a smaller --finest looks closer",
            "%s: walls or gaps below %g were not looked for where normals are not known",
            measured->path, most);
}

static bool are_reached(const cli_measured *measured)
{
    bool all = cli_figures_are_reached(measured->figures);
    for (size_t i = 0; i < measured->part_count; i++)
        all = all && cli_figures_are_reached(&measured->parts[i].figures);
    return all;
}

/* status: of the measuring; what is proven is printed after a limit, too. What is checked decides
 * about the exit status: what is proven by then is proven. */
static int print(cli_app *app, cli_measured *measured, csgm_status status)
{
    const cli_options *o = app->options;
    bool is_reached = !is_asked_closely(app) || are_reached(measured);
    cli_console_end_progress(&app->console);
    if (status != CSGM_OK && !is_stopped(status))
        return cli_exit_status(status);
    say_how_far(app, measured, status, is_reached);
    if (!cli_checks_decide(&measured->checks, &o->measure_checks, measured->figures))
        return no_memory(app);
    if (!o->measure_junit || strcmp(o->measure_junit, "-") != 0)
        (o->json ? cli_measure_json : cli_measure_text)(measured);
    say_what_is_overlooked(app, measured);
    int result = status != CSGM_OK || !is_reached ? CLI_TROUBLE : CLI_DONE;
    if (measured->checks.count)
        result = report_checks(app, measured);
    if (o->measure_junit && cli_measure_junit(app, measured) != CLI_DONE)
        result = CLI_TROUBLE;
    return result;
}

static int measure_and_print(cli_app *app, const subject *s, const csgm_measure_options *options)
{
    cli_figures figures;
    cli_measured measured = {.path = s->path,
                             .part = options->part,
                             .is_mesh = !s->solid.field,
                             .figures = &figures,
                             .density = options->density,
                             .to = options->tolerance};
    cli_measured_part *parts = NULL;
    csgm_status status = measure(app, s, options, &figures);
    if (status == CSGM_OK && app->options->measure_each_part) {
        parts = calloc(s->count + 1, sizeof *parts);
        if (!parts)
            return no_memory(app);
        status = measure_parts(app, s, *options, parts, &measured.part_count);
        measured.parts = parts;
    }
    int result = print(app, &measured, status);
    cli_checks_release(&measured.checks);
    free(parts);
    return result;
}

static int measure_subject(cli_app *app, subject *s)
{
    csgm_measure_options options = measure_options(app);
    int status = CLI_DONE;
    if (!find_names(s))
        return no_memory(app);
    if (options.part)
        status = cli_part_find(app, s->path, options.part, s->names, s->count);
    if (status == CLI_DONE)
        status = measure_and_print(app, s, &options);
    free(s->names);
    return status;
}

static int measure_mesh(cli_app *app, const char *path, csgm_format format, unsigned groups)
{
    csgm_mesh *mesh = NULL;
    int status = cli_exit_status(csgm_mesh_read(app->context, path, format, &mesh));
    if (status == CLI_DONE) {
        subject s = {.path = path, .solid.mesh = csgm_mesh_get_view(mesh), .groups = groups};
        status = measure_subject(app, &s);
    }
    csgm_mesh_destroy(mesh);
    return status;
}

static int measure_scene(cli_app *app, const char *path, unsigned groups)
{
    cli_work work = {0};
    int status = cli_work_load(app, &work, path);
    if (status == CLI_DONE)
        status = cli_exit_status(csgm_field_compile(app->context, work.scene, &work.field));
    if (status == CLI_DONE) {
        subject s = {.path = path, .solid.field = work.field, .groups = groups};
        cli_interrupt_ask_first();
        status = measure_subject(app, &s);
    }
    cli_work_release(&work);
    return status;
}

static bool asks_faces(const cli_app *app)
{
    const bool *given = app->options->given;
    return given[CLI_OPTION_measure_overhang] || given[CLI_OPTION_measure_draft] ||
           given[CLI_OPTION_measure_upward];
}

/* Angles and a direction that make sense. */
static int read_faces(cli_app *app, unsigned *groups)
{
    const csgm_face_options faces = face_options(app);
    if (!(faces.overhang_deg < 90 && faces.draft_deg < 90))
        return cli_usage_error(app, NULL, "--overhang and --draft are angles below 90 degrees");
    if (app->options->measure_upward.count > 1)
        return cli_usage_error(app, NULL, "--upward is one direction");
    if (faces.up.x == 0 && faces.up.y == 0 && faces.up.z == 0)
        return cli_usage_error(app, NULL, "--upward 0,0,0 is no direction");
    *groups |= asks_faces(app) ? CLI_FIGURES_FACES : 0;
    return CLI_DONE;
}

static bool asks_walls(const cli_app *app)
{
    const bool *given = app->options->given;
    return given[CLI_OPTION_measure_walls] || given[CLI_OPTION_measure_finest] ||
           given[CLI_OPTION_measure_wall_angle];
}

static int read_walls(cli_app *app, unsigned *groups)
{
    static const double MOST_DEG = 40;
    if (!(wall_options(app).angle_deg <= MOST_DEG))
        return cli_usage_error(app, NULL, "--wall-angle is at most %g degrees", MOST_DEG);
    *groups |= asks_walls(app) ? CLI_FIGURES_WALLS : 0;
    return CLI_DONE;
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
    if (app->options->measure_each_part && app->options->part)
        return cli_usage_error(app, NULL, "--part measures one part, --each-part all: give one");
    unsigned groups = app->options->measure_box ? CLI_FIGURES_BOX : 0;
    int status = read_walls(app, &groups);
    if (status == CLI_DONE)
        status = read_faces(app, &groups);
    if (status == CLI_DONE)
        status = cli_checks_read(app, &app->options->measure_checks, &groups);
    if (status == CLI_DONE && app->options->measure_junit && !app->options->measure_checks.count)
        return cli_usage_error(app, "as --check 'volume < 1000'", "--junit needs a --check");
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status != CLI_DONE)
        return status;
    const char *path = operands->items[0];
    bool is_mesh = asked != CSGM_FORMAT_AUTO || cli_path_is_mesh(path);
    if (is_mesh && asks_walls(app))
        return cli_usage_error(app, "import(\"part.stl\"); is a scene",
                               "--walls, --finest and --wall-angle are of scenes, not of meshes");
    status = is_mesh ? measure_mesh(app, path, asked, groups) : measure_scene(app, path, groups);
    return cli_finish_stdout(app, status);
}
