/* SPDX-License-Identifier: MIT
 * The files of two folders that `diff` compares with each other.
 */
#ifndef CLI_DIFF_FOLDERS_H
#define CLI_DIFF_FOLDERS_H

#include "diff/diff_result.h"

bool diff_is_folder(const char *path);

/* A result for each pair and each file that stands alone, in the order of names, outcome SAME,
 * ONLY_A or ONLY_B. CLI_DONE or CLI_TROUBLE (reported). */
int diff_pair_folders(cli_app *app, const char *a, const char *b, diff_results *out);
/* Takes copies of the paths. False: out of memory (reported). */
bool diff_results_add(cli_app *app, diff_results *results, const char *a, const char *b);
void diff_results_release(diff_results *results);

#endif
