/* SPDX-License-Identifier: MIT
 * Files that are looked at again and again: has one changed, gone or come? On Linux the kernel
 * wakes who waits (inotify, of the files' folders, since editors put a new file in the old one's
 * place); elsewhere, and on network file systems, looking from time to time finds it.
 */
#ifndef CLI_WATCH_H
#define CLI_WATCH_H

#include "core/looked.h"

/* What a file is known by; of a pattern, size is a hash of the names that match it. */
typedef struct cli_stamp {
    bool is_there;
    uint64_t device, inode, size;
    int64_t changed_s, changed_ns;
} cli_stamp;

typedef struct cli_watched {
    char *path;
    bool is_pattern;
    cli_stamp stamp;
} cli_watched;

typedef struct cli_watch {
    cli_watched *items;
    size_t count, capacity;
    int events; /* inotify's, -1: none */
} cli_watch;

void cli_watch_begin(cli_watch *watch);
void cli_watch_release(cli_watch *watch);

/* From here on these files, and no others. Of those that it had, what is known stays: what has
 * changed since it was looked at is told. Of new ones, what changed from since_s on (of
 * cli_watch_clock_s()), when they were looked for, counts as a change, and so does what has come or
 * gone since.
 * false: out of memory, some are not looked at. */
bool cli_watch_set(cli_watch *watch, const cli_looked *files, double since_s);
/* Waits until something may have changed, or so long. */
void cli_watch_wait(cli_watch *watch, double seconds);
/* Looks at all files; true: one is not as it was. */
bool cli_watch_look(cli_watch *watch);

/* The wall clock by which file systems stamp changes; its ticks are up to 10 milliseconds long. */
double cli_watch_clock_s(void);

#endif
