/* SPDX-License-Identifier: MIT
 * sigaction() for a page, where no signal ever comes.
 */
#ifndef CSGMESH_WEB_SIGNALS_H
#define CSGMESH_WEB_SIGNALS_H

#include <errno.h>
#include <signal.h>

struct sigaction {
    void (*sa_handler)(int);
    int sa_mask;
};

static inline int sigaction(int number, const struct sigaction *action, struct sigaction *old)
{
    (void)number, (void)action, (void)old;
    errno = ENOSYS;
    return -1;
}

static inline int sigfillset(int *set)
{
    return *set = 0;
}

#endif
