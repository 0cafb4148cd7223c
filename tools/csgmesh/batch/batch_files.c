/* SPDX-License-Identifier: MIT
 * Files of batches; see batch_files.h.
 */
#include "batch/batch_files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/textfile.h"

bool batch_make_folders(const char *path, bool whole)
{
    char folder[PATH_MAX];
    size_t length = strlen(path);
    if (length >= sizeof folder) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (size_t i = 1; i <= length; i++) {
        if (path[i] != '/' && (path[i] || !whole))
            continue;
        memcpy(folder, path, i);
        folder[i] = '\0';
        if (mkdir(folder, 0777) != 0) {
            struct stat status; /* a folder that is there, perhaps in one that is read-only */
            int reason = errno;
            if (stat(folder, &status) != 0 || !S_ISDIR(status.st_mode)) {
                errno = reason == EEXIST ? ENOTDIR : reason;
                return false;
            }
        }
    }
    return true;
}

/* ---- writing -------------------------------------------------------------------------- */

/* Ends the file with errno of what failed first. */
static bool end_file(csgm_file *file, bool good, bool sync)
{
    int reason = errno;
    csgm_status status = csgm_file_end(file, good, sync);
    if (!good)
        errno = reason;
    return good && status == CSGM_OK;
}

bool batch_write_small(const char *path, const char *text, size_t length)
{
    csgm_file *file;
    if (csgm_file_create(NULL, path, &file) != CSGM_OK)
        return false;
    return end_file(file, cli_write_fully(csgm_file_descriptor(file), text, length), false);
}

/* -1 with errno; of a pipe or a folder, EINVAL. */
static int open_regular(const char *path)
{
    struct stat status;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd >= 0 && (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode))) {
        close(fd);
        errno = EINVAL;
        return -1;
    }
    return fd;
}

char *batch_read_small(cli_arena *arena, const char *path, size_t *length)
{
    enum { LARGEST = 16 << 20 };
    struct stat status;
    int fd = open_regular(path);
    if (fd < 0)
        return NULL;
    char *text = NULL;
    *length = 0;
    if (fstat(fd, &status) == 0 && status.st_size <= LARGEST)
        text = cli_arena_alloc(arena, (size_t)status.st_size + 1);
    while (text && *length < (size_t)status.st_size) {
        ssize_t got = read(fd, text + *length, (size_t)status.st_size - *length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            break;
        *length += (size_t)got;
    }
    close(fd);
    return text;
}

static bool pour(int from, int to, batch_digest *digest)
{
    char buffer[1 << 16];
    batch_hasher hasher;
    batch_hash_begin(&hasher);
    for (;;) {
        ssize_t count = read(from, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR)
            continue;
        if (count < 0)
            return false;
        if (count == 0)
            break;
        batch_hash_add(&hasher, buffer, (size_t)count);
        if (!cli_write_fully(to, buffer, (size_t)count))
            return false;
    }
    *digest = batch_hash_end(&hasher);
    return true;
}

bool batch_copy(const char *from, const char *to, const batch_digest *digest, bool if_changed,
                bool sync)
{
    csgm_file *file = NULL;
    batch_digest found;
    if (if_changed && batch_hash_path(to, &found) && batch_digest_equal(&found, digest))
        return true;
    int source = open_regular(from);
    if (source < 0)
        return false;
    bool opened = csgm_file_create(NULL, to, &file) == CSGM_OK;
    bool good = opened && pour(source, csgm_file_descriptor(file), &found);
    if (good && !batch_digest_equal(&found, digest)) {
        good = false;
        errno = EBADMSG;
    }
    int reason = errno;
    close(source);
    errno = reason;
    return opened && end_file(file, good, sync);
}

/* ---- locks ---------------------------------------------------------------------------- */

enum { BYTE_OF_BATCHES = 0, FIRST_BYTE_OF_JOBS = 16 };

static bool set_lock(int fd, int command, short kind, uint64_t at)
{
    struct flock lock = {
        .l_type = kind, .l_whence = SEEK_SET, .l_start = (off_t)at, .l_len = 1, .l_pid = 0};
    int result;
    do
        result = fcntl(fd, command, &lock);
    while (result != 0 && errno == EINTR);
    return result == 0 || (errno != EAGAIN && errno != EACCES); /* no locks here: as if it had */
}

bool batch_locks_open(batch_locks *locks, const char *path)
{
    *locks = (batch_locks){.fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666)};
    if (locks->fd < 0)
        return false;
    locks->alone = set_lock(locks->fd, F_OFD_SETLK, F_WRLCK, BYTE_OF_BATCHES);
    return true;
}

void batch_locks_share(batch_locks *locks)
{
    set_lock(locks->fd, F_OFD_SETLKW, F_RDLCK, BYTE_OF_BATCHES);
}

void batch_locks_close(batch_locks *locks)
{
    if (locks->fd >= 0)
        close(locks->fd);
    locks->fd = -1;
}

static uint64_t byte_of(const batch_digest *id)
{
    uint64_t at = 0;
    for (int i = 0; i < 5; i++)
        at = at << 8 | id->bytes[i];
    return FIRST_BYTE_OF_JOBS + at;
}

bool batch_lock_job(const batch_locks *locks, const batch_digest *id, bool wait)
{
    return set_lock(locks->fd, wait ? F_OFD_SETLKW : F_OFD_SETLK, F_WRLCK, byte_of(id));
}

void batch_unlock_job(const batch_locks *locks, const batch_digest *id)
{
    set_lock(locks->fd, F_OFD_SETLK, F_UNLCK, byte_of(id));
}
