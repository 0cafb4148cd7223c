/* SPDX-License-Identifier: MIT
 * What a batch says: a bar, a line for each failure with its findings below, a summary; JSON lines;
 * JUnit XML.
 */
#ifndef CLI_BATCH_REPORT_H
#define CLI_BATCH_REPORT_H

#include "batch/batch_run.h"

/* A job has ended; run->mutex is held. */
void batch_report_job(batch_run *run, size_t index);
/* Draws the bar, when one is wanted; run->mutex is held. */
void batch_report_progress(batch_run *run);
/* A warning of the batch itself, on any thread. */
__attribute__((format(printf, 2, 3))) void batch_report_warn(batch_run *run, const char *format,
                                                             ...);
/* The summary and the files of --json and --junit. The exit status of the batch. */
int batch_report_end(batch_run *run);

/* batch_junit.c: CLI_DONE or CLI_TROUBLE. */
int batch_junit_write(batch_run *run);

#endif
