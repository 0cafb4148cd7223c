/* SPDX-License-Identifier: MIT
 * What `diff` found out about a pair of files, and the ways in which it tells it.
 */
#ifndef CLI_DIFF_RESULT_H
#define CLI_DIFF_RESULT_H

#include "core/cli.h"

typedef enum diff_outcome {
    DIFF_SAME,
    DIFF_DIFFERENT,
    DIFF_ONLY_A,
    DIFF_ONLY_B,
    DIFF_FAILED
} diff_outcome;

typedef struct diff_result {
    char *a, *b; /* paths; one is NULL where the other is alone */
    diff_outcome outcome;
    int exit_status;    /* of this pair */
    bool lacks_picture; /* one that was asked for could not be made */
    bool is_updated;    /* A is now B */
    csgm_diff_report
        report;         /* of pairs that were compared; level SAME_BYTES: nothing else is set */
    char *models;       /* for --html: the meshes as JSON, or NULL */
    uint64_t page_room; /* triangles that the page may still hold */
} diff_result;

typedef struct diff_results {
    diff_result *items;
    size_t count, room;
    bool of_folders;
} diff_results;

/* A sentence without a newline: "0.83 apart, more than 0.01". */
void diff_explain(const diff_result *result, char *text, size_t size);
/* Five lines, or one for what there is nothing to measure about. */
void diff_print(const cli_console *console, const diff_result *result, bool with_details);
/* --json and --junit. CLI_DONE or CLI_TROUBLE. */
int diff_write_json(cli_app *app, const diff_results *results);
int diff_write_junit(cli_app *app, const diff_results *results);

#endif
