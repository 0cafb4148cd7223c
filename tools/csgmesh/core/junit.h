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
/* Facts about the whole, right behind the head. */
void cli_junit_begin_properties(FILE *out);
void cli_junit_property(FILE *out, const char *name, const char *value);
void cli_junit_count(FILE *out, const char *name, size_t value);
void cli_junit_end_properties(FILE *out);
void cli_junit_close(FILE *out);

#endif
