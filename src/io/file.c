/* SPDX-License-Identifier: MIT
 * Atomic files; see file.h. Their bytes go to a file without a name (temporary.h).
 */
#include "io/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mesh_codes.h"
#include "base/trace.h"

/* ---- finding the target ----------------------------------------------------------- */

static csgm_status fail(csg_atomic_file *file, int error)
{
    if (error == ENOMEM) {
        csg_arena_reset(&file->names);
        csgm_status status = csg_context_no_memory(file->context);
        errno = error;
        return status;
    }
    csg_diag_plain(&file->context->diags, CSG_DIAG_CANNOT_WRITE, file->path, NULL,
                   "cannot write: %s",
                   error == ELOOP ? "its symbolic links lead in a circle, or are more than forty"
                                  : strerror(error));
    csg_arena_reset(&file->names);
    errno = error;
    return CSGM_ERR_IO;
}

/* /dev/stdout and its like name an open descriptor: writing through a copy of it keeps its offset
 * and append mode, which opening the name again would not. */
static int descriptor_of(const char *path)
{
    if (strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    char *end = NULL;
    if (strncmp(path, "/dev/fd/", 8) != 0 || path[8] < '0' || path[8] > '9')
        return -1;
    long fd = strtol(path + 8, &end, 10);
    return *end == '\0' && fd >= 0 && fd <= INT_MAX ? (int)fd : -1;
}

static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* Follows the last component's links, also one that leads nowhere yet. NULL with errno set. */
static const char *follow_links(csg_arena *names, const char *path)
{
    enum { MOST_LINKS = 40 }; /* as Linux itself */
    char link[PATH_MAX];
    for (int i = 0; i < MOST_LINKS; i++) {
        ssize_t length = readlink(path, link, sizeof link);
        if (length < 0)
            return errno == EINVAL || errno == ENOENT ? path : NULL;
        if ((size_t)length >= sizeof link) {
            errno = ENAMETOOLONG;
            return NULL;
        }
        int folder = length && link[0] == '/' ? 0 : (int)folder_length(path);
        path = csg_arena_printf(names, "%.*s%.*s", folder, path, (int)length, link);
        if (!path) {
            errno = ENOMEM;
            return NULL;
        }
    }
    errno = ELOOP;
    return NULL;
}

static csgm_status open_direct(csg_atomic_file *file, int descriptor)
{
    file->fd = descriptor >= 0 ? fcntl(descriptor, F_DUPFD_CLOEXEC, 0)
                               : open(file->path, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    return file->fd < 0 ? fail(file, errno) : CSGM_OK;
}

/* Which hidden name a file gets; all NULL: one of its own. */
typedef struct hidden_name {
    const char *kept; /* csg_file_create_kept */
    bool *was_there;
} hidden_name;

static int open_temporary(csg_atomic_file *file, const hidden_name *hidden)
{
    const char *folder =
        csg_arena_printf(&file->names, "%.*s", (int)folder_length(file->target), file->target);
    if (!folder)
        return ENOMEM;
    csg_temporary_sweep_once(folder);
    const char *kept = hidden->kept ? csg_arena_printf(&file->names, "%s", hidden->kept) : NULL;
    if (hidden->kept && !kept)
        return ENOMEM;
    int error = kept ? csg_temporary_open_kept(&file->temporary, kept, hidden->was_there)
                : file->is_shared
                    ? csg_temporary_open_named(&file->temporary, &file->names, file->target)
                    : csg_temporary_open(&file->temporary, &file->names, file->target);
    file->fd = file->temporary.fd;
    return error;
}

/* The new file gets the old one's mode and, where we may, its owner. */
static void take_over(int fd, const struct stat *old)
{
    if ((old->st_uid != geteuid() || old->st_gid != getegid()) &&
        fchown(fd, old->st_uid, old->st_gid) != 0)
        errno = 0; /* not ours to give: the file belongs to who wrote it */
    if (fchmod(fd, old->st_mode & 0777) != 0)
        errno = 0;
}

static csgm_status create(csg_atomic_file *file, csgm_context *context, const char *path,
                          bool is_shared, const hidden_name *hidden)
{
    *file = (csg_atomic_file){
        .context = context, .path = path, .fd = -1, .sync = true, .is_shared = is_shared};
    csg_arena_init(&file->names, &context->memory);
    int descriptor = descriptor_of(path);
    struct stat old;
    bool exists = stat(path, &old) == 0;
    if (!exists && (errno != ENOENT || !path[0]))
        return fail(file, errno);
    if (exists && S_ISDIR(old.st_mode))
        return fail(file, EISDIR);
    if (descriptor >= 0 || (exists && !S_ISREG(old.st_mode)))
        return open_direct(file, descriptor);
    if (exists && access(path, W_OK) != 0)
        return fail(file, errno);
    file->target = follow_links(&file->names, path);
    if (!file->target)
        return fail(file, errno);
    int error = open_temporary(file, hidden);
    if (error)
        return fail(file, error);
    file->is_new = !exists;
    if (exists)
        take_over(file->fd, &old);
    return CSGM_OK;
}

csgm_status csg_file_create(csg_atomic_file *file, csgm_context *context, const char *path)
{
    return create(file, context, path, false, &(hidden_name){0});
}

csgm_status csg_file_create_shared(csg_atomic_file *file, csgm_context *context, const char *path)
{
    return create(file, context, path, true, &(hidden_name){0});
}

csgm_status csg_file_create_kept(csg_atomic_file *file, csgm_context *context, const char *path,
                                 const char *kept, bool *was_there)
{
    return create(file, context, path, true, &(hidden_name){kept, was_there});
}

csgm_status csg_file_attach(csg_atomic_file *file, csgm_context *context, const char *path,
                            const char *name, bool is_kept)
{
    bool was_there;
    *file = (csg_atomic_file){
        .context = context, .path = path, .fd = -1, .sync = true, .is_shared = true};
    csg_arena_init(&file->names, &context->memory);
    const char *own = csg_arena_printf(&file->names, "%s", name);
    file->target = own;
    int error = !own      ? ENOMEM
                : is_kept ? csg_temporary_open_kept(&file->temporary, own, &was_there)
                          : csg_temporary_attach(&file->temporary, own);
    file->fd = file->temporary.fd;
    return error ? fail(file, error) : CSGM_OK;
}

/* ---- the end ---------------------------------------------------------------------- */

static bool read_fully(int fd, char *buffer, size_t size, off_t at, size_t *got)
{
    for (*got = 0; *got < size;) {
        ssize_t count = pread(fd, buffer + *got, size - *got, at + (off_t)*got);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return count == 0;
        *got += (size_t)count;
    }
    return true;
}

static bool same_bytes(int a, int b)
{
    enum { PIECE = 1 << 15 };
    char left[PIECE], right[PIECE];
    size_t left_count, right_count;
    off_t at = 0;
    do {
        if (!read_fully(a, left, PIECE, at, &left_count) ||
            !read_fully(b, right, PIECE, at, &right_count) || left_count != right_count ||
            memcmp(left, right, left_count) != 0)
            return false;
        at += PIECE;
    } while (left_count == PIECE);
    return true;
}

/* Does the target hold the temporary's bytes? Where that cannot be told, it does not. */
static bool is_unchanged(const csg_atomic_file *file)
{
    struct stat old, new;
    if (stat(file->target, &old) != 0 || fstat(file->fd, &new) != 0 || old.st_size != new.st_size)
        return false;
    int descriptor = open(file->target, O_RDONLY | O_CLOEXEC);
    bool same = descriptor >= 0 && same_bytes(descriptor, file->fd);
    if (descriptor >= 0)
        close(descriptor);
    return same;
}

static int wait_for_disk(const csg_atomic_file *file)
{
    CSG_ZONE(file->context, "sync");
    return fsync(file->fd) == 0 ? 0 : errno;
}

/* Closes; the first error's errno, or 0. */
static int close_file(csg_atomic_file *file, int error)
{
    int closing = file->target                            ? csg_temporary_close(&file->temporary)
                  : file->fd >= 0 && close(file->fd) != 0 ? errno
                                                          : 0;
    file->fd = -1;
    return error ? error : closing;
}

/* Named if there was no error so far, and closed. */
static csgm_status end_file(csg_atomic_file *file, int error)
{
    if (file->target && !error)
        error = csg_temporary_rename(&file->temporary, file->target, file->is_new);
    error = close_file(file, error);
    if (error)
        return fail(file, error);
    csg_arena_reset(&file->names);
    return CSGM_OK;
}

csgm_status csg_file_flush(csg_atomic_file *file)
{
    int error = file->sync ? wait_for_disk(file) : 0;
    if (!error)
        error = csg_temporary_flush(&file->temporary);
    if (!error)
        return CSGM_OK;
    csg_diag_plain(&file->context->diags, CSG_DIAG_CANNOT_WRITE, file->path, NULL,
                   "cannot write: %s", strerror(error));
    return CSGM_ERR_IO;
}

struct csg_held_file {
    csg_held_file *next;
    csg_atomic_file file;
};

/* Takes a complete file over. */
static csgm_status hold(csg_atomic_file *file)
{
    csgm_context *context = file->context;
    csg_held_file *held = csg_memory_alloc(&context->memory, sizeof *held);
    const char *path = held ? csg_arena_printf(&file->names, "%s", file->path) : NULL;
    if (!path) {
        csg_memory_release(&context->memory, held, held ? sizeof *held : 0);
        csg_file_abandon(file);
        return csg_context_no_memory(context);
    }
    *held = (csg_held_file){.next = context->held, .file = *file};
    held->file.path = path; /* the caller's may be gone by then */
    if (held->file.target == file->path)
        held->file.target = path;
    context->held = held;
    return CSGM_OK;
}

csgm_status csg_file_commit(csg_atomic_file *file)
{
    if (file->target && file->only_if_changed && is_unchanged(file)) {
        csg_file_abandon(file);
        return CSGM_OK;
    }
    int error = file->target && file->sync ? wait_for_disk(file) : 0;
    bool waits = !error && file->target && file->context->holds_files;
    return waits ? hold(file) : end_file(file, error);
}

void csg_file_abandon(csg_atomic_file *file)
{
    close_file(file, 0);
    csg_arena_reset(&file->names);
}

/* ---- held files ------------------------------------------------------------------- */

void csg_files_hold(csgm_context *context)
{
    context->holds_files = true;
}

static csg_held_file *in_their_order(csg_held_file *list)
{
    csg_held_file *first = NULL;
    while (list) {
        csg_held_file *next = list->next;
        list->next = first;
        first = list;
        list = next;
    }
    return first;
}

csgm_status csg_files_release(csgm_context *context, bool keep)
{
    csgm_status status = CSGM_OK;
    csg_held_file *list = in_their_order(context->held);
    context->held = NULL;
    context->holds_files = false;
    while (list) {
        csg_held_file *next = list->next;
        if (keep && status == CSGM_OK)
            status = end_file(&list->file, 0);
        else
            csg_file_abandon(&list->file);
        csg_memory_release(&context->memory, list, sizeof *list);
        list = next;
    }
    return status;
}
