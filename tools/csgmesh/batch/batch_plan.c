/* SPDX-License-Identifier: MIT
 * Entries -> jobs; see batch_plan.h. A scene's pattern becomes scenes, sets become jobs, formats
 * and the pattern of names become outputs; no two of them may be the same file.
 */
#include "batch/batch_plan.h"

#include <errno.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch/batch_manifest.h"
#include "batch/batch_names.h"
#include "core/format_lists.h"
#include "core/options.h"
#include "core/sources.h"
#include "mesh/drawings.h"
#include "mesh/outputs.h"

static const char DEFAULT_NAME[] = "{scene}-{set}.{ext}";

__attribute__((format(printf, 4, 5))) static int refuse(const batch_plan *plan, const char *place,
                                                        const char *hint, const char *format, ...)
{
    char message[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    cli_console_say(&plan->app->console, CSGM_ERROR, hint, "%s%s%s", place, *place ? ": " : "",
                    message);
    return *place ? CLI_INPUT_AT_FAULT : CLI_TROUBLE;
}

/* ---- formats and outputs -------------------------------------------------------------- */

static int check_format(batch_plan *plan, const char *place, const char *name, bool by_part)
{
    csgm_format format = csgm_format_from_name(name);
    bool is_drawing = csgm_drawing_format_from_name(name) != CSGM_DRAWING_NONE;
    if (is_drawing && by_part)
        return refuse(plan, place, "a drawing has a layer for each part",
                      "{part} makes no files of the format '%s'", name);
    if (is_drawing)
        return CLI_DONE;
    if (format != CSGM_FORMAT_AUTO && csgm_format_available(format, false))
        return CLI_DONE;
    char known[160];
    cli_formats_of_this_build(known, sizeof known);
    return refuse(plan, place, known,
                  format == CSGM_FORMAT_AUTO ? "unknown format '%s'" : "this build cannot write %s",
                  name);
}

/* "glb,stl" */
static cli_list split_formats(cli_arena *arena, const char *text)
{
    cli_list list = {0};
    for (;; text++) {
        size_t length = strcspn(text, ",");
        cli_list_add(arena, &list, cli_arena_strndup(arena, text, length));
        text += length;
        if (!*text)
            return list;
    }
}

static int add_output(batch_plan *plan, batch_job *job, const char *name, const char *format)
{
    int status = check_format(plan, job->place, format, job->by_part);
    if (status != CLI_DONE)
        return status;
    if (!batch_name_stays_below(name))
        return refuse(plan, job->place, "outputs are named by paths below the directory of -d",
                      "'%.200s' is no name for an output", name);
    cli_list_add(&plan->arena, &job->formats, cli_drawings_or_mesh_name(format));
    cli_list_add(&plan->arena, &job->names, name);
    cli_list_add(&plan->arena, &job->outputs, cli_path_join(&plan->arena, plan->directory, name));
    return CLI_DONE;
}

static int name_outputs(batch_plan *plan, batch_job *job, const batch_entry *entry)
{
    cli_arena *arena = &plan->arena;
    cli_list formats = entry->formats;
    int status = CLI_DONE;
    for (size_t i = 0; i < entry->outputs.count && status == CLI_DONE; i++) {
        const char *path = entry->outputs.items[i];
        csgm_format mesh = csgm_format_from_path(path);
        csgm_drawing_format drawing = csgm_drawing_format_from_path(path);
        if (mesh == CSGM_FORMAT_AUTO && drawing == CSGM_DRAWING_NONE) {
            char known[160];
            cli_formats_of_this_build(known, sizeof known);
            return refuse(plan, job->place, known, "the name '%.200s' tells no format",
                          entry->outputs.items[i]);
        }
        status = add_output(plan, job, path,
                            mesh != CSGM_FORMAT_AUTO ? csgm_format_name(mesh)
                                                     : csgm_drawing_format_name(drawing));
    }
    if (entry->outputs.count)
        return status;
    const char *problem = batch_name_problem(arena, job->pattern);
    if (problem)
        return refuse(plan, job->place, "placeholders: {scene} {set} {part} {folder} {ext}",
                      "the pattern '%.200s': %s", job->pattern, problem);
    if (!formats.count)
        cli_list_add(arena, &formats, "glb");
    for (size_t i = 0; i < formats.count && status == CLI_DONE; i++) {
        batch_name_parts parts = {job->scene, job->folder, job->set, NULL, formats.items[i]};
        status =
            add_output(plan, job, batch_name_expand(arena, job->pattern, &parts), formats.items[i]);
    }
    return status;
}

/* ---- jobs ----------------------------------------------------------------------------- */

/* The options as csgmesh mesh would take them; what is wrong with one is told here. */
static int parse_options(batch_plan *plan, batch_job *job)
{
    cli_problem problem;
    job->options = cli_arena_alloc(&plan->arena, sizeof *job->options);
    if (plan->arena.failed)
        return refuse(plan, "", NULL, "out of memory");
    if (!cli_options_parse(job->options, CLI_MESH, (int)job->arguments.count,
                           (char **)(uintptr_t)job->arguments.items, &problem))
        return refuse(plan, job->place, problem.hint[0] ? problem.hint : NULL, "%s",
                      problem.message);
    return CLI_DONE;
}

static cli_looked_kind kind_of(const char *path)
{
    return access(path, R_OK) == 0 ? CLI_LOOKED_FOUND : CLI_LOOKED_MISSING;
}

static int add_job(batch_plan *plan, const batch_entry *entry, const char *scene,
                   const batch_set *set, const char *parameter_file)
{
    cli_arena *arena = &plan->arena;
    batch_job *job = cli_arena_push(arena, (void **)&plan->jobs, &plan->count, sizeof *job);
    batch_settings *settings = cli_arena_alloc(arena, sizeof *settings);
    if (!job || !settings)
        return refuse(plan, "", NULL, "out of memory");
    *settings = entry->settings;
    batch_settings_overlay(arena, settings, plan->given);
    size_t folder_length = strlen(entry->folder);
    const char *folder = cli_path_folder(arena, scene);
    if (folder_length && strncmp(folder, entry->folder, folder_length) == 0)
        folder += folder_length + (folder[folder_length] == '/');
    *job = (batch_job){.place = entry->place,
                       .scene = scene,
                       .folder = folder,
                       .title = scene,
                       .settings = settings,
                       .pattern = entry->name ? entry->name : DEFAULT_NAME};
    job->by_part = !entry->outputs.count && batch_name_has_part(job->pattern);
    job->arguments = batch_settings_arguments(arena, settings);
    if (set) {
        job->set = set->name;
        job->set_digest = set->digest;
        job->parameter_file = parameter_file;
        job->title = cli_arena_printf(arena, "%s (%s)", scene, set->name);
        cli_list_add(arena, &job->arguments,
                     cli_arena_printf(arena, "--parameter-file=%s", parameter_file));
        cli_list_add(arena, &job->arguments,
                     cli_arena_printf(arena, "--parameter-set=%s", set->name));
    }
    int status = parse_options(plan, job);
    if (status == CLI_DONE)
        status = name_outputs(plan, job, entry);
    if (status == CLI_DONE) /* also where it is not run after a failure */
        cli_app_looked(plan->app, scene, kind_of(scene));
    return status;
}

/* mug.json beside mug.txt, as OpenSCAD has it. */
static const char *file_beside(cli_arena *arena, const char *scene)
{
    const char *slash = strrchr(scene, '/'), *dot = strrchr(scene, '.');
    int length = dot && (!slash || dot > slash + 1) ? (int)(dot - scene) : (int)strlen(scene);
    return cli_arena_printf(arena, "%.*s.json", length, scene);
}

static bool asks_for_all(const cli_list *patterns)
{
    return patterns->count == 1 && strcmp(patterns->items[0], "*") == 0;
}

static int add_sets(batch_plan *plan, const batch_entry *entry, const char *scene)
{
    batch_sets sets;
    batch_set *chosen;
    size_t count;
    struct stat status_of_file;
    const char *file = entry->parameter_file;
    if (!file)
        file = file_beside(&plan->arena, scene);
    cli_app_looked(plan->app, file, kind_of(file));
    if (!entry->parameter_file && asks_for_all(&entry->sets) && stat(file, &status_of_file) != 0)
        return add_job(plan, entry, scene, NULL, NULL); /* a scene without sets */
    int status = batch_sets_load(plan->app, &plan->arena, &plan->sets, file, &sets);
    if (status == CLI_DONE)
        status = batch_sets_choose(plan->app, &plan->arena, &sets, entry->place, &entry->sets,
                                   &chosen, &count);
    if (status == CLI_DONE && !count)
        return refuse(plan, entry->place, NULL, "%s has no parameter sets", file);
    for (size_t i = 0; status == CLI_DONE && i < count; i++)
        status = add_job(plan, entry, scene, &chosen[i], file);
    return status;
}

static int add_scene(batch_plan *plan, const batch_entry *entry, const char *scene)
{
    if (entry->sets.count)
        return add_sets(plan, entry, scene);
    if (entry->parameter_file && entry->parameter_file == plan->app->options->parameter_file)
        return refuse(plan, entry->place, "as -P '*'", "-P, which names sets of %s, is missing",
                      entry->parameter_file);
    return add_job(plan, entry, scene, NULL, NULL);
}

static int by_bytes(const void *a, const void *b) /* whatever the locale */
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* "parts/[a-m]*.txt", where there is no such file: those that match, by name. */
static int add_scenes(batch_plan *plan, const batch_entry *entry)
{
    glob_t found;
    struct stat file;
    const char *pattern = cli_path_join(&plan->arena, entry->folder, entry->scene);
    if (!strpbrk(pattern, "*?[") || stat(pattern, &file) == 0)
        return add_scene(plan, entry, pattern);
    cli_app_looked(plan->app, pattern, CLI_LOOKED_PATTERN);
    if (glob(pattern, GLOB_NOSORT, NULL, &found) != 0)
        return refuse(plan, entry->place, NULL, "no scene matches '%s'", pattern);
    qsort(found.gl_pathv, found.gl_pathc, sizeof *found.gl_pathv, by_bytes);
    int status = CLI_DONE;
    for (size_t i = 0; status == CLI_DONE && i < found.gl_pathc; i++)
        status = add_scene(plan, entry, cli_arena_strdup(&plan->arena, found.gl_pathv[i]));
    globfree(&found);
    return status;
}

/* ---- the whole ------------------------------------------------------------------------ */

static bool is_manifest(const char *path)
{
    size_t length = strlen(path);
    return length > 5 && strcmp(path + length - 5, ".json") == 0;
}

static int read_operands(batch_plan *plan, batch_entries *entries)
{
    const cli_list *operands = &plan->app->options->operands;
    int status = CLI_DONE;
    for (size_t i = 0; i < operands->count && status == CLI_DONE; i++) {
        const char *path = operands->items[i];
        if (strcmp(path, "-") == 0)
            return refuse(plan, "", NULL, "a batch reads its scenes from files, not from '-'");
        if (is_manifest(path)) {
            cli_app_looked(plan->app, path, kind_of(path));
            status = batch_manifest_read(plan, path, entries);
            continue;
        }
        batch_entry *entry =
            cli_arena_push(&plan->arena, (void **)&entries->items, &entries->count, sizeof *entry);
        if (entry)
            *entry = (batch_entry){.place = path, .folder = "", .scene = path};
    }
    return status;
}

/* The command line is over what a manifest says. */
static void apply_given(batch_plan *plan, batch_entry *entry)
{
    const cli_options *options = plan->app->options;
    if (options->format) {
        entry->formats = split_formats(&plan->arena, options->format);
        entry->outputs = (cli_list){0};
    }
    if (options->name) {
        entry->name = options->name;
        entry->outputs = (cli_list){0};
    }
    if (options->parameter_file)
        entry->parameter_file = options->parameter_file;
    if (options->parameter_set) {
        entry->sets = (cli_list){0};
        cli_list_add(&plan->arena, &entry->sets, options->parameter_set);
    }
}

typedef struct claim {
    const char *output;
    const batch_job *job;
} claim;

static int by_output(const void *a, const void *b)
{
    const claim *left = a, *right = b;
    int order = strcmp(left->output, right->output);
    return order ? order : left->job < right->job ? -1 : left->job > right->job;
}

static int check_collisions(batch_plan *plan)
{
    size_t count = 0, at = 0;
    for (size_t i = 0; i < plan->count; i++)
        count += plan->jobs[i].outputs.count;
    claim *claims = cli_arena_alloc(&plan->arena, (count + 1) * sizeof *claims);
    if (!claims)
        return refuse(plan, "", NULL, "out of memory");
    for (size_t i = 0; i < plan->count; i++)
        for (size_t j = 0; j < plan->jobs[i].outputs.count; j++)
            claims[at++] = (claim){plan->jobs[i].outputs.items[j], &plan->jobs[i]};
    qsort(claims, count, sizeof *claims, by_output);
    for (size_t i = 1; i < count; i++)
        if (strcmp(claims[i - 1].output, claims[i].output) == 0)
            return refuse(plan, claims[i].job->place,
                          "another --name, with {folder} or {set}, tells them apart",
                          "%s would be written twice: for %s and for %s", claims[i].output,
                          claims[i - 1].job->title, claims[i].job->title);
    return CLI_DONE;
}

/* The batch's own reports are none of its jobs' files. */
static int check_reports(batch_plan *plan)
{
    int status = CLI_DONE;
    for (size_t i = 0; i < plan->count && status == CLI_DONE; i++) {
        const batch_job *job = &plan->jobs[i];
        status = cli_sources_guard_file(plan->app, job->scene);
        if (status == CLI_DONE)
            status = cli_sources_guard_file(plan->app, job->parameter_file);
        for (size_t j = 0; j < job->outputs.count && status == CLI_DONE; j++)
            status = cli_sources_guard_written(plan->app, job->outputs.items[j]);
    }
    return status;
}

static int choose_directory(batch_plan *plan, const batch_entries *entries)
{
    plan->directory =
        plan->app->options->directory ? plan->app->options->directory : entries->directory;
    if (!plan->directory && plan->app->options->emit)
        plan->directory = ".";
    if (!plan->directory || !*plan->directory)
        return refuse(plan, "", "as csgmesh batch parts/*.txt -d out",
                      "no directory for the outputs: add -d DIR");
    return CLI_DONE;
}

int batch_plan_make(cli_app *app, batch_plan *plan)
{
    batch_entries entries = {0};
    *plan = (batch_plan){.app = app};
    plan->given = cli_arena_alloc(&plan->arena, sizeof *plan->given);
    if (!plan->given)
        return refuse(plan, "", NULL, "out of memory");
    batch_options_given(&plan->arena, app->options, plan->given);
    int status = read_operands(plan, &entries);
    if (status == CLI_DONE)
        status = choose_directory(plan, &entries);
    for (size_t i = 0; status == CLI_DONE && i < entries.count; i++) {
        apply_given(plan, &entries.items[i]);
        status = add_scenes(plan, &entries.items[i]);
    }
    if (status == CLI_DONE)
        status = check_collisions(plan);
    if (status == CLI_DONE)
        status = check_reports(plan);
    if (status == CLI_DONE && plan->arena.failed)
        status = refuse(plan, "", NULL, "out of memory");
    return status;
}

void batch_plan_release(batch_plan *plan)
{
    for (size_t i = 0; i < plan->count; i++)
        if (plan->jobs[i].options)
            cli_options_release(plan->jobs[i].options);
    cli_arena_reset(&plan->arena);
}
