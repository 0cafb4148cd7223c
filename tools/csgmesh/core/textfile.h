/* SPDX-License-Identifier: MIT
 * The program's small text outputs (statistics, reports, dependency rules) and reading standard
 * input.
 */
#ifndef CLI_TEXTFILE_H
#define CLI_TEXTFILE_H

#include <stdio.h>

#include "core/cli.h"

/* A text that grows in memory: open it, print to `out`, close it. */
typedef struct cli_text {
    FILE *out;
    char *text;
    size_t length;
} cli_text;

/* NULL without memory (not reported). Nothing need be closed then. */
FILE *cli_text_open(cli_text *text);
/* What was printed, for the caller to free; NULL without memory. */
char *cli_text_close(cli_text *text);
/* Closes it and writes it as cli_write_text does; also one that did not open. */
int cli_text_write(cli_app *app, cli_text *text, const char *path);

/* "-" is standard output. A file appears complete or not at all. Reports; CLI_DONE or CLI_TROUBLE.
 */
int cli_write_text(cli_app *app, const char *path, const char *text, size_t length);
/* All of it, past interruptions; false with errno. */
bool cli_write_fully(int fd, const char *bytes, size_t count);
/* All of a regular file, NULL on failure (reported). The caller frees it. */
char *cli_read_file(cli_app *app, const char *path, size_t largest, size_t *length);
/* All of standard input, NULL on failure (reported). The caller frees it. */
char *cli_read_stdin(cli_app *app, size_t *length);

#endif
