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

static atomic_bool progress_shown, is_asked, is_silent;

static void say(const char *text)
{
    if (write(STDERR_FILENO, text, strlen(text)) < 0) {
        /* nobody is left to be told */
    }
}

/* Twice: another thread may be about to open a file whose name is known already. */
_Noreturn void cli_interrupt_end(void)
{
    static const struct timespec moment = {.tv_nsec = 5000000};
    csgm_files_abandon();
    nanosleep(&moment, NULL);
    csgm_files_abandon();
    if (atomic_load(&progress_shown))
        say("\n");
    _exit(CLI_TROUBLE);
}

static void on_signal(int signal_number)
{
    (void)signal_number;
    if (!atomic_load(&is_silent))
        say("csgmesh: interrupted\n");
    cli_interrupt_end();
}

/* A signal that the parent made ignored stays ignored (nohup, background jobs). */
static void catch_signal(int signal_number, void (*handler)(int))
{
    struct sigaction old, action = {.sa_handler = handler};
    sigfillset(&action.sa_mask);
    if (sigaction(signal_number, NULL, &old) == 0 && old.sa_handler != SIG_IGN)
        sigaction(signal_number, &action, NULL);
}

void cli_interrupt_install(void)
{
    catch_signal(SIGINT, on_signal);
    catch_signal(SIGTERM, on_signal);
    catch_signal(SIGHUP, on_signal);
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

void cli_interrupt_be_silent(void)
{
    atomic_store(&is_silent, true);
}

static void on_first_signal(int signal_number)
{
    atomic_store(&is_asked, true);
    catch_signal(signal_number, on_signal);
}

void cli_interrupt_ask_first(void)
{
    catch_signal(SIGINT, on_first_signal);
}

bool cli_interrupt_is_asked(void)
{
    return atomic_load(&is_asked);
}

bool cli_interrupt_progress_shown(bool shown)
{
    return atomic_exchange(&progress_shown, shown);
}
