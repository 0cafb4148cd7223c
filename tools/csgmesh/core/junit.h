/* SPDX-License-Identifier: MIT
 * Reports as JUnit XML, which CI servers read. No time stamps.
 */
#ifndef CLI_JUNIT_H
#define CLI_JUNIT_H

#include <stdio.h>

typedef struct cli_junit_counts {
    size_t tests, failures, errors, skipped;
    double seconds; /* < 0: times are not known */
} cli_junit_counts;

/* The head of the file; `command` as in "csgmesh batch". */
void cli_junit_open(FILE *out, const char *command, const cli_junit_counts *counts);
void cli_junit_close(FILE *out);

#endif
