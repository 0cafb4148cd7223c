/* SPDX-License-Identifier: MIT
 * Events -> a tree; see batch_json.h. Depth and size are bounded, so that walking may recurse.
 */
#include "batch/batch_json.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DEEPEST = 32, LARGEST = 16 << 20 };

typedef struct builder {
    batch_arena *arena;
    batch_value *open[DEEPEST + 1];    /* open[0] holds the root as its child */
    batch_value **latest[DEEPEST + 1]; /* where its next child is linked */
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
        b->key = batch_strndup(b->arena, text, length);
        return true;
    }
    batch_value *value = batch_alloc(b->arena, sizeof *value);
    if (!value)
        return false;
    value->kind = kind;
    value->key = b->key;
    b->key = NULL;
    *b->latest[b->depth] = value;
    b->latest[b->depth] = &value->next;
    if (kind != CSGM_JSON_OBJECT && kind != CSGM_JSON_ARRAY) {
        value->text = batch_strndup(b->arena, text, length);
        return true;
    }
    b->too_deep = b->depth == DEEPEST;
    if (b->too_deep)
        return false;
    b->open[++b->depth] = value;
    b->latest[b->depth] = &value->first;
    return true;
}

/* A regular file as a whole; NULL after a report. The caller frees it. */
static char *read_file(cli_app *app, const char *path, size_t *length)
{
    struct stat status = {0};
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const char *problem = fd < 0 || fstat(fd, &status) != 0 ? strerror(errno)
                          : S_ISDIR(status.st_mode)         ? strerror(EISDIR)
                          : !S_ISREG(status.st_mode)        ? "it is not a file"
                          : status.st_size > LARGEST        ? "it is larger than 16 MiB"
                                                            : NULL;
    char *text = problem ? NULL : malloc((size_t)status.st_size + 1);
    *length = 0;
    while (text && *length < (size_t)status.st_size) {
        ssize_t got = read(fd, text + *length, (size_t)status.st_size - *length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            problem = strerror(errno);
        if (got <= 0)
            break;
        *length += (size_t)got;
    }
    if (problem || !text)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path,
                        problem ? problem : "out of memory");
    if (fd >= 0)
        close(fd);
    if (problem) {
        free(text);
        text = NULL;
    }
    return text;
}

csgm_status batch_json_parse(csgm_context *context, batch_arena *arena, const char *text,
                             size_t length, const char *name, batch_value **out, bool *too_deep)
{
    batch_value root = {0};
    builder b = {.arena = arena, .open = {&root}, .latest = {&root.first}};
    csgm_status status = csgm_json_read(context, text, length, name, take_event, &b);
    *too_deep = b.too_deep;
    *out = root.first;
    return status;
}

int batch_json_load(cli_app *app, batch_arena *arena, const char *path, batch_value **out)
{
    size_t length;
    bool too_deep;
    char *text = read_file(app, path, &length);
    if (!text)
        return CLI_TROUBLE;
    csgm_status status = batch_json_parse(app->context, arena, text, length, path, out, &too_deep);
    free(text);
    if (status == CSGM_OK && (too_deep || arena->failed)) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path,
                        too_deep ? "more than 32 brackets are nested" : "out of memory");
        return CLI_TROUBLE;
    }
    return cli_exit_status(status);
}

const batch_value *batch_json_member(const batch_value *object, const char *key)
{
    for (const batch_value *m = object ? object->first : NULL; m; m = m->next)
        if (m->key && strcmp(m->key, key) == 0)
            return m;
    return NULL;
}
