/* SPDX-License-Identifier: MIT
 * What a run reads is not what it writes: an output that is the scene, a file that it includes or
 * imports, an input of diff or another output is refused before anything is written. Files are
 * compared by device and inode, so links and "./" make no difference; one that does not exist yet
 * by its folder and name.
 */
#ifndef CLI_SOURCES_H
#define CLI_SOURCES_H

#include "core/cli.h"

/* The outputs that the options name against each other and against the operands. CLI_DONE, or
 * CLI_TROUBLE after one error. */
int cli_sources_guard(cli_app *app);
/* The same outputs against all that a scene was read from. */
int cli_sources_guard_scene(cli_app *app, const csgm_scene *scene);
/* The same outputs against one more file that is read; NULL is none. */
int cli_sources_guard_file(cli_app *app, const char *input);

/* The same outputs against a file that this run has written, and that is none of them. */
int cli_sources_guard_written(cli_app *app, const char *output);
/* Is it one of the outputs? Nothing is reported. */
bool cli_sources_is_output(const cli_options *options, const char *path);

#endif
