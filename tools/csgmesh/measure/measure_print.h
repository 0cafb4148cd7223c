/* SPDX-License-Identifier: MIT
 * Measures as JSON and as lines for people, checks as JUnit XML.
 */
#ifndef CLI_MEASURE_PRINT_H
#define CLI_MEASURE_PRINT_H

#include "measure/measure_check.h"

/* One of the parts that are measured by themselves. */
typedef struct cli_measured_part {
    const char *name;
    cli_figures figures;
} cli_measured_part;

typedef struct cli_measured {
    const char *path, *part; /* part: NULL = all */
    bool is_mesh;
    const cli_figures *figures;
    double density, to;
    cli_checks checks;
    const cli_measured_part *parts;
    size_t part_count;
} cli_measured;

void cli_measure_json(const cli_measured *measured);
void cli_measure_text(const cli_measured *measured);
/* A report of the checks; CLI_DONE or CLI_TROUBLE. */
int cli_measure_junit(cli_app *app, const cli_measured *measured);

#endif
