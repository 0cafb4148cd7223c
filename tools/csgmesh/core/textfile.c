/* SPDX-License-Identifier: MIT
 * Small files; see textfile.h.
 */
#include "core/textfile.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool cli_write_fully(int fd, const char *bytes, size_t count)
{
    while (count > 0) {
        ssize_t written = write(fd, bytes, count);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            return false;
        bytes += written;
        count -= (size_t)written;
    }
    return true;
}

/* What is not the library's to tell: it has told all of a file when it has a context. */
static int refuse(cli_app *app, const char *path, const char *reason)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot write %s: %s", path, reason);
    return CLI_TROUBLE;
}

int cli_write_text(cli_app *app, const char *path, const char *text, size_t length)
{
    csgm_file *file;
    if (strcmp(path, "-") == 0)
        return cli_write_fully(STDOUT_FILENO, text, length)
                   ? CLI_DONE
                   : refuse(app, "standard output", strerror(errno));
    csgm_status status = csgm_file_create(app->context, path, &file);
    if (status == CSGM_OK && !cli_write_fully(csgm_file_descriptor(file), text, length)) {
        int reason = errno;
        csgm_file_end(file, false, false);
        return refuse(app, path, strerror(reason));
    }
    if (status == CSGM_OK)
        status = csgm_file_end(file, true, true);
    if (status != CSGM_OK && !app->context)
        refuse(app, path, strerror(errno));
    return cli_exit_status(status);
}

FILE *cli_text_open(cli_text *text)
{
    *text = (cli_text){NULL, NULL, 0};
    text->out = open_memstream(&text->text, &text->length);
    return text->out;
}

char *cli_text_close(cli_text *text)
{
    if (text->out && fclose(text->out) == 0)
        return text->text;
    free(text->text);
    return NULL;
}

int cli_text_write(cli_app *app, cli_text *text, const char *path)
{
    char *bytes = cli_text_close(text);
    int status = CLI_TROUBLE;
    if (bytes)
        status = cli_write_text(app, path, bytes, text->length);
    else
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    free(bytes);
    return status;
}

/* Why a file cannot be read as a whole, written to `text` where it is no fixed words; NULL: it can,
 * as far as is known. */
static const char *unreadable(int fd, size_t largest, struct stat *info, char text[64])
{
    if (fd < 0 || fstat(fd, info) != 0)
        return strerror(errno);
    if (!S_ISREG(info->st_mode))
        return S_ISDIR(info->st_mode) ? "this is a directory" : "this is not a regular file";
    snprintf(text, 64, "it is larger than %zu MiB", largest >> 20);
    return (size_t)info->st_size > largest ? text : NULL;
}

char *cli_read_file(cli_app *app, const char *path, size_t largest, size_t *length)
{
    struct stat info;
    char words[64];
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    const char *reason = unreadable(fd, largest, &info, words);
    char *text = reason ? NULL : malloc((size_t)info.st_size + 1);
    if (!reason && !text)
        reason = "out of memory";
    ssize_t got = 1;
    for (*length = 0; !reason && *length < (size_t)info.st_size && got != 0;) {
        got = read(fd, text + *length, (size_t)info.st_size - *length);
        if (got < 0 && errno != EINTR)
            reason = strerror(errno);
        *length += got > 0 ? (size_t)got : 0;
    }
    if (fd >= 0)
        close(fd);
    if (!reason)
        return text;
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path, reason);
    free(text);
    return NULL;
}

char *cli_read_stdin(cli_app *app, size_t *length)
{
    size_t room = 1 << 16, most = (size_t)1 << 31;
    char *text = malloc(room);
    *length = 0;
    while (text) {
        ssize_t got = read(STDIN_FILENO, text + *length, room - *length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got == 0)
            return text;
        if (got < 0 || *length > most) {
            cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read standard input: %s",
                            got < 0 ? strerror(errno) : "it is larger than 2 GiB");
            free(text);
            return NULL;
        }
        *length += (size_t)got;
        if (*length == room) {
            char *larger = realloc(text, room *= 2);
            if (!larger)
                break;
            text = larger;
        }
    }
    free(text);
    cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    return NULL;
}
