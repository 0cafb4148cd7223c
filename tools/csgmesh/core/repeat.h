/* SPDX-License-Identifier: MIT
 * --watch: a command's work again and again, in a process of its own each time, whenever a file has
 * changed that it looked for. What was under way then ends, and leaves no half file.
 */
#ifndef CLI_REPEAT_H
#define CLI_REPEAT_H

#include "core/cli.h"

/* Until Ctrl-C, which is CLI_DONE; work that fails before it has looked for any file, as that of a
 * wrong option does, ends it with its status. */
int cli_repeat(cli_app *app, int (*work)(cli_app *app));

#endif
