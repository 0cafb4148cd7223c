/* SPDX-License-Identifier: MIT
 * Measures as JSON and as lines for people.
 */
#ifndef CLI_MEASURE_PRINT_H
#define CLI_MEASURE_PRINT_H

#include "core/cli.h"

typedef struct cli_measured {
    const char *path, *part; /* part: NULL = all */
    bool is_mesh;
    const csgm_measures *measures;
    double density, to;
} cli_measured;

void cli_measure_json(const cli_measured *measured);
void cli_measure_text(const cli_measured *measured);

#endif
