/* SPDX-License-Identifier: MIT
 * Stamps of files, and who wakes us; see view_watch.h.
 */
#include "view/view_watch.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/inotify.h>
#endif

#ifdef __APPLE__
#define CHANGED(status) (status).st_mtimespec
#else
#define CHANGED(status) (status).st_mtim
#endif

static view_stamp stamp_of(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return (view_stamp){.is_there = false};
    return (view_stamp){.is_there = true,
                        .device = (uint64_t)status.st_dev,
                        .inode = (uint64_t)status.st_ino,
                        .size = (uint64_t)status.st_size,
                        .changed_s = (int64_t)CHANGED(status).tv_sec,
                        .changed_ns = (int64_t)CHANGED(status).tv_nsec};
}

static bool is_same(const view_stamp *a, const view_stamp *b)
{
    return a->is_there == b->is_there && a->device == b->device && a->inode == b->inode &&
           a->size == b->size && a->changed_s == b->changed_s && a->changed_ns == b->changed_ns;
}

/* ---- the kernel's events ---------------------------------------------------------------------- */

void view_watch_begin(view_watch *watch)
{
    *watch = (view_watch){.events = -1};
#ifdef __linux__
    watch->events = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
#endif
}

/* A folder that is named twice is watched once. Where the kernel has no more room for watches, the
 * file is found by looking. */
static void watch_folder(const view_watch *watch, const char *path)
{
#ifdef __linux__
    const uint32_t events = IN_CLOSE_WRITE | IN_MODIFY | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE |
                            IN_DELETE | IN_ATTRIB | IN_ONLYDIR;
    char *folder = watch->events >= 0 ? strdup(path) : NULL;
    if (!folder)
        return;
    char *slash = strrchr(folder, '/');
    if (slash)
        slash[slash == folder] = '\0';
    inotify_add_watch(watch->events, slash ? folder : ".", events);
    free(folder);
#else
    (void)watch;
    (void)path;
#endif
}

bool view_watch_wait(view_watch *watch, double seconds)
{
    char events[4096];
    struct pollfd wanted = {.fd = watch->events, .events = POLLIN};
    poll(&wanted, watch->events >= 0 ? 1 : 0, (int)(1000 * seconds));
    /* which file it was, the stamps tell; a folder in which much happens is not waited for */
    return watch->events >= 0 && read(watch->events, events, sizeof events) > 0;
}

/* ---- the list --------------------------------------------------------------------------------- */

static void forget_all(view_watch *watch)
{
    for (size_t i = 0; i < watch->count; i++)
        free(watch->files[i].path);
    watch->count = 0;
}

void view_watch_release(view_watch *watch)
{
    forget_all(watch);
    free(watch->files);
    if (watch->events >= 0)
        close(watch->events);
    *watch = (view_watch){.events = -1};
}

static view_file *find(view_watch *watch, const char *path)
{
    for (size_t i = 0; i < watch->count; i++)
        if (strcmp(watch->files[i].path, path) == 0)
            return &watch->files[i];
    return NULL;
}

static bool add(view_watch *watch, const char *path, double since_s)
{
    if (watch->count == watch->capacity) {
        size_t capacity = 2 * watch->capacity + 8;
        view_file *files = realloc(watch->files, capacity * sizeof *files);
        if (!files)
            return false;
        watch->files = files;
        watch->capacity = capacity;
    }
    view_file *new = &watch->files[watch->count];
    *new = (view_file){.path = strdup(path), .is_kept = true};
    if (!new->path)
        return false;
    new->stamp = stamp_of(path);
    if ((double)new->stamp.changed_s + 1e-9 * (double)new->stamp.changed_ns > since_s)
        new->stamp = (view_stamp){.is_there = false};
    watch_folder(watch, path);
    watch->count++;
    return true;
}

bool view_watch_set(view_watch *watch, const char *const *paths, size_t count, double since_s)
{
    bool done = true;
    for (size_t i = 0; i < watch->count; i++)
        watch->files[i].is_kept = false;
    for (size_t i = 0; i < count; i++) {
        view_file *known = find(watch, paths[i]);
        if (known)
            known->is_kept = true;
        else
            done = add(watch, paths[i], since_s) && done;
    }
    size_t kept = 0;
    for (size_t i = 0; i < watch->count; i++)
        if (watch->files[i].is_kept)
            watch->files[kept++] = watch->files[i];
        else
            free(watch->files[i].path);
    watch->count = kept;
    return done;
}

bool view_watch_look(view_watch *watch)
{
    bool changed = false;
    for (size_t i = 0; i < watch->count; i++) {
        view_stamp now = stamp_of(watch->files[i].path);
        changed |= !is_same(&now, &watch->files[i].stamp);
        watch->files[i].stamp = now;
    }
    return changed;
}
