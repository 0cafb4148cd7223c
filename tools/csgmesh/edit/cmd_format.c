/* SPDX-License-Identifier: MIT
 * csgmesh format SCENE...: each text in the layout of this project's scenes, in place. A text that
 * is laid out already is not written again; `-` goes from standard input to standard output. The
 * worst exit status of all texts is that of the command.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/cli.h"
#include "core/textfile.h"
#include "csgmesh/editing.h"

static int refuse(cli_app *app, const char *path, const char *reason)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path, reason);
    return CLI_TROUBLE;
}

/* All of a file, for the caller to free; NULL after a message. */
static char *read_file(cli_app *app, const char *path, size_t *length)
{
    enum { LARGEST = 64 << 20 }; /* as that of a scene */
    if (strcmp(path, "-") == 0)
        return cli_read_stdin(app, length);
    struct stat info;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const char *reason = NULL;
    char *text = NULL;
    *length = 0;
    if (file < 0 || fstat(file, &info) != 0)
        reason = strerror(errno);
    else if (!S_ISREG(info.st_mode))
        reason = S_ISDIR(info.st_mode) ? "this is a directory" : "this is not a regular file";
    else if (info.st_size > LARGEST)
        reason = "the text is larger than 64 MiB";
    else if (!(text = malloc((size_t)info.st_size + 1)))
        reason = "out of memory";
    while (!reason && *length < (size_t)info.st_size) {
        ssize_t got = read(file, text + *length, (size_t)info.st_size - *length);
        if (got == 0)
            break;
        if (got < 0 && errno != EINTR)
            reason = strerror(errno);
        *length += got > 0 ? (size_t)got : 0;
    }
    if (file >= 0)
        close(file);
    if (!reason)
        return text;
    refuse(app, path, reason);
    free(text);
    return NULL;
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
    if (to->app->options.format_check) {
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
    char *text = read_file(app, path, &to.length);
    to.text = text;
    if (!text)
        return CLI_TROUBLE;
    csgm_status status = csgm_scene_format(app->context, text, to.length, path, take, &to);
    free(text);
    return status == CSGM_OK ? to.status : cli_exit_status(status);
}

int cli_cmd_format(cli_app *app)
{
    const cli_list *operands = &app->options.operands;
    if (!operands->count)
        return cli_usage_error(app, "as csgmesh format mug.txt", "no scene given");
    int worst = cli_app_open(app);
    for (size_t i = 0; app->context && i < operands->count; i++) {
        int status = format(app, operands->items[i]);
        worst = status > worst ? status : worst;
    }
    return cli_finish_stdout(app, worst);
}
