/* SPDX-License-Identifier: MIT
 * One mesh file -> the -o files of a run, changed on the way where --simplify, --improve or
 * --smooth ask for it. Both `csgmesh a.glb -o b.stl` and `csgmesh convert` come here.
 */
#ifndef CLI_CONVERT_H
#define CLI_CONVERT_H

#include "core/cli.h"

/* Usage: options that say the opposite, outputs that no mesh can be. CLI_DONE or CLI_TROUBLE. */
int cli_convert_check(cli_app *app);
/* The outputs are app->options->outputs. json: an object for --stats; NULL: none is wanted. An exit
 * status; failures are reported. */
int cli_convert_file(cli_app *app, const char *path, cli_json *json);
/* `csgmesh mesh` of a mesh: options of scenes have no effect. An exit status. */
int cli_convert_operand(cli_app *app, const char *path);
/* All operands, with statistics, to the -o files or to -d. An exit status. */
int cli_convert_run(cli_app *app);

/* Warns of what the format cannot hold of the mesh. */
void cli_convert_warn_of_losses(cli_app *app, const csgm_mesh *read, const csgm_mesh_view *mesh,
                                const char *path, csgm_format format);

#endif
