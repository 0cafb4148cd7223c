/* SPDX-License-Identifier: MIT
 * Reading what `csgmesh batch --json` has printed: an object a line, the last one with the sums.
 */
#ifndef CLI_BATCH_LINES_H
#define CLI_BATCH_LINES_H

#include "core/json_tree.h"

typedef struct batch_line {
    const cli_value *object;
    const char *text; /* of it, without the end of the line; not terminated */
    size_t length;
    size_t number; /* in the file, from 1 on */
    bool is_last;
} batch_line;

/* CLI_DONE to go on, or the exit status after a report. The object lasts until it returns. */
typedef int batch_line_fn(void *user, const batch_line *line);

/* All lines of a text that came from `path`. CLI_DONE, or an exit status after a report. */
int batch_lines_visit(cli_app *app, const char *path, const char *text, size_t length,
                      batch_line_fn *take, void *user);
/* The same of a file, at most 1 GiB. */
int batch_lines_read(cli_app *app, const char *path, batch_line_fn *take, void *user);

/* A member's text, or NULL; a member that is a number, or 0. */
const char *batch_line_text(const cli_value *object, const char *key);
double batch_line_number(const cli_value *object, const char *key);

#endif
