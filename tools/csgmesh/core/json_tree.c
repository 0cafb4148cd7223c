/* SPDX-License-Identifier: MIT
 * Events -> a tree; see json_tree.h. Depth and size are bounded, so that walking may recurse.
 */
#include "core/json_tree.h"

#include <stdlib.h>
#include <string.h>

#include "core/textfile.h"

enum { DEEPEST = 32, LARGEST = 16 << 20 };

typedef struct builder {
    cli_arena *arena;
    cli_value *open[DEEPEST + 1];    /* open[0] holds the root as its child */
    cli_value **latest[DEEPEST + 1]; /* where its next child is linked */
    int depth;
    const char *key;
    bool too_deep;
} builder;

static bool take_event(void *user, csgm_json_kind kind, const char *text, size_t length)
{
    builder *b = user;
    if (kind == CSGM_JSON_END) {
        b->depth--;
        return true;
    }
    if (kind == CSGM_JSON_KEY) {
        b->key = cli_arena_strndup(b->arena, text, length);
        return true;
    }
    cli_value *value = cli_arena_alloc(b->arena, sizeof *value);
    if (!value)
        return false;
    value->kind = kind;
    value->key = b->key;
    b->key = NULL;
    *b->latest[b->depth] = value;
    b->latest[b->depth] = &value->next;
    if (kind != CSGM_JSON_OBJECT && kind != CSGM_JSON_ARRAY) {
        value->text = cli_arena_strndup(b->arena, text, length);
        value->length = b->arena->failed ? 0 : length;
        return true;
    }
    b->too_deep = b->depth == DEEPEST;
    if (b->too_deep)
        return false;
    b->open[++b->depth] = value;
    b->latest[b->depth] = &value->first;
    return true;
}

csgm_status cli_value_parse(csgm_context *context, cli_arena *arena, const char *text,
                            size_t length, const char *name, cli_value **out, bool *too_deep)
{
    cli_value root = {0};
    builder b = {.arena = arena, .open = {&root}, .latest = {&root.first}};
    csgm_status status = csgm_json_read(context, text, length, name, take_event, &b);
    *too_deep = b.too_deep;
    *out = root.first;
    return status;
}

int cli_value_load(cli_app *app, cli_arena *arena, const char *path, cli_value **out)
{
    size_t length;
    bool too_deep;
    char *text = cli_read_file(app, path, LARGEST, &length);
    if (!text)
        return CLI_TROUBLE;
    csgm_status status = cli_value_parse(app->context, arena, text, length, path, out, &too_deep);
    free(text);
    if (status == CSGM_OK && (too_deep || arena->failed)) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path,
                        too_deep ? "more than 32 brackets are nested" : "out of memory");
        return CLI_TROUBLE;
    }
    return cli_exit_status(status);
}

const cli_value *cli_value_member(const cli_value *object, const char *key)
{
    for (const cli_value *m = object ? object->first : NULL; m; m = m->next)
        if (m->key && strcmp(m->key, key) == 0)
            return m;
    return NULL;
}
