/* SPDX-License-Identifier: MIT
 * --emit make: rules for GNU Make 4.3 or later (several files made by one command), and the
 * dependency files that they write.
 */
#include <string.h>

#include "emit/emit.h"

/* A name among targets or prerequisites. */
static void put_name(const char *name)
{
    for (; *name; name++) {
        if (strchr(" \t#:%\\", *name))
            putchar('\\');
        if (*name == '$')
            putchar('$');
        putchar(*name);
    }
}

/* A line of a recipe, with the shell's quotes. */
static void put_command(const char *text)
{
    for (; *text; text++) {
        if (*text == '$')
            putchar('$');
        putchar(*text);
    }
}

/* A batch leaves outputs that are up to date alone; Make goes by times only. */
static void put_touch(cli_arena *arena, const emit_rule *rule)
{
    fputs("\t@touch", stdout);
    for (size_t i = 0; i < rule->outputs.count; i++) {
        putchar(' ');
        put_command(emit_shell_quoted(arena, rule->outputs.items[i]));
    }
    putchar('\n');
}

static void put_rule(const emit_rules *rules, const emit_rule *rule)
{
    cli_arena *arena = &rules->plan->arena;
    const char *folder = cli_path_folder(arena, rule->outputs.items[0]);
    putchar('\n');
    for (size_t i = 0; i < rule->outputs.count; i++) {
        put_name(rule->outputs.items[i]);
        if (i + 1 < rule->outputs.count)
            putchar(' ');
    }
    fputs(rule->outputs.count > 1 ? " &: " : ": ", stdout);
    put_name(rule->job->scene);
    putchar('\n');
    if (*folder) {
        fputs("\t@mkdir -p ", stdout);
        put_command(emit_shell_quoted(arena, folder));
        putchar('\n');
    }
    fputs("\t$(CSGMESH) -j $(CSGMESH_THREADS) ", stdout);
    put_command(emit_command(arena, rules, rule));
    putchar('\n');
    if (rule->job->by_part)
        put_touch(arena, rule);
    fputs("-include ", stdout);
    put_name(rule->depfile);
    putchar('\n');
}

int emit_make(const emit_rules *rules)
{
    fputs("# Made by csgmesh batch --emit make. Each csgmesh takes one thread: make -j runs many.\n"
          "CSGMESH ?= csgmesh\nCSGMESH_THREADS ?= 1\n\n.PHONY: meshes\nmeshes:",
          stdout);
    for (size_t i = 0; i < rules->count; i++)
        for (size_t j = 0; j < rules->items[i].outputs.count; j++) {
            fputs(" \\\n  ", stdout);
            put_name(rules->items[i].outputs.items[j]);
        }
    putchar('\n');
    for (size_t i = 0; i < rules->count; i++)
        if (rules->items[i].outputs.count)
            put_rule(rules, &rules->items[i]);
    return CLI_DONE;
}
