/* SPDX-License-Identifier: MIT
 * The program's small text outputs (statistics, dependency rules) and reading standard input.
 */
#ifndef CLI_TEXTFILE_H
#define CLI_TEXTFILE_H

#include "cli.h"

/* "-" is standard output. A file appears complete or not at all. Reports; CLI_DONE or CLI_TROUBLE.
 */
int cli_write_text(cli_app *app, const char *path, const char *text, size_t length);
/* All of standard input, NULL on failure (reported). The caller frees it. */
char *cli_read_stdin(cli_app *app, size_t *length);

#endif
