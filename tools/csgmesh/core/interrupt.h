/* SPDX-License-Identifier: MIT
 * Ctrl-C and its like: the process ends at once, whatever it is doing, and leaves no half file.
 */
#ifndef CLI_INTERRUPT_H
#define CLI_INTERRUPT_H

#include <stdbool.h>

/* Installs the handlers; SIGPIPE and SIGXFSZ become errors of write(). */
void cli_interrupt_install(void);
/* Signals that end the process are not told: its parent does. */
void cli_interrupt_be_silent(void);
/* For work whose result so far is worth having: from now on the first Ctrl-C only asks for it, and
 * the second one ends the process. */
void cli_interrupt_ask_first(void);
bool cli_interrupt_is_asked(void);
/* Ends the process now, without a word: nobody wants what it is making any more. On any thread. */
_Noreturn void cli_interrupt_end(void);
/* Tells the handler whether a bar stands on the terminal; returns what was told before. */
bool cli_interrupt_progress_shown(bool shown);

#endif
