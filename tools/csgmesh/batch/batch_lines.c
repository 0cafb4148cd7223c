/* SPDX-License-Identifier: MIT
 * Reports of batches, line by line; see batch_lines.h.
 */
#include "batch/batch_lines.h"

#include <stdlib.h>
#include <string.h>

#include "core/textfile.h"

static int refuse(cli_app *app, const char *path, size_t number)
{
    cli_console_say(&app->console, CSGM_ERROR, "as csgmesh batch --json has printed it",
                    "%s:%zu: this is no report of a batch", path, number);
    return CLI_INPUT_AT_FAULT;
}

/* What is wrong with its JSON is no news: it is no report. */
static csgm_status parse(cli_app *app, cli_arena *arena, const batch_line *line, const char *path,
                         cli_value **out)
{
    cli_silence silence;
    bool too_deep;
    if (!cli_silence_begin(&silence, &app->console))
        return CSGM_ERR_IO;
    csgm_status status =
        cli_value_parse(app->context, arena, line->text, line->length, path, out, &too_deep);
    cli_silence_end(&silence, &app->console);
    return too_deep ? CSGM_ERR_SYNTAX : arena->failed ? CSGM_ERR_MEMORY : status;
}

static int take_line(cli_app *app, const char *path, batch_line *line, batch_line_fn *take,
                     void *user)
{
    cli_arena arena = {0};
    cli_value *value = NULL;
    int status = CLI_DONE;
    csgm_status parsed = parse(app, &arena, line, path, &value);
    line->object = value;
    if (parsed == CSGM_ERR_SYNTAX || (parsed == CSGM_OK && value->kind != CSGM_JSON_OBJECT)) {
        status = refuse(app, path, line->number);
    } else if (parsed != CSGM_OK) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path,
                        parsed == CSGM_ERR_UNSUPPORTED ? "this build has no JSON library"
                        : parsed == CSGM_ERR_MEMORY    ? "out of memory"
                                                       : "it cannot be looked at");
        status = CLI_TROUBLE;
    } else {
        status = take(user, line);
    }
    cli_arena_reset(&arena);
    return status;
}

int batch_lines_visit(cli_app *app, const char *path, const char *text, size_t length,
                      batch_line_fn *take, void *user)
{
    batch_line line = {.number = 0};
    int status = CLI_DONE;
    for (size_t at = 0; at < length && status == CLI_DONE; at += line.length + 1) {
        const char *end = memchr(text + at, '\n', length - at);
        line.number++;
        line.text = text + at;
        line.length = end ? (size_t)(end - line.text) : length - at;
        line.is_last = at + line.length + 1 >= length;
        status = take_line(app, path, &line, take, user);
    }
    return status == CLI_DONE && !length ? refuse(app, path, 1) : status;
}

int batch_lines_read(cli_app *app, const char *path, batch_line_fn *take, void *user)
{
    const size_t largest = (size_t)1 << 30;
    size_t length;
    char *text = cli_read_file(app, path, largest, &length);
    int status = text ? batch_lines_visit(app, path, text, length, take, user) : CLI_TROUBLE;
    free(text);
    return status;
}

const char *batch_line_text(const cli_value *object, const char *key)
{
    const cli_value *value = cli_value_member(object, key);
    return value && value->kind == CSGM_JSON_STRING ? value->text : NULL;
}

double batch_line_number(const cli_value *object, const char *key)
{
    const cli_value *value = cli_value_member(object, key);
    return value && value->kind == CSGM_JSON_NUMBER ? strtod(value->text, NULL) : 0;
}
