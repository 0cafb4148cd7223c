/* SPDX-License-Identifier: MIT
 * Dependency rules for Make and Ninja.
 */
#ifndef CLI_DEPFILE_H
#define CLI_DEPFILE_H

#include "core/cli.h"

/* Usage: a rule needs a target. */
int cli_depfile_check(cli_app *app);
/* "out.glb out.ply: scene.txt lib.txt", then an empty rule for each file read but the first, so
 * that a removed include is no error (as gcc -MP). */
int cli_depfile_write(cli_app *app, const csgm_scene *scene);
int cli_depfile_put(cli_app *app, const char *path, const cli_list *targets,
                    const cli_list *dependencies);

#endif
