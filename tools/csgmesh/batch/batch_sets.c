/* SPDX-License-Identifier: MIT
 * Files of parameter sets, as OpenSCAD's customizer writes them; see batch_sets.h.
 */
#include "batch/batch_sets.h"

#include <fnmatch.h>
#include <stdio.h>
#include <string.h>

#include "core/json_tree.h"

/* The tree's depth is bounded by its reader. */
static void hash_value(batch_hasher *hasher, const cli_value *value)
{
    char kind[2] = {(char)('a' + (int)value->kind), '\0'};
    batch_hash_text(hasher, kind);
    batch_hash_text(hasher, value->key ? value->key : "");
    batch_hash_text(hasher, value->text ? value->text : "");
    for (const cli_value *v = value->first; v; v = v->next)
        hash_value(hasher, v);
    batch_hash_text(hasher, "end");
}

static const batch_sets *find_file(const batch_sets_cache *cache, const char *path)
{
    for (size_t i = 0; i < cache->count; i++)
        if (strcmp(cache->files[i].path, path) == 0)
            return &cache->files[i];
    return NULL;
}

int batch_sets_load(cli_app *app, cli_arena *arena, batch_sets_cache *cache, const char *path,
                    batch_sets *out)
{
    const batch_sets *known = find_file(cache, path);
    cli_value *root = NULL;
    *out = known ? *known : (batch_sets){.path = path};
    int status = known ? CLI_DONE : cli_value_load(app, arena, path, &root);
    if (known || status != CLI_DONE)
        return status;
    const cli_value *sets = cli_value_member(root, "parameterSets");
    if (!sets || sets->kind != CSGM_JSON_OBJECT) {
        cli_console_say(&app->console, CSGM_ERROR,
                        "it is written {\"parameterSets\": {\"small\": {\"radius\": \"5\"}}}",
                        "%s: the file holds no parameter sets", path);
        return CLI_INPUT_AT_FAULT;
    }
    for (const cli_value *v = sets->first; v; v = v->next) {
        batch_hasher hasher;
        batch_set *set = cli_arena_push(arena, (void **)&out->items, &out->count, sizeof *set);
        if (!set)
            break;
        batch_hash_begin(&hasher);
        hash_value(&hasher, v);
        *set = (batch_set){.name = v->key, .digest = batch_hash_end(&hasher)};
    }
    batch_sets *place = cli_arena_push(arena, (void **)&cache->files, &cache->count, sizeof *place);
    if (place)
        *place = *out;
    return CLI_DONE;
}

static bool choose(const batch_sets *sets, const char *pattern, bool *chosen)
{
    bool any = false;
    for (size_t i = 0; i < sets->count; i++) /* a name is a name, whatever letters it has */
        if (strcmp(sets->items[i].name, pattern) == 0)
            any = chosen[i] = true;
    for (size_t i = 0; !any && i < sets->count; i++)
        if (fnmatch(pattern, sets->items[i].name, 0) == 0)
            chosen[i] = true;
    for (size_t i = 0; i < sets->count; i++)
        any = any || (chosen[i] && fnmatch(pattern, sets->items[i].name, 0) == 0);
    return any;
}

static int refuse(cli_app *app, const batch_sets *sets, const char *place, const char *pattern)
{
    char hint[320];
    int used = snprintf(hint, sizeof hint, sets->count ? "it has" : "it has none");
    for (size_t i = 0; i < sets->count && used < 250; i++)
        used += snprintf(hint + used, sizeof hint - (size_t)used, "%s '%.60s'", i ? "," : "",
                         sets->items[i].name);
    cli_console_say(&app->console, CSGM_ERROR, hint, "%s: %s has no parameter set '%.80s'", place,
                    sets->path, pattern);
    return CLI_INPUT_AT_FAULT;
}

int batch_sets_choose(cli_app *app, cli_arena *arena, const batch_sets *sets, const char *place,
                      const cli_list *patterns, batch_set **chosen, size_t *count)
{
    bool *marks = cli_arena_alloc(arena, sets->count + 1);
    *chosen = NULL;
    *count = 0;
    for (size_t i = 0; marks && i < patterns->count; i++)
        if (!choose(sets, patterns->items[i], marks))
            return refuse(app, sets, place, patterns->items[i]);
    for (size_t i = 0; marks && i < sets->count; i++) {
        batch_set *copy =
            marks[i] ? cli_arena_push(arena, (void **)chosen, count, sizeof *copy) : NULL;
        if (copy)
            *copy = sets->items[i];
    }
    return CLI_DONE;
}
