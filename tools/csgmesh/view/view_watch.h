/* SPDX-License-Identifier: MIT
 * Files that are looked at again and again: has one changed, gone or come back? On Linux the kernel
 * wakes who waits (inotify, of the files' folders, since editors put a new file in the old one's
 * place); elsewhere, and on network file systems, looking from time to time finds it.
 */
#ifndef CLI_VIEW_WATCH_H
#define CLI_VIEW_WATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct view_stamp {
    bool is_there;
    uint64_t device, inode, size;
    int64_t changed_s, changed_ns;
} view_stamp;

typedef struct view_file {
    char *path;
    view_stamp stamp;
    bool is_kept; /* while a new list is taken */
} view_file;

typedef struct view_watch {
    view_file *files;
    size_t count, capacity;
    int events; /* inotify's, -1: none */
} view_watch;

void view_watch_begin(view_watch *watch);
void view_watch_release(view_watch *watch);

/* From here on these files, and no others. Of those that it had, what is known stays: what has
 * changed since it was looked at is told. Of new ones, what changed after since_s (of the wall
 * clock), when the scene was read, counts as a change. false: out of memory, some are not looked
 * at. */
bool view_watch_set(view_watch *watch, const char *const *paths, size_t count, double since_s);
/* Waits until something may have changed, or so long. Whether the kernel told of a change. */
bool view_watch_wait(view_watch *watch, double seconds);
/* Looks at all files; true: one is not as it was. */
bool view_watch_look(view_watch *watch);

#endif
