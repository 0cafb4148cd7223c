/* SPDX-License-Identifier: MIT
 * Stamps of files, and who wakes us; see watch.h.
 */
#include "core/watch.h"

#include <glob.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/inotify.h>
#endif

#ifdef __APPLE__
#define CHANGED(status) (status).st_mtimespec
#define MOVED(status) (status).st_ctimespec
#else
#define CHANGED(status) (status).st_mtim
#define MOVED(status) (status).st_ctim
#endif

static double seconds_of(struct timespec time)
{
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

double cli_watch_clock_s(void)
{
    struct timespec now;
#ifdef CLOCK_REALTIME_COARSE
    clock_gettime(CLOCK_REALTIME_COARSE, &now);
#else
    clock_gettime(CLOCK_REALTIME, &now);
#endif
    return seconds_of(now);
}

/* *later_s: its bytes, its name or its rights changed last then; 0: it is not there. */
static cli_stamp stamp_of_file(const char *path, double *later_s)
{
    struct stat status;
    *later_s = 0;
    if (stat(path, &status) != 0)
        return (cli_stamp){.is_there = false};
    *later_s = seconds_of(CHANGED(status));
    if (seconds_of(MOVED(status)) > *later_s)
        *later_s = seconds_of(MOVED(status));
    return (cli_stamp){.is_there = true,
                       .device = (uint64_t)status.st_dev,
                       .inode = (uint64_t)status.st_ino,
                       .size = (uint64_t)status.st_size,
                       .changed_s = (int64_t)CHANGED(status).tv_sec,
                       .changed_ns = (int64_t)CHANGED(status).tv_nsec};
}

static cli_stamp stamp_of_pattern(const char *pattern)
{
    glob_t found;
    cli_stamp stamp = {.is_there = glob(pattern, 0, NULL, &found) == 0};
    for (size_t i = 0; stamp.is_there && i < found.gl_pathc; i++)
        stamp.size = cli_looked_hash(cli_looked_hash(stamp.size, found.gl_pathv[i]), "\n");
    if (stamp.is_there)
        globfree(&found);
    return stamp;
}

static bool is_same(const cli_stamp *a, const cli_stamp *b)
{
    return a->is_there == b->is_there && a->device == b->device && a->inode == b->inode &&
           a->size == b->size && a->changed_s == b->changed_s && a->changed_ns == b->changed_ns;
}

/* ---- the kernel's events ---------------------------------------------------------------------- */

void cli_watch_begin(cli_watch *watch)
{
    *watch = (cli_watch){.events = -1};
#ifdef __linux__
    watch->events = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
#endif
}

/* A folder that is named twice is watched once. Where the kernel has no more room for watches, or
 * the folder has a pattern for a name, the file is found by looking. */
static void watch_folder(const cli_watch *watch, const char *path)
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

void cli_watch_wait(cli_watch *watch, double seconds)
{
    char events[4096];
    struct pollfd wanted = {.fd = watch->events, .events = POLLIN};
    poll(&wanted, 1, (int)(1000 * seconds)); /* it passes over what is negative */
    if (watch->events >= 0 && read(watch->events, events, sizeof events) > 0) {
        /* which file it was, the stamps tell; a folder in which much happens is not waited for */
    }
}

/* ---- the list --------------------------------------------------------------------------------- */

void cli_watch_release(cli_watch *watch)
{
    for (size_t i = 0; i < watch->count; i++)
        free(watch->items[i].path);
    free(watch->items);
    if (watch->events >= 0)
        close(watch->events);
    *watch = (cli_watch){.events = -1};
}

/* What is no file's: so the next look finds a change. */
static const cli_stamp unlike_any = {.is_there = true, .size = UINT64_MAX};

static bool add(cli_watch *watch, const cli_looked_item *file, double since_s)
{
    if (watch->count == watch->capacity) {
        size_t capacity = 2 * watch->capacity + 8;
        cli_watched *items = realloc(watch->items, capacity * sizeof *items);
        if (!items)
            return false;
        watch->items = items;
        watch->capacity = capacity;
    }
    cli_watched *new = &watch->items[watch->count];
    *new =
        (cli_watched){.path = strdup(file->path), .is_pattern = file->kind == CLI_LOOKED_PATTERN};
    if (!new->path)
        return false;
    watch_folder(watch, new->path); /* before it is looked at, so that nothing falls between */
    if (new->is_pattern) {
        new->stamp = stamp_of_pattern(new->path);
    } else {
        double later_s;
        new->stamp = stamp_of_file(new->path, &later_s);
        if (new->stamp.is_there != (file->kind == CLI_LOOKED_FOUND) || later_s >= since_s)
            new->stamp = unlike_any;
    }
    watch->count++;
    return true;
}

bool cli_watch_set(cli_watch *watch, const cli_looked *files, double since_s)
{
    bool *is_known = calloc(files->count + 1, sizeof *is_known); /* per file of the new list */
    if (!is_known)
        return false;
    size_t kept = 0;
    for (size_t i = 0; i < watch->count; i++) {
        size_t at = cli_looked_find(files, watch->items[i].path);
        if (at < files->count) {
            is_known[at] = true;
            watch->items[kept++] = watch->items[i];
        } else {
            free(watch->items[i].path);
        }
    }
    watch->count = kept;
    bool done = true;
    for (size_t i = 0; i < files->count; i++)
        if (!is_known[i])
            done = add(watch, &files->items[i], since_s) && done;
    free(is_known);
    return done;
}

bool cli_watch_look(cli_watch *watch)
{
    bool changed = false;
    for (size_t i = 0; i < watch->count; i++) {
        cli_watched *item = &watch->items[i];
        double later_s;
        cli_stamp now =
            item->is_pattern ? stamp_of_pattern(item->path) : stamp_of_file(item->path, &later_s);
        changed |= !is_same(&now, &item->stamp);
        item->stamp = now;
    }
    return changed;
}
