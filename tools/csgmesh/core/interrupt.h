/* SPDX-License-Identifier: MIT
 * Ctrl-C and its like: the process ends at once, whatever it is doing, and leaves no half file.
 */
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

/* Installs the handlers; SIGPIPE and SIGXFSZ become errors of write(). */
void cli_interrupt_install(void);
/* Tells the handler whether a bar stands on the terminal; returns what was told before. */
bool cli_interrupt_progress_shown(bool shown);
/* A file to remove when interrupted; NULL = none. The text must stay valid. */
void cli_interrupt_pending_file(const char *path);
/* The same for the files of many threads: a slot to give to cli_interrupt_release, -1 when there is
 * none left. Does not return once the process is being ended. */
int cli_interrupt_guard(const char *path);
void cli_interrupt_release(int slot);

#endif
