/* SPDX-License-Identifier: MIT
 * csgmesh format SCENE...: each text in the layout of this project's scenes, in place. A text that
 * is laid out already is not written again; `-` goes from standard input to standard output. The
 * worst exit status of all texts is that of the command.
 */
#include <stdlib.h>
#include <string.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"
#include "core/textfile.h"
#include "csgmesh/editing.h"

/* All of a text, for the caller to free; NULL after a message. */
static char *read_text(cli_app *app, const char *path, size_t *length)
{
    enum { LARGEST = 64 << 20 }; /* as that of a scene */
    return strcmp(path, "-") == 0 ? cli_read_stdin(app, length)
                                  : cli_read_file(app, path, LARGEST, length);
}

/* Where the text in its new layout goes. */
typedef struct target {
    cli_app *app;
    const char *path, *text;
    size_t length;
    int status;
} target;

static void take(void *user, const char *text, size_t length)
{
    target *to = user;
    bool is_new = length != to->length || memcmp(text, to->text, length) != 0;
    bool is_standard = strcmp(to->path, "-") == 0;
    if (to->app->options->format_check) {
        if (is_new)
            printf("%s\n", is_standard ? "standard input" : to->path);
        to->status = is_new ? CLI_INPUT_AT_FAULT : CLI_DONE;
    } else if (is_new || is_standard) {
        to->status = cli_write_text(to->app, to->path, text, length);
    }
}

static int format(cli_app *app, const char *path)
{
    target to = {.app = app, .path = path, .status = CLI_DONE};
    char *text = read_text(app, path, &to.length);
    to.text = text;
    if (!text)
        return CLI_TROUBLE;
    csgm_status status = csgm_scene_format(app->context, text, to.length, path, take, &to);
    free(text);
    return status == CSGM_OK ? to.status : cli_exit_status(status);
}

int cli_cmd_format(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    if (!operands->count)
        return cli_usage_error(app, "as csgmesh format mug.txt", "no scene given");
    int worst = cli_app_open(app);
    for (size_t i = 0; app->context && i < operands->count; i++) {
        int status = format(app, operands->items[i]);
        worst = status > worst ? status : worst;
    }
    return cli_finish_stdout(app, worst);
}
