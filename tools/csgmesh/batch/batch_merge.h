/* SPDX-License-Identifier: MIT
 * --merge-reports: the reports of a batch's shards, of --json or of --junit, become one, which
 * looks like that of one machine. What is missing or there twice is said.
 */
#ifndef CLI_BATCH_MERGE_H
#define CLI_BATCH_MERGE_H

#include "batch/batch_run.h"

/* A job of a report: bytes of its text. */
typedef struct batch_merge_job {
    const char *name; /* what tells it from others; not terminated where it is of JUnit */
    size_t name_length;
    const char *text;
    size_t length;
    size_t number; /* in the whole batch; 0: not known */
    size_t report; /* it came from */
    batch_outcome outcome;
    int status; /* of BATCH_FAILED */
} batch_merge_job;

typedef struct batch_merge_report {
    const char *path;
    char *text;                 /* the file, terminated; freed by batch_merge */
    const char *version, *name; /* of the program and of the batch */
    size_t shard, shards, all_jobs, jobs;
    double seconds;
    bool is_whole; /* it has its sums */
} batch_merge_report;

typedef struct batch_merge {
    cli_app *app;
    cli_arena arena;
    batch_merge_report *reports;
    size_t report_count;
    batch_merge_job *jobs;
    size_t job_count;
    bool *is_there; /* for each shard from 1 on */
} batch_merge;

/* The command. The exit status. */
int batch_merge_reports(cli_app *app);

/* The next job, of the latest report; NULL: no memory. */
batch_merge_job *batch_merge_add(batch_merge *merge);
/* "PATH: this is no report ..."; CLI_INPUT_AT_FAULT. */
int batch_merge_refuse(batch_merge *merge, const char *path);

/* batch_merge_junit.c. CLI_DONE, or an exit status after a report. */
int batch_merge_read_junit(batch_merge *merge, batch_merge_report *report);
void batch_merge_write_junit(const batch_merge *merge, FILE *out);

#endif
