/* SPDX-License-Identifier: MIT
 * --trace FILE: where the time of this run goes (docs/trace.md).
 */
#ifndef CLI_TRACE_H
#define CLI_TRACE_H

#include "core/cli.h"

/* Before the command: what would keep the file from being written later is refused now. CLI_DONE
 * or CLI_TROUBLE, reported. */
int cli_trace_begin(cli_app *app);
/* A fresh context's zone around all of its work. */
void cli_trace_open(cli_app *app);
/* Behind the command, which ended with that status: ends the app's context and writes the file,
 * also of a run that failed. Returns the exit status. */
int cli_trace_end(cli_app *app, int status);

#endif
