/* SPDX-License-Identifier: MIT
 * JSON -> entries; see batch_manifest.h. A member that is not known is an error: it is a slip of
 * the pen more often than not.
 */
#include "batch/batch_manifest.h"

#include <stdio.h>
#include <string.h>

typedef struct reader {
    batch_plan *plan;
    const char *place;
    batch_entry *entry;
} reader;

__attribute__((format(printf, 3, 4))) static int refuse(const reader *r, const char *hint,
                                                        const char *format, ...)
{
    char message[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    cli_console_say(&r->plan->app->console, CSGM_ERROR, hint, "%s: %s", r->place, message);
    return CLI_INPUT_AT_FAULT;
}

static int take_text(const reader *r, const cli_value *value, const char **out)
{
    if (value->kind != CSGM_JSON_STRING || !*value->text)
        return refuse(r, NULL, "\"%s\" wants a text in quotes", value->key);
    *out = value->text;
    return CLI_DONE;
}

/* "glb" or ["glb", "stl"]. */
static int take_list(const reader *r, const cli_value *value, cli_list *out)
{
    *out = (cli_list){0};
    bool is_list = value->kind == CSGM_JSON_ARRAY;
    for (const cli_value *v = is_list ? value->first : value; v; v = is_list ? v->next : NULL) {
        if (v->kind != CSGM_JSON_STRING || !*v->text)
            return refuse(r, NULL, "\"%s\" wants a text in quotes, or a list of them", value->key);
        cli_list_add(&r->plan->arena, out, v->text);
    }
    return out->count ? CLI_DONE : refuse(r, NULL, "\"%s\" is empty", value->key);
}

static int take_defines(const reader *r, const cli_value *value)
{
    cli_arena *arena = &r->plan->arena;
    if (value->kind != CSGM_JSON_OBJECT)
        return refuse(r, NULL, "\"defines\" wants an object, as {\"radius\": 5}");
    for (const cli_value *v = value->first; v; v = v->next) {
        const char *text = batch_expression(arena, v);
        if (!text || !*v->key || strchr(v->key, '='))
            return refuse(r, "a number, true, false, a text, or a list of these",
                          "\"defines\": \"%.60s\" has no value that a scene could take", v->key);
        cli_list_add(arena, &r->entry->settings.defines,
                     cli_arena_printf(arena, "%s=%s", v->key, text));
    }
    return CLI_DONE;
}

static int take_metadata(const reader *r, const cli_value *value)
{
    cli_arena *arena = &r->plan->arena;
    if (value->kind != CSGM_JSON_OBJECT || !value->first)
        return refuse(r, NULL, "\"meta\" wants an object, as {\"title\": \"Mug\"}");
    for (const cli_value *v = value->first; v; v = v->next) {
        bool text = v->kind == CSGM_JSON_STRING || v->kind == CSGM_JSON_NUMBER;
        if (!text || !*v->text || !*v->key || strchr(v->key, '='))
            return refuse(r, "a text or a number", "\"meta\": \"%.60s\" has no value", v->key);
        cli_list_add(arena, &r->entry->settings.meta,
                     cli_arena_printf(arena, "%s=%s", v->key, v->text));
    }
    return CLI_DONE;
}

static int take_includes(const reader *r, const cli_value *value)
{
    cli_list folders;
    int status = take_list(r, value, &folders);
    for (size_t i = 0; status == CLI_DONE && i < folders.count; i++)
        cli_list_add(&r->plan->arena, &r->entry->settings.include_dirs,
                     cli_path_join(&r->plan->arena, r->entry->folder, folders.items[i]));
    return status;
}

static int refuse_unknown(const reader *r, const char *key)
{
    static const char *const own[] = {"scene",   "jobs",           "directory", "formats", "name",
                                      "sets",    "parameter_file", "defines",   "include", "out",
                                      "$schema", "meta",           NULL};
    char hint[120];
    const char *near = cli_nearest(key, own);
    if (!near)
        near = cli_nearest(key, batch_option_names());
    if (near)
        snprintf(hint, sizeof hint, "did you mean \"%s\"?", near);
    return refuse(r, near ? hint : "see share/batch.schema.json", "there is no \"%.60s\"", key);
}

static int take_option(const reader *r, const cli_value *value)
{
    const char *wanted;
    cli_option_id id = batch_option_find(value->key);
    if (id == CLI_OPTION_COUNT)
        return refuse_unknown(r, value->key);
    if (!batch_option_set(&r->plan->arena, &r->entry->settings, id, value, &wanted))
        return refuse(r, NULL, "\"%s\" wants %s", value->key, wanted);
    return CLI_DONE;
}

/* What stands at the top and in a job alike. */
static int take_member(const reader *r, const cli_value *v)
{
    batch_entry *entry = r->entry;
    if (strcmp(v->key, "formats") == 0)
        return take_list(r, v, &entry->formats);
    if (strcmp(v->key, "sets") == 0)
        return take_list(r, v, &entry->sets);
    if (strcmp(v->key, "name") == 0)
        return take_text(r, v, &entry->name);
    if (strcmp(v->key, "defines") == 0)
        return take_defines(r, v);
    if (strcmp(v->key, "meta") == 0)
        return take_metadata(r, v);
    if (strcmp(v->key, "include") == 0)
        return take_includes(r, v);
    if (strcmp(v->key, "parameter_file") == 0) {
        int status = take_text(r, v, &entry->parameter_file);
        if (status == CLI_DONE)
            entry->parameter_file =
                cli_path_join(&r->plan->arena, entry->folder, entry->parameter_file);
        return status;
    }
    return take_option(r, v);
}

static int read_members(reader *r, const cli_value *job)
{
    batch_entry *entry = r->entry;
    int status = CLI_DONE;
    if (job->kind == CSGM_JSON_STRING)
        entry->scene = job->text;
    else if (job->kind != CSGM_JSON_OBJECT)
        return refuse(r, "as \"mug.txt\" or {\"scene\": \"mug.txt\"}", "this is no job");
    for (const cli_value *v = job->first; v && status == CLI_DONE; v = v->next)
        status = strcmp(v->key, "scene") == 0 ? take_text(r, v, &entry->scene)
                 : strcmp(v->key, "out") == 0 ? take_list(r, v, &entry->outputs)
                                              : take_member(r, v);
    if (status == CLI_DONE && (!entry->scene || !*entry->scene))
        status = refuse(r, "add \"scene\": \"mug.txt\"", "the job names no scene");
    if (status == CLI_DONE && entry->outputs.count && cli_value_member(job, "name"))
        status = refuse(r, NULL, "\"out\" and \"name\" both name the outputs: give one");
    return status;
}

static int read_job(batch_plan *plan, const char *place, const cli_value *job,
                    const batch_entry *defaults, batch_entries *entries)
{
    batch_entry entry = *defaults;
    reader r = {plan, place, &entry};
    entry.place = place;
    entry.settings = (batch_settings){0};
    int status = read_members(&r, job);
    batch_settings own = entry.settings;
    entry.settings = defaults->settings;
    batch_settings_overlay(&plan->arena, &entry.settings, &own);
    batch_entry *place_of =
        cli_arena_push(&plan->arena, (void **)&entries->items, &entries->count, sizeof entry);
    if (place_of)
        *place_of = entry;
    return status;
}

/* What stands beside "jobs". */
static int read_defaults(reader *r, const cli_value *root, const cli_value **jobs,
                         const char **directory)
{
    int status = CLI_DONE;
    for (const cli_value *v = root->first; v && status == CLI_DONE; v = v->next) {
        if (strcmp(v->key, "jobs") == 0)
            *jobs = v;
        else if (strcmp(v->key, "directory") == 0)
            status = take_text(r, v, directory);
        else if (strcmp(v->key, "$schema") != 0)
            status = take_member(r, v);
    }
    if (status == CLI_DONE && *directory)
        *directory = cli_path_join(&r->plan->arena, r->entry->folder, *directory);
    return status;
}

int batch_manifest_read(batch_plan *plan, const char *path, batch_entries *entries)
{
    cli_arena *arena = &plan->arena;
    cli_value *root;
    batch_entry defaults = {.folder = cli_path_folder(arena, path)};
    reader r = {plan, path, &defaults};
    int status = cli_value_load(plan->app, arena, path, &root);
    if (status != CLI_DONE)
        return status;
    const cli_value *jobs = root->kind == CSGM_JSON_ARRAY ? root : NULL;
    if (root->kind == CSGM_JSON_OBJECT)
        status = read_defaults(&r, root, &jobs, &entries->directory);
    if (status != CLI_DONE)
        return status;
    if (!jobs || jobs->kind != CSGM_JSON_ARRAY || !jobs->first)
        return refuse(&r, "as {\"jobs\": [\"mug.txt\", {\"scene\": \"knob.txt\"}]}",
                      "the manifest lists no jobs");
    size_t index = 0;
    for (const cli_value *v = jobs->first; v && status == CLI_DONE; v = v->next)
        status = read_job(plan, cli_arena_printf(arena, "%s: jobs[%zu]", path, index++), v,
                          &defaults, entries);
    return status;
}
