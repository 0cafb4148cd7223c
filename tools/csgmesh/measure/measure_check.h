/* SPDX-License-Identifier: MIT
 * Conditions on measures: --check 'volume < 120000 && size_x <= 80'. Measures are intervals, so a
 * condition is proven to hold, proven to fail, or neither.
 *
 *   condition   comparisons joined by && and ||, ! before one, parentheses
 *   comparison  two sums with <, <=, > or >= between
 *   sum         numbers, names of measures, + - * / and parentheses
 */
#ifndef CLI_MEASURE_CHECK_H
#define CLI_MEASURE_CHECK_H

#include "core/cli.h"
#include "measure/measure_figures.h"

typedef enum cli_truth { CLI_FAILS, CLI_UNDECIDED, CLI_HOLDS } cli_truth;

/* One condition of those that && joins. */
typedef struct cli_check {
    char *text;
    cli_truth truth;
} cli_check;

typedef struct cli_checks {
    cli_check *items;
    size_t count, capacity;
} cli_checks;

/* Reads conditions and says what is wrong with the first that is none, with its place. CLI_DONE or
 * CLI_TROUBLE. *groups: of figures that they name are added. */
int cli_checks_read(cli_app *app, const cli_list *texts, unsigned *groups);
/* Adds all conditions, decided by these figures. They have been read before. False: out of memory.
 */
bool cli_checks_decide(cli_checks *checks, const cli_list *texts, const cli_figures *figures);
void cli_checks_release(cli_checks *checks);
/* "holds", "fails" or "undecided". */
const char *cli_truth_name(cli_truth truth);

#endif
