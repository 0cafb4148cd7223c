/* SPDX-License-Identifier: MIT
 * The loop; see follow.h.
 */
#include "core/follow.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include "core/cli.h"

static const double LOOK_S = 0.25; /* how long nothing is looked at where no event comes */
/* What an editor gets to finish a file; more than a tick of the clock that stamps files, so that
 * work begins after the stamp of the last change. */
enum { SETTLE_MS = 20 };

static volatile sig_atomic_t is_stopped;

static void stop(int number)
{
    (void)number;
    if (is_stopped) /* asked twice */
        _exit(CLI_TROUBLE);
    is_stopped = 1;
}

/* Ctrl-C is how it ends, and no fault. */
static void end_by_signals(void)
{
    struct sigaction action = {.sa_handler = stop};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* Until nothing changes any more: a file that is being written is read once it is whole. */
static void settle(cli_watch *watch)
{
    enum { MOST_LOOKS = 10 };
    for (int i = 0; i < MOST_LOOKS && !is_stopped; i++) {
        poll(NULL, 0, SETTLE_MS);
        if (!cli_watch_look(watch))
            return;
    }
}

void cli_follow(const cli_follower *follower)
{
    cli_watch watch;
    cli_watch_begin(&watch);
    end_by_signals();
    while (!is_stopped && follower->take_files(follower->user, &watch)) {
        if (cli_watch_look(&watch)) {
            settle(&watch);
            follower->ask(follower->user);
        }
        cli_watch_wait(&watch, LOOK_S);
    }
    cli_watch_release(&watch);
}
