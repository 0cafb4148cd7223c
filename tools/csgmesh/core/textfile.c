/* SPDX-License-Identifier: MIT
 * Small files; see textfile.h. Regular files are written beside the target, synced and renamed;
 * devices and pipes are written directly.
 */
#include "core/textfile.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/interrupt.h"

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

static bool write_directly(const char *path, const char *text, size_t length)
{
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0)
        return false;
    bool good = cli_write_fully(fd, text, length);
    int reason = errno;
    good = close(fd) == 0 && good;
    if (!good && reason)
        errno = reason;
    return good;
}

/* Created by our own open, not mkstemp, so that the kernel applies the umask. */
static int open_beside(const char *target, char *temporary, size_t size)
{
    static atomic_uint counter;
    for (int attempt = 0; attempt < 1000; attempt++) {
        const char *slash = strrchr(target, '/');
        int folder = slash ? (int)(slash + 1 - target) : 0;
        int written = snprintf(temporary, size, "%.*s.csgmesh-%ld-t%u.tmp", folder, target,
                               (long)getpid(), atomic_fetch_add(&counter, 1));
        if (written < 0 || (size_t)written >= size) {
            errno = ENAMETOOLONG;
            return -1;
        }
        int fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

static bool write_renamed(const char *target, const char *text, size_t length)
{
    char temporary[PATH_MAX + 64];
    int fd = open_beside(target, temporary, sizeof temporary);
    if (fd < 0)
        return false;
    cli_interrupt_pending_file(temporary);
    errno = 0;
    bool good = cli_write_fully(fd, text, length) && fsync(fd) == 0;
    int reason = errno;
    good = close(fd) == 0 && good && rename(temporary, target) == 0;
    if (!good) {
        reason = reason ? reason : errno;
        unlink(temporary);
        errno = reason;
    }
    cli_interrupt_pending_file(NULL);
    return good;
}

static bool write_path(const char *path, const char *text, size_t length)
{
    struct stat status;
    char target[PATH_MAX];
    errno = 0;
    if (strcmp(path, "-") == 0)
        return cli_write_fully(STDOUT_FILENO, text, length);
    if (stat(path, &status) != 0)
        return write_renamed(path, text, length);
    errno = 0;
    if (!S_ISREG(status.st_mode))
        return write_directly(path, text, length);
    return realpath(path, target) && write_renamed(target, text, length);
}

int cli_write_text(cli_app *app, const char *path, const char *text, size_t length)
{
    if (write_path(path, text, length))
        return CLI_DONE;
    const char *reason = strerror(errno);
    bool is_stdout = strcmp(path, "-") == 0;
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot write %s: %s",
                    is_stdout ? "standard output" : path, reason);
    return CLI_TROUBLE;
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
