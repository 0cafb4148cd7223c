/* SPDX-License-Identifier: MIT
 * --emit cmake: a custom command a job, and the target "meshes" of all of them. Scenes are found in
 * the source tree, outputs go to the build tree.
 */
#include <string.h>

#include "emit/emit.h"

static void put_escaped(const char *text)
{
    for (; *text; text++) {
        if (strchr("\"\\$;", *text))
            putchar('\\');
        putchar(*text);
    }
}

/* "${CMAKE_CURRENT_SOURCE_DIR}/parts/mug.txt", after a prefix. */
static void put_path(const char *tree, const char *prefix, const char *path)
{
    putchar('"');
    put_escaped(prefix);
    if (path[0] != '/')
        printf("${CMAKE_CURRENT_%s_DIR}/", tree);
    put_escaped(path);
    putchar('"');
}

static void put_word(const emit_rules *rules, const emit_rule *rule, const emit_word *word)
{
    switch (word->kind) {
    case EMIT_TEXT:
        putchar('"');
        put_escaped(word->prefix);
        putchar('"');
        break;
    case EMIT_INPUT:
        put_path("SOURCE", "", rule->job->scene);
        break;
    case EMIT_OUTPUT:
        put_path("BINARY", "", rule->outputs.items[word->index]);
        break;
    case EMIT_DIRECTORY:
        put_path("BINARY", "", rules->plan->directory);
        break;
    case EMIT_DEPFILE:
        put_path("BINARY", "", rule->depfile);
        break;
    case EMIT_SOURCE:
        put_path("SOURCE", word->prefix, word->path);
    }
}

static void put_outputs(const emit_rule *rule)
{
    for (size_t i = 0; i < rule->outputs.count; i++) {
        fputs("\n    ", stdout);
        put_path("BINARY", "", rule->outputs.items[i]);
    }
}

/* A batch leaves outputs that are up to date alone; Make goes by times only. */
static void put_touch(const emit_rule *rule)
{
    fputs("\n  COMMAND \"${CMAKE_COMMAND}\" -E touch", stdout);
    put_outputs(rule);
}

static void put_rule(const emit_rules *rules, const emit_rule *rule)
{
    fputs("\nadd_custom_command(\n  OUTPUT", stdout);
    put_outputs(rule);
    fputs("\n  COMMAND \"${CMAKE_COMMAND}\" -E make_directory ", stdout);
    put_path("BINARY", "", cli_path_folder(&rules->plan->arena, rule->outputs.items[0]));
    fputs("\n  COMMAND \"${CSGMESH}\" -j 1", stdout);
    for (size_t i = 0; i < rule->word_count; i++) {
        putchar(' ');
        put_word(rules, rule, &rule->words[i]);
    }
    if (rule->job->by_part)
        put_touch(rule);
    fputs("\n  DEPENDS ", stdout);
    put_path("SOURCE", "", rule->job->scene);
    fputs("\n  DEPFILE ", stdout);
    put_path("BINARY", "", rule->depfile);
    fputs("\n  COMMENT \"Meshing ", stdout);
    put_escaped(rule->job->title);
    fputs("\"\n  VERBATIM)\n", stdout);
}

int emit_cmake(const emit_rules *rules)
{
    for (size_t i = 0; i < rules->count; i++)
        for (size_t j = 0; j < rules->items[i].outputs.count; j++)
            if (strchr(rules->items[i].outputs.items[j], '$')) /* it would remake these always */
                return cli_usage_error(rules->plan->app, "give it another --name",
                                       "CMake takes no '$' in what depends on files: '%s'",
                                       rules->items[i].outputs.items[j]);
    fputs("# Made by csgmesh batch --emit cmake; CMake 3.21 or later.\n"
          "find_program(CSGMESH csgmesh REQUIRED)\n",
          stdout);
    for (size_t i = 0; i < rules->count; i++)
        if (rules->items[i].outputs.count)
            put_rule(rules, &rules->items[i]);
    fputs("\nadd_custom_target(meshes ALL DEPENDS", stdout);
    for (size_t i = 0; i < rules->count; i++)
        put_outputs(&rules->items[i]);
    fputs(")\n", stdout);
    return CLI_DONE;
}
