/* SPDX-License-Identifier: MIT
 * --over t=0:0.01:1: the values of a parameter, one a pose.
 */
#ifndef CLI_CLEAR_OVER_H
#define CLI_CLEAR_OVER_H

#include "core/cli.h"

enum { CLI_OVER_MOST = 1000000, CLI_OVER_TEXT = 40 };

typedef struct cli_over {
    char *name; /* NULL: there is one pose, the scene as it is */
    double first, step, last;
    size_t count;
    double *values; /* NULL: first + pose * step */
} cli_over;

/* text: NULL without --over. CLI_DONE, or CLI_TROUBLE (reported). */
int cli_over_read(cli_app *app, const char *text, cli_over *out);
/* A value half way to each pose of `open` (count of them) from the pose before. CLI_DONE, or
 * CLI_TROUBLE (reported) with the values as they were. */
int cli_over_halve(cli_app *app, cli_over *over, const bool *open);
void cli_over_release(cli_over *over);
/* The value of a pose as it is given to the scene and told. */
const char *cli_over_value(const cli_over *over, size_t pose, char text[CLI_OVER_TEXT]);

#endif
