/* SPDX-License-Identifier: MIT
 * Signals; see interrupt.h. The handler calls only what is async-signal-safe: it removes unfinished
 * files, says one line and leaves with _exit. Nothing else of the process outlives it.
 */
#include "core/interrupt.h"

#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "core/cli.h"

static atomic_bool progress_shown, is_ending;
static _Atomic(const char *) pending_file;
enum { SLOTS = 64 };
static _Atomic(const char *) guarded[SLOTS];

static void say(const char *text)
{
    if (write(STDERR_FILENO, text, strlen(text)) < 0) {
        /* nobody is left to be told */
    }
}

static void remove_unfinished(void)
{
    const char *path = atomic_load(&pending_file);
    csgm_files_abandon();
    if (path)
        unlink(path);
    for (int i = 0; i < SLOTS; i++)
        if ((path = atomic_load(&guarded[i])))
            unlink(path);
}

/* Twice: another thread may be about to open a file whose name is known already. */
static void on_signal(int signal_number)
{
    (void)signal_number;
    static const struct timespec moment = {.tv_nsec = 5000000};
    atomic_store(&is_ending, true);
    remove_unfinished();
    nanosleep(&moment, NULL);
    remove_unfinished();
    if (atomic_load(&progress_shown))
        say("\n");
    say("csgmesh: interrupted\n");
    _exit(CLI_TROUBLE);
}

/* A signal that the parent made ignored stays ignored (nohup, background jobs). */
static void catch_signal(int signal_number)
{
    struct sigaction old, action = {.sa_handler = on_signal};
    sigfillset(&action.sa_mask);
    if (sigaction(signal_number, NULL, &old) == 0 && old.sa_handler != SIG_IGN)
        sigaction(signal_number, &action, NULL);
}

void cli_interrupt_install(void)
{
    catch_signal(SIGINT);
    catch_signal(SIGTERM);
    catch_signal(SIGHUP);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

bool cli_interrupt_progress_shown(bool shown)
{
    return atomic_exchange(&progress_shown, shown);
}

void cli_interrupt_pending_file(const char *path)
{
    atomic_store(&pending_file, path);
}

int cli_interrupt_guard(const char *path)
{
    while (atomic_load(&is_ending))
        pause(); /* nothing new is begun */
    for (int i = 0; i < SLOTS; i++) {
        const char *none = NULL;
        if (atomic_compare_exchange_strong(&guarded[i], &none, path))
            return i;
    }
    return -1;
}

void cli_interrupt_release(int slot)
{
    if (slot >= 0)
        atomic_store(&guarded[slot], NULL);
}
