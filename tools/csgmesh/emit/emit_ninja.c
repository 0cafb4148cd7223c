/* SPDX-License-Identifier: MIT
 * --emit ninja: one rule, one build statement a job. Outputs that would get the same bytes keep
 * their time (restat), so that what depends on them rests too.
 */
#include <string.h>

#include "emit/emit.h"

/* A path in a build statement. */
static void put_path(const char *path)
{
    for (; *path; path++) {
        if (strchr(" :$|", *path))
            putchar('$');
        putchar(*path);
    }
}

/* A value that the shell has its quotes in already. */
static void put_value(const char *text)
{
    for (; *text; text++) {
        if (*text == '$')
            putchar('$');
        putchar(*text);
    }
}

static void put_rule(const emit_rules *rules, const emit_rule *rule)
{
    cli_arena *arena = &rules->plan->arena;
    fputs("\nbuild", stdout);
    for (size_t i = 0; i < rule->outputs.count; i++) {
        putchar(' ');
        put_path(rule->outputs.items[i]);
    }
    fputs(": csgmesh ", stdout);
    put_path(rule->job->scene);
    fputs("\n  arguments = ", stdout);
    put_value(emit_command(arena, rules, rule));
    if (!rule->job->by_part)
        fputs(" --if-changed", stdout);
    fputs("\n  read_files = ", stdout);
    put_value(rule->depfile);
    putchar('\n');
}

int emit_ninja(const emit_rules *rules)
{
    fputs("# Made by csgmesh batch --emit ninja. Each csgmesh takes one thread: ninja runs many.\n"
          "csgmesh = csgmesh\ncsgmesh_threads = 1\n\n"
          "rule csgmesh\n  command = $csgmesh -j $csgmesh_threads $arguments\n"
          "  depfile = $read_files\n  deps = gcc\n  restat = 1\n  description = MESH $out\n",
          stdout);
    for (size_t i = 0; i < rules->count; i++)
        if (rules->items[i].outputs.count)
            put_rule(rules, &rules->items[i]);
    fputs("\nbuild meshes: phony", stdout);
    for (size_t i = 0; i < rules->count; i++)
        for (size_t j = 0; j < rules->items[i].outputs.count; j++) {
            fputs(" $\n  ", stdout);
            put_path(rules->items[i].outputs.items[j]);
        }
    putchar('\n');
    return CLI_DONE;
}
