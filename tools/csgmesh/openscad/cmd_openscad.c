/* SPDX-License-Identifier: MIT
 * csgmesh openscad ...: OpenSCAD's command line in csgmesh's words. Meshes and drawings are runs of
 * `mesh`, a picture is one of `render`, trees and echoes are written here; of an animation all that
 * for each picture. What a scene says is shown by the first run.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/commands.h"
#include "core/options.h"
#include "core/sandbox.h"
#include "core/sources.h"
#include "core/textfile.h"
#include "mesh/depfile.h"
#include "openscad/openscad_parts.h"

enum { MOST_MADE = 8, MOST_OTHERS = 40 /* words beside those of the scene and the outputs */ };

typedef struct openscad_run {
    const openscad_line *line;
    uint64_t frame;
    bool is_first;    /* nothing has been said yet */
    bool needs_rule;  /* the rule for make has not been written */
    csgm_box box;     /* of the scene, for the camera */
    const char *path; /* of the output at work */
    const char *format;
    double seconds; /* that the meshes took */
} openscad_run;

/* A command line of csgmesh that is being made. */
typedef struct openscad_words {
    cli_list list;
    char *made[MOST_MADE]; /* words that are owned */
    size_t made_count;
    bool failed; /* out of memory */
} openscad_words;

/* ---- words -------------------------------------------------------------------------------- */

static void add(openscad_words *w, const char *word)
{
    if (w->list.items)
        w->list.items[w->list.count++] = word;
}

static void add_pair(openscad_words *w, const char *option, const char *value)
{
    if (!value)
        return;
    add(w, option);
    add(w, value);
}

__attribute__((format(printf, 3, 4))) static void add_made(openscad_words *w, const char *option,
                                                           const char *format, ...)
{
    char text[320];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    char *made = w->made_count < MOST_MADE ? strdup(text) : NULL;
    w->failed |= !made;
    if (!made)
        return;
    w->made[w->made_count++] = made;
    add_pair(w, option, made);
}

/* All that says how the scene is read. */
static openscad_words begin_words(const openscad_run *run, bool preview)
{
    const openscad_line *line = run->line;
    size_t room = 2 * line->defines.count + 2 * line->output_count + MOST_OTHERS;
    openscad_words w = {.list = {calloc(room, sizeof(const char *)), 0}};
    w.failed = !w.list.items;
    for (size_t i = 0; i < line->defines.count; i++)
        add_pair(&w, "-D", line->defines.items[i]);
    if (line->frames)
        add_made(&w, "-D", "$t=%.17g", (double)run->frame / (double)line->frames);
    if (preview)
        add_pair(&w, "-D", "$preview=true");
    add_pair(&w, "-p", line->parameter_file);
    add_pair(&w, "-P", line->parameter_set);
    add_pair(&w, "--facets", line->facets);
    if (line->hard_warnings)
        add_pair(&w, "-W", "error");
    if (line->quiet || !run->is_first)
        add(&w, "-q");
    return w;
}

static void release_words(openscad_words *w)
{
    for (size_t i = 0; i < w->made_count; i++)
        free(w->made[i]);
    free(w->list.items);
}

typedef int openscad_work(cli_app *app, openscad_run *run);

/* Runs one command on the scene. */
static int run_words(openscad_words *w, openscad_run *run, cli_command command, openscad_work *work)
{
    cli_options options = {.command = CLI_MESH};
    cli_app app = {.options = &options, .start_s = cli_now_s(), .console = cli_console_make()};
    cli_problem problem;
    int status = CLI_TROUBLE;
    add(w, "--");
    add(w, run->line->scene);
    bool parsed = !w->failed && cli_options_parse(&options, command, (int)w->list.count,
                                                  (char **)w->list.items, &problem);
    cli_console_configure(&app.console, &options);
    if (parsed)
        status = work(&app, run);
    else
        cli_usage_error(&app, "csgmesh help openscad lists the options", "openscad: %s",
                        w->failed ? "out of memory" : problem.message);
    cli_console_flush(&app.console);
    csgm_context_destroy(app.context);
    cli_options_release(&options);
    release_words(w);
    run->is_first = false;
    return status;
}

/* ---- trees and echoes --------------------------------------------------------------------- */

static void put_text(void *user, const char *text, size_t length)
{
    fwrite(text, 1, length, user);
}

/* Loads the scene for an output that is written here; with the rule for make, if it is due. */
static int load(cli_app *app, openscad_run *run, csgm_scene **scene)
{
    app->options->outputs = (cli_list){&run->path, 1}; /* to be guarded, and named by the rule */
    app->options->depfile = run->needs_rule ? run->line->depfile : NULL;
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_exit_status(cli_app_load(app, app->options->operands.items[0], scene));
    if (status == CLI_DONE)
        status = cli_sources_guard_scene(app, *scene);
    if (status == CLI_DONE && app->options->depfile)
        status = cli_depfile_write(app, *scene);
    app->options->outputs = (cli_list){NULL, 0};
    return status;
}

static int write_tree(cli_app *app, openscad_run *run)
{
    csgm_scene *scene = NULL;
    cli_text text;
    app->flat = CSGM_FLAT_KEPT;
    int status = load(app, run, &scene);
    FILE *out = status == CLI_DONE ? cli_text_open(&text) : NULL;
    if (out)
        status = cli_exit_status(
            csgm_scene_dump(app->context, scene, CSGM_DUMP_OPENSCAD, put_text, out));
    if (out && status != CLI_DONE)
        free(cli_text_close(&text));
    else if (status == CLI_DONE)
        status = cli_text_write(app, &text, run->path);
    csgm_scene_destroy(scene);
    return status;
}

/* All that is said goes to the file; where the scene is at fault, to standard error too. */
static int write_echo(cli_app *app, openscad_run *run)
{
    csgm_scene *scene = NULL;
    cli_text text;
    FILE *usual = app->console.out, *out = cli_text_open(&text);
    bool color = app->console.color;
    if (!out)
        return cli_usage_error(app, NULL, "openscad: out of memory");
    app->console.out = out;
    app->console.quiet = app->console.color = false;
    app->flat = CSGM_FLAT_KEPT;
    int status = load(app, run, &scene);
    cli_console_flush(&app->console);
    app->console.out = usual;
    app->console.color = color;
    csgm_scene_destroy(scene);
    fflush(out);
    if (status != CLI_DONE)
        fwrite(text.text, 1, text.length, usual);
    int written = status == CLI_TROUBLE ? status : cli_text_write(app, &text, run->path);
    if (status == CLI_TROUBLE)
        free(cli_text_close(&text));
    return status != CLI_DONE ? status : written;
}

/* ---- pictures ----------------------------------------------------------------------------- */

static int measure(cli_app *app, openscad_run *run)
{
    csgm_scene *scene = NULL;
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_exit_status(cli_app_load(app, app->options->operands.items[0], &scene));
    if (status == CLI_DONE)
        run->box = csgm_scene_get_info(scene).bounds;
    csgm_scene_destroy(scene);
    return status;
}

static int draw(cli_app *app, openscad_run *run)
{
    (void)run;
    return cli_cmd_render(app);
}

static void add_camera(openscad_words *w, const openscad_line *line, csgm_box box)
{
    if (line->orthographic)
        add_pair(w, "--projection", "orthographic");
    else
        add_made(w, "--fov", "%g", OPENSCAD_FOV);
    if (!line->camera_numbers) { /* all of the solid, from where OpenSCAD looks by default */
        add_pair(w, "--view", "25,35");
        return;
    }
    openscad_view v = openscad_view_of(line, box);
    add_made(w, "--camera", "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", v.eye.x,
             v.eye.y, v.eye.z, v.target.x, v.target.y, v.target.z, v.up.x, v.up.y, v.up.z);
    if (line->orthographic)
        add_made(w, "--height", "%.17g", v.height);
}

static int write_picture(openscad_run *run)
{
    const openscad_line *line = run->line;
    int status = CLI_DONE;
    if (line->camera_numbers && line->view_all) {
        openscad_words w = begin_words(run, !line->is_rendered);
        status = run_words(&w, run, CLI_CHECK, measure);
    }
    if (status != CLI_DONE)
        return status;
    openscad_words w = begin_words(run, !line->is_rendered);
    add_made(&w, "--size", "%ux%u", line->width, line->height);
    add_pair(&w, "--background", line->background);
    add_camera(&w, line, run->box);
    add_pair(&w, "-f", "png");
    add_pair(&w, "-o", run->path);
    if (run->needs_rule)
        add_pair(&w, "-M", line->depfile);
    return run_words(&w, run, CLI_RENDER, draw);
}

/* ---- outputs ------------------------------------------------------------------------------ */

static int make_mesh(cli_app *app, openscad_run *run)
{
    int status = cli_cmd_mesh(app);
    run->seconds += cli_now_s() - app->start_s;
    return status;
}

static int summarize(cli_app *app, openscad_run *run)
{
    int status = cli_app_open(app);
    if (status != CLI_DONE)
        return status;
    return openscad_summarize(app, run->line, run->path, run->format, run->seconds);
}

/* "out.png" -> "out00007.png", as OpenSCAD names them; NULL: no memory. */
static char *name_of_frame(const openscad_run *run, const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - path) : strlen(path);
    size_t size = strlen(path) + 24;
    char *name = malloc(size);
    if (name && (!run->line->frames || strcmp(path, "-") == 0))
        snprintf(name, size, "%s", path);
    else if (name)
        snprintf(name, size, "%.*s%05llu%s", (int)stem, path, (unsigned long long)run->frame,
                 path + stem);
    return name;
}

static int write_meshes(openscad_run *run, char *const *names)
{
    const openscad_line *line = run->line;
    int status = CLI_DONE;
    for (size_t i = 0; i < line->output_count && status == CLI_DONE; i++) {
        const openscad_output *first = &line->outputs[i];
        bool joins = false; /* an earlier output that its name alone describes takes it along */
        for (size_t k = 0; k < i && !first->format; k++)
            joins |= line->outputs[k].way == OPENSCAD_MESH && !line->outputs[k].format;
        if (first->way != OPENSCAD_MESH || joins)
            continue;
        openscad_words w = begin_words(run, false);
        add_pair(&w, "-o", names[i]);
        add_pair(&w, "-f", first->format);
        if (first->ascii)
            add(&w, "--ascii");
        for (size_t k = i + 1; k < line->output_count && !first->format; k++)
            if (line->outputs[k].way == OPENSCAD_MESH && !line->outputs[k].format)
                add_pair(&w, "-o", names[k]);
        if (run->needs_rule)
            add_pair(&w, "-M", line->depfile);
        status = run_words(&w, run, CLI_MESH, make_mesh);
        run->needs_rule = false;
    }
    return status;
}

static int write_others(openscad_run *run, char *const *names)
{
    const openscad_line *line = run->line;
    int status = CLI_DONE;
    for (size_t i = 0; i < line->output_count && status == CLI_DONE; i++) {
        openscad_way way = line->outputs[i].way;
        run->path = names[i];
        if (way == OPENSCAD_MESH)
            continue;
        if (way == OPENSCAD_PICTURE) {
            status = write_picture(run);
        } else {
            openscad_words w = begin_words(run, way == OPENSCAD_ECHO);
            status = run_words(&w, run, CLI_DUMP, way == OPENSCAD_ECHO ? write_echo : write_tree);
        }
        run->needs_rule = false;
    }
    return status;
}

static int write_summary(openscad_run *run, char *const *names)
{
    const openscad_line *line = run->line;
    for (size_t i = 0; i < line->output_count; i++) {
        const openscad_output *output = &line->outputs[i];
        if (!openscad_is_mesh_file(output))
            continue;
        openscad_words w = begin_words(run, false);
        run->path = names[i];
        run->format = output->format;
        return run_words(&w, run, CLI_CHECK, summarize);
    }
    return CLI_DONE;
}

static int write_frame(cli_app *app, openscad_run *run)
{
    const openscad_line *line = run->line;
    char **names = calloc(line->output_count, sizeof *names);
    bool named = names != NULL;
    for (size_t i = 0; i < line->output_count && named; i++) {
        names[i] = name_of_frame(run, line->outputs[i].path);
        named = names[i] != NULL;
    }
    int status = named ? write_meshes(run, names) : cli_usage_error(app, NULL, "out of memory");
    if (status == CLI_DONE)
        status = write_others(run, names);
    if (status == CLI_DONE && (line->summary || line->summary_file))
        status = write_summary(run, names);
    for (size_t i = 0; i < line->output_count && names; i++)
        free(names[i]);
    free(names);
    return status;
}

/* All that will be written against each other and the scene, before anything is. */
static int guard(cli_app *app, const openscad_line *line)
{
    cli_options *options = app->options; /* which releases the lists */
    options->operands.items = calloc(1, sizeof(const char *));
    options->outputs.items = calloc(line->output_count, sizeof(const char *));
    if (!options->operands.items || !options->outputs.items)
        return cli_usage_error(app, NULL, "out of memory");
    options->operands.items[options->operands.count++] = line->scene;
    for (size_t i = 0; i < line->output_count; i++)
        options->outputs.items[options->outputs.count++] = line->outputs[i].path;
    options->depfile = line->depfile;
    options->stats = line->summary_file;
    return cli_sources_guard(app);
}

int cli_cmd_openscad(cli_app *app)
{
    openscad_line line;
    int status = openscad_line_read(app, &line);
    if (status == CLI_DONE && line.help) {
        cli_help_command(CLI_OPENSCAD);
        status = cli_finish_stdout(app, CLI_DONE);
    } else if (status == CLI_DONE && (line.version || line.info)) {
        status = cli_print_version(app);
    } else if (status == CLI_DONE) {
        openscad_run run = {.line = &line, .is_first = true, .needs_rule = line.depfile != NULL};
        status = cli_confine(app);
        if (status == CLI_DONE)
            status = guard(app, &line);
        uint64_t end = line.frames ? line.end_frame : 1;
        for (run.frame = line.first_frame; run.frame < end && status == CLI_DONE; run.frame++)
            status = write_frame(app, &run);
    }
    openscad_line_release(&line);
    return status;
}
