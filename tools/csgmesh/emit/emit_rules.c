/* SPDX-License-Identifier: MIT
 * Jobs -> rules, the same for all build systems; see emit.h.
 */
#include <string.h>

#include "batch/batch_names.h"
#include "batch/batch_record.h"
#include "core/options.h"
#include "emit/emit.h"

static void add_word(batch_plan *plan, emit_rule *rule, emit_word word)
{
    emit_word *place =
        cli_arena_push(&plan->arena, (void **)&rule->words, &rule->word_count, sizeof word);
    if (place)
        *place = word;
}

static void add_text(batch_plan *plan, emit_rule *rule, const char *text)
{
    add_word(plan, rule, (emit_word){.kind = EMIT_TEXT, .prefix = text});
}

/* Options whose values are paths are told apart: build systems run elsewhere. */
static void add_arguments(batch_plan *plan, emit_rule *rule)
{
    static const char *const paths[] = {"--include=", "--parameter-file="};
    const cli_list *arguments = &rule->job->arguments;
    for (size_t i = 0; i < arguments->count; i++) {
        emit_word word = {.kind = EMIT_TEXT, .prefix = arguments->items[i]};
        for (size_t j = 0; j < 2; j++)
            if (strncmp(word.prefix, paths[j], strlen(paths[j])) == 0)
                word = (emit_word){.kind = EMIT_SOURCE,
                                   .prefix = paths[j],
                                   .path = arguments->items[i] + strlen(paths[j])};
        add_word(plan, rule, word);
    }
}

/* What a rule may read and write is what this run may; CSGMESH_ROOT stays with the environment. */
static void add_roots(batch_plan *plan, emit_rule *rule)
{
    const cli_list *roots = &plan->app->options->roots;
    for (size_t i = 0; i < roots->count; i++)
        add_word(plan, rule,
                 (emit_word){.kind = EMIT_SOURCE, .prefix = "--root=", .path = roots->items[i]});
    if (plan->app->options->sandbox)
        add_text(plan, rule, "--sandbox");
}

static void add_mesh_words(batch_plan *plan, emit_rule *rule)
{
    add_word(plan, rule, (emit_word){.kind = EMIT_INPUT});
    for (size_t i = 0; i < rule->outputs.count; i++) {
        add_text(plan, rule, "-o");
        add_word(plan, rule, (emit_word){.kind = EMIT_OUTPUT, .index = i});
    }
    add_arguments(plan, rule);
    add_roots(plan, rule);
    add_text(plan, rule, "-M");
    add_word(plan, rule, (emit_word){.kind = EMIT_DEPFILE});
}

/* What is known of the name now stands in the pattern. */
static void add_batch_words(batch_plan *plan, emit_rule *rule)
{
    cli_arena *arena = &plan->arena;
    const batch_job *job = rule->job;
    batch_name_parts known = {job->scene, job->folder, job->set, "{part}", "{ext}"};
    const char *formats = "--format=";
    for (size_t i = 0; i < job->formats.count; i++)
        formats = cli_arena_printf(arena, "%s%s%s", formats, i ? "," : "", job->formats.items[i]);
    add_text(plan, rule, "batch");
    add_word(plan, rule, (emit_word){.kind = EMIT_INPUT});
    add_text(plan, rule, "-d");
    add_word(plan, rule, (emit_word){.kind = EMIT_DIRECTORY});
    add_text(plan, rule,
             cli_arena_printf(arena, "--name=%s", batch_name_expand(arena, job->pattern, &known)));
    add_text(plan, rule, formats);
    add_arguments(plan, rule);
    add_roots(plan, rule);
    add_text(plan, rule, "--depfiles");
    add_text(plan, rule, "--quiet");
}

static void add_output(batch_plan *plan, emit_rule *rule, const char *format, const char *part)
{
    cli_arena *arena = &plan->arena;
    const char *path = batch_output_path(arena, rule->job, plan->directory, format, part);
    size_t skipped = strcmp(plan->directory, ".") == 0 ? 0 : strlen(plan->directory) + 1;
    cli_list_add(arena, &rule->outputs, path);
    cli_list_add(arena, &rule->names, strlen(path) > skipped ? path + skipped : path);
}

/* The scene is evaluated to see its parts. */
static int find_parts(batch_plan *plan, emit_rule *rule)
{
    const batch_job *job = rule->job;
    cli_app app = *plan->app;
    csgm_scene *scene = NULL;
    csgm_field *field = NULL;
    const char *name;
    app.options = job->options;
    csgm_status status = cli_app_load(&app, job->scene, &scene);
    if (status == CSGM_OK)
        status = csgm_field_compile(app.context, scene, &field);
    for (size_t i = 0; status == CSGM_OK && csgm_field_part(field, i, &name); i++)
        for (size_t j = 0; j < job->formats.count; j++)
            add_output(plan, rule, job->formats.items[j],
                       name ? cli_arena_strdup(&plan->arena, name) : NULL);
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    return cli_exit_status(status);
}

static int make_rule(batch_plan *plan, const batch_job *job, emit_rule *rule)
{
    *rule = (emit_rule){.job = job, .names = job->names, .outputs = job->outputs};
    int status = CLI_DONE;
    if (job->by_part) {
        rule->names = rule->outputs = (cli_list){0};
        status = find_parts(plan, rule);
    }
    if (status != CLI_DONE || !rule->outputs.count)
        return status;
    rule->depfile = cli_arena_printf(&plan->arena, "%s.d", rule->outputs.items[0]);
    if (job->by_part)
        add_batch_words(plan, rule);
    else
        add_mesh_words(plan, rule);
    return CLI_DONE;
}

static bool has_line_break(const emit_rule *rule)
{
    for (size_t i = 0; i < rule->outputs.count; i++)
        if (strpbrk(rule->outputs.items[i], "\n\r"))
            return true;
    for (size_t i = 0; i < rule->word_count; i++)
        if ((rule->words[i].prefix && strpbrk(rule->words[i].prefix, "\n\r")) ||
            (rule->words[i].path && strpbrk(rule->words[i].path, "\n\r")))
            return true;
    return strpbrk(rule->job->scene, "\n\r") != NULL;
}

int emit_plan(batch_plan *plan)
{
    static int (*const writers[])(const emit_rules *) = {NULL, emit_ninja, emit_make, emit_meson,
                                                         emit_cmake};
    emit_rules rules = {.plan = plan};
    rules.items = cli_arena_alloc(&plan->arena, (plan->count + 1) * sizeof *rules.items);
    int status = CLI_DONE;
    for (size_t i = 0; rules.items && i < plan->count && status == CLI_DONE; i++) {
        emit_rule *rule = &rules.items[rules.count++];
        status = make_rule(plan, &plan->jobs[i], rule);
        if (status == CLI_DONE && has_line_break(rule))
            return cli_usage_error(plan->app, "make it with csgmesh batch itself",
                                   "%s: no build system takes line breaks in names and options",
                                   plan->jobs[i].place);
    }
    if (plan->arena.failed)
        return cli_usage_error(plan->app, NULL, "out of memory");
    if (status == CLI_DONE)
        status = writers[plan->app->options->emit](&rules);
    return cli_finish_stdout(plan->app, status);
}

/* ---- words ---------------------------------------------------------------------------- */

const char *emit_shell_quoted(cli_arena *arena, const char *text)
{
    static const char bare[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                               "_-./=,:+@%";
    if (*text && strspn(text, bare) == strlen(text))
        return text;
    const char *quoted = "'";
    for (;;) {
        size_t length = strcspn(text, "'");
        quoted = cli_arena_printf(arena, "%s%.*s%s", quoted, (int)length, text,
                                  text[length] ? "'\\''" : "'");
        if (!text[length])
            return quoted;
        text += length + 1;
    }
}

const char *emit_word_text(cli_arena *arena, const emit_rule *rule, const emit_word *word,
                           const char *directory)
{
    switch (word->kind) {
    case EMIT_TEXT:
        return word->prefix;
    case EMIT_INPUT:
        return rule->job->scene;
    case EMIT_OUTPUT:
        return rule->outputs.items[word->index];
    case EMIT_DIRECTORY:
        return directory;
    case EMIT_DEPFILE:
        return rule->depfile;
    case EMIT_SOURCE:
        return cli_arena_printf(arena, "%s%s", word->prefix, word->path);
    }
    return "";
}

const char *emit_command(cli_arena *arena, const emit_rules *rules, const emit_rule *rule)
{
    const char *command = "";
    for (size_t i = 0; i < rule->word_count; i++)
        command =
            cli_arena_printf(arena, "%s%s%s", command, i ? " " : "",
                             emit_shell_quoted(arena, emit_word_text(arena, rule, &rule->words[i],
                                                                     rules->plan->directory)));
    return command;
}
