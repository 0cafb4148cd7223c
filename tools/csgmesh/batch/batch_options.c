/* SPDX-License-Identifier: MIT
 * Options of jobs; see batch_options.h.
 */
#include "batch/batch_options.h"

#include <stdio.h>
#include <string.h>

#include "core/command_bits.h"
#include "core/options.h"

typedef struct row {
    const char *name, *kind;
    int commands;
    cli_option_id id;
    char letter;
} row;

static const row rows[] = {
#define SECTION(title)
#define OPTION(field, letter, name, kind, argument, commands, help)                                \
    {name, #kind, commands, CLI_OPTION_##field, letter},
#include "core/options.def"
#undef SECTION
#undef OPTION
};

enum { ROWS = sizeof rows / sizeof *rows };

/* What concerns the batch as a whole, or has a form of its own in a manifest. */
static bool is_of_batch(cli_option_id id)
{
    static const cli_option_id ids[] = {
        CLI_OPTION_format,      CLI_OPTION_parameter_file, CLI_OPTION_parameter_set,
        CLI_OPTION_quiet,       CLI_OPTION_progress,       CLI_OPTION_color,
        CLI_OPTION_diagnostics, CLI_OPTION_threads,        CLI_OPTION_roots,
        CLI_OPTION_help,        CLI_OPTION_version,        CLI_OPTION_json,
        CLI_OPTION_defines,     CLI_OPTION_include_dirs,   CLI_OPTION_trace,
        CLI_OPTION_meta,        CLI_OPTION_sandbox,        CLI_OPTION_watch,
    };
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++)
        if (ids[i] == id)
            return true;
    return false;
}

static bool is_of_job(const row *option)
{
    int both = MESH | BATCH;
    return (option->commands & both) == both && !is_of_batch(option->id);
}

/* The bytes are the same whatever these say. */
static bool is_without_effect(cli_option_id id)
{
    return id == CLI_OPTION_no_sync || id == CLI_OPTION_no_prune || id == CLI_OPTION_max_memory ||
           id == CLI_OPTION_max_depth || id == CLI_OPTION_max_nodes || id == CLI_OPTION_max_steps ||
           id == CLI_OPTION_timeout;
}

static bool same_key(const char *key, const char *name)
{
    for (; *key && (*key == *name || (*key == '_' && *name == '-')); key++)
        name++;
    return *key == '\0' && *name == '\0';
}

cli_option_id batch_option_find(const char *key)
{
    for (size_t i = 0; i < ROWS; i++)
        if (is_of_job(&rows[i]) && rows[i].name && same_key(key, rows[i].name))
            return rows[i].id;
    return CLI_OPTION_COUNT;
}

const char *const *batch_option_names(void)
{
    static const char *names[ROWS + 1];
    size_t count = 0;
    for (size_t i = 0; i < ROWS; i++)
        if (is_of_job(&rows[i]) && rows[i].name)
            names[count++] = rows[i].name;
    return names;
}

static const row *row_of(cli_option_id id)
{
    for (size_t i = 0; i < ROWS; i++)
        if (rows[i].id == id)
            return &rows[i];
    return NULL;
}

/* ---- values of a manifest ------------------------------------------------------------- */

static const char *quoted(cli_arena *arena, const char *text)
{
    char *out = cli_arena_alloc(arena, 2 * strlen(text) + 3);
    size_t length = 0;
    if (!out)
        return "";
    out[length++] = '"';
    for (; *text; text++) {
        char escaped = *text == '"' || *text == '\\' ? *text
                       : *text == '\n'               ? 'n'
                       : *text == '\t'               ? 't'
                       : *text == '\r'               ? 'r'
                                                     : 0;
        if (escaped)
            out[length++] = '\\';
        out[length++] = escaped ? escaped : *text;
    }
    out[length] = '"';
    return out;
}

const char *batch_expression(cli_arena *arena, const cli_value *value)
{
    if (value->kind == CSGM_JSON_OBJECT)
        return NULL;
    if (value->kind == CSGM_JSON_STRING)
        return quoted(arena, value->text);
    if (value->kind != CSGM_JSON_ARRAY)
        return strcmp(value->text, "null") == 0 ? "undef" : value->text;
    const char *list = "[";
    for (const cli_value *v = value->first; v; v = v->next) {
        const char *element = batch_expression(arena, v);
        if (!element)
            return NULL;
        list = cli_arena_printf(arena, "%s%s%s", list, element, v->next ? ", " : "");
    }
    return cli_arena_printf(arena, "%s]", list);
}

/* [1, 2, 3] -> "1,2,3"; NULL: it holds more than numbers and strings. */
static const char *joined(cli_arena *arena, const cli_value *array)
{
    const char *list = "";
    for (const cli_value *v = array->first; v; v = v->next) {
        if (v->kind != CSGM_JSON_NUMBER && v->kind != CSGM_JSON_STRING)
            return NULL;
        list = cli_arena_printf(arena, "%s%s%s", list, v->text, v->next ? "," : "");
    }
    return list;
}

bool batch_option_set(cli_arena *arena, batch_settings *settings, cli_option_id id,
                      const cli_value *value, const char **wanted)
{
    const row *option = row_of(id);
    const char **slot = &settings->arguments[id];
    if (strcmp(option->kind, "FLAG") == 0) {
        bool truth = value->kind == CSGM_JSON_WORD && strcmp(value->text, "true") == 0;
        *wanted = "true or false";
        *slot = truth ? cli_arena_printf(arena, "--%s", option->name) : "";
        return truth || (value->kind == CSGM_JSON_WORD && strcmp(value->text, "false") == 0);
    }
    const char *text = value->kind == CSGM_JSON_ARRAY ? joined(arena, value)
                       : value->kind == CSGM_JSON_STRING || value->kind == CSGM_JSON_NUMBER
                           ? value->text
                           : NULL;
    *wanted = "a number or a string, or a list of them";
    if (text)
        *slot = cli_arena_printf(arena, "--%s=%s", option->name, text);
    return text != NULL;
}

/* ---- the command line ----------------------------------------------------------------- */

void batch_options_given(cli_arena *arena, const cli_options *options, batch_settings *out)
{
    for (size_t i = 0; i < ROWS; i++) {
        const row *option = &rows[i];
        const char *value = options->texts[option->id];
        if (!is_of_job(option) || !options->given[option->id])
            continue;
        if (!option->name)
            out->arguments[option->id] = cli_arena_printf(arena, "-%c%s", option->letter, value);
        else
            out->arguments[option->id] = cli_arena_printf(arena, "--%s%s%s", option->name,
                                                          value ? "=" : "", value ? value : "");
    }
    out->defines = options->defines;
    out->include_dirs = options->include_dirs;
    out->meta = options->meta;
}

/* ---- layers --------------------------------------------------------------------------- */

/* Each of these says how fine the mesh is: the last one said holds. */
static bool is_fineness(const row *option)
{
    return option->name &&
           (strcmp(option->name, "resolution") == 0 || strcmp(option->name, "cell-size") == 0 ||
            strcmp(option->name, "tolerance") == 0 || strcmp(option->name, "quality") == 0 ||
            strcmp(option->name, "triangles") == 0);
}

static size_t name_length(const char *define)
{
    return strcspn(define, "=");
}

/* A later definition of the same name replaces the earlier one; so does a later KEY=VALUE. */
static void add_define(cli_arena *arena, cli_list *defines, const char *define)
{
    size_t length = name_length(define);
    for (size_t i = 0; i < defines->count; i++)
        if (name_length(defines->items[i]) == length &&
            strncmp(defines->items[i], define, length) == 0) {
            defines->items[i] = define;
            return;
        }
    cli_list_add(arena, defines, define);
}

void batch_settings_overlay(cli_arena *arena, batch_settings *settings, const batch_settings *over)
{
    bool fineness = false;
    cli_list defines = settings->defines, include_dirs = settings->include_dirs;
    cli_list meta = settings->meta;
    for (size_t i = 0; i < ROWS; i++)
        fineness = fineness || (is_fineness(&rows[i]) && over->arguments[rows[i].id]);
    for (size_t i = 0; i < ROWS; i++) {
        const char *argument = over->arguments[rows[i].id];
        if (argument || (fineness && is_fineness(&rows[i])))
            settings->arguments[rows[i].id] = argument;
    }
    /* the layers keep their own */
    settings->defines = settings->include_dirs = settings->meta = (cli_list){0};
    for (size_t i = 0; i < defines.count; i++)
        add_define(arena, &settings->defines, defines.items[i]);
    for (size_t i = 0; i < over->defines.count; i++)
        add_define(arena, &settings->defines, over->defines.items[i]);
    for (size_t i = 0; i < meta.count; i++)
        add_define(arena, &settings->meta, meta.items[i]);
    for (size_t i = 0; i < over->meta.count; i++)
        add_define(arena, &settings->meta, over->meta.items[i]);
    for (size_t i = 0; i < over->include_dirs.count; i++) /* searched first */
        cli_list_add(arena, &settings->include_dirs, over->include_dirs.items[i]);
    for (size_t i = 0; i < include_dirs.count; i++)
        cli_list_add(arena, &settings->include_dirs, include_dirs.items[i]);
}

cli_list batch_settings_arguments(cli_arena *arena, const batch_settings *settings)
{
    cli_list list = {0};
    for (size_t i = 0; i < ROWS; i++) {
        const char *argument = settings->arguments[rows[i].id];
        if (argument && *argument)
            cli_list_add(arena, &list, argument);
    }
    for (size_t i = 0; i < settings->defines.count; i++)
        cli_list_add(arena, &list,
                     cli_arena_printf(arena, "--define=%s", settings->defines.items[i]));
    for (size_t i = 0; i < settings->include_dirs.count; i++)
        cli_list_add(arena, &list,
                     cli_arena_printf(arena, "--include=%s", settings->include_dirs.items[i]));
    for (size_t i = 0; i < settings->meta.count; i++)
        cli_list_add(arena, &list, cli_arena_printf(arena, "--meta=%s", settings->meta.items[i]));
    return list;
}

void batch_settings_visit(const batch_settings *settings,
                          void (*take)(void *user, const char *text), void *user)
{
    for (size_t i = 0; i < ROWS; i++) {
        const char *argument = settings->arguments[rows[i].id];
        if (argument && *argument && !is_without_effect(rows[i].id))
            take(user, argument);
    }
    for (size_t i = 0; i < settings->defines.count; i++)
        take(user, settings->defines.items[i]);
    for (size_t i = 0; i < settings->meta.count; i++)
        take(user, settings->meta.items[i]);
}

static void hash_text(void *hasher, const char *text)
{
    batch_hash_text(hasher, text);
}

void batch_settings_hash(const batch_settings *settings, batch_hasher *hasher)
{
    batch_settings_visit(settings, hash_text, hasher);
}
