/* SPDX-License-Identifier: MIT
 * The reports of `diff` that people look at: --png, a picture of one comparison, and --html, a page
 * with all of them.
 */
#ifndef CLI_DIFF_REPORT_H
#define CLI_DIFF_REPORT_H

#include "core/json.h"
#include "diff/diff_drawing.h"

/* Triangles that one page may hold, so that browsers open it at once; of one mesh, of all. */
enum { DIFF_PAGE_MESH_MOST = 250000, DIFF_PAGE_MOST = 1500000 };

/* Names of the files, PNG in this build. CLI_DONE or CLI_TROUBLE (reported). */
int diff_report_check(cli_app *app);
/* Whether the meshes have to be looked at even where the files' bytes are the same. */
bool diff_report_draws(const cli_app *app, const diff_result *result);
/* Before result `index` is worked on: what is left of the page for its meshes. */
void diff_report_begin(diff_results *results, size_t index);
/* While the meshes are there: writes the picture, keeps what the page will show. */
int diff_report_add(cli_app *app, const csgm_diff *diff, const diff_side sides[2],
                    diff_result *result);
int diff_write_html(cli_app *app, const diff_results *results);

int diff_write_picture(cli_app *app, const diff_drawing *drawing, const diff_result *result,
                       const char *path);
/* The meshes as JSON for the page, NULL when there is no memory; the caller frees it. `room`:
 * triangles that may be used, lowered by those that were. */
char *diff_models_text(const diff_drawing *drawing, uint64_t *room);
/* The members of one comparison as --json has them, without the names of files. */
void diff_put_report(cli_json *json, const csgm_diff_report *report);

#endif
