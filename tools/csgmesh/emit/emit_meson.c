/* SPDX-License-Identifier: MIT
 * --emit meson: a custom_target a job, for a meson.build. Meson puts outputs into the folder of
 * that file in the build tree, so their names can have no folders of their own.
 */
#include <string.h>

#include "emit/emit.h"

static void put_string(const char *text)
{
    putchar('\'');
    for (; *text; text++) {
        if (*text == '\'' || *text == '\\')
            putchar('\\');
        putchar(*text);
    }
    putchar('\'');
}

static void put_word(const emit_word *word)
{
    switch (word->kind) {
    case EMIT_TEXT:
        put_string(word->prefix);
        break;
    case EMIT_INPUT:
        fputs("'@INPUT@'", stdout);
        break;
    case EMIT_OUTPUT:
        printf("'@OUTPUT%zu@'", word->index);
        break;
    case EMIT_DIRECTORY:
        fputs("'@OUTDIR@'", stdout);
        break;
    case EMIT_DEPFILE:
        fputs("'@DEPFILE@'", stdout);
        break;
    case EMIT_SOURCE: /* an absolute path stays one */
        put_string(word->prefix);
        fputs(" + (meson.current_source_dir() / ", stdout);
        put_string(word->path);
        putchar(')');
    }
}

static void put_rule(const emit_rules *rules, const emit_rule *rule)
{
    fputs("\ncustom_target(", stdout);
    put_string(rule->names.items[0]);
    fputs(",\n  input: ", stdout);
    put_string(rule->job->scene);
    fputs(",\n  output: [", stdout);
    for (size_t i = 0; i < rule->names.count; i++) {
        fputs(i ? ", " : "", stdout);
        put_string(rule->names.items[i]);
    }
    fputs("],\n  depfile: ", stdout);
    put_string(cli_arena_printf(&rules->plan->arena, "%s.d", rule->names.items[0]));
    fputs(",\n  command: [csgmesh, '-j', '1'", stdout);
    for (size_t i = 0; i < rule->word_count; i++) {
        fputs(", ", stdout);
        put_word(&rule->words[i]);
    }
    fputs("],\n  build_by_default: true)\n", stdout);
}

int emit_meson(const emit_rules *rules)
{
    for (size_t i = 0; i < rules->count; i++)
        for (size_t j = 0; j < rules->items[i].names.count; j++)
            if (strchr(rules->items[i].names.items[j], '/'))
                return cli_usage_error(rules->plan->app, "as --name '{scene}-{set}.{ext}'",
                                       "Meson has no folders below its own: '%s'",
                                       rules->items[i].names.items[j]);
    fputs("# Made by csgmesh batch --emit meson.\ncsgmesh = find_program('csgmesh')\n", stdout);
    for (size_t i = 0; i < rules->count; i++)
        if (rules->items[i].outputs.count)
            put_rule(rules, &rules->items[i]);
    return CLI_DONE;
}
