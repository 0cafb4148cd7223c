/* SPDX-License-Identifier: MIT
 * Following files until Ctrl-C: work is asked for again whenever one of those that the last work
 * looked for has changed, gone or come.
 */
#ifndef CLI_FOLLOW_H
#define CLI_FOLLOW_H

#include "core/watch.h"

typedef struct cli_follower {
    void *user;
    /* Hands over a new list of files where there is one (cli_watch_set). false: that is all, there
     * is nothing to follow any more. */
    bool (*take_files)(void *user, cli_watch *watch);
    /* A file has changed: what is under way is of no use any more. */
    void (*ask)(void *user);
} cli_follower;

/* Returns when SIGINT or SIGTERM has come, which end the process from then on, or there is nothing
 * to follow. */
void cli_follow(const cli_follower *follower);

#endif
