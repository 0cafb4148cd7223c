/* SPDX-License-Identifier: MIT
 * The -o files of one run: their formats, what can be known to fail before any work is done, and
 * writing them.
 */
#ifndef CLI_OUTPUTS_H
#define CLI_OUTPUTS_H

#include "core/work.h"

/* The format of output `index`; AUTO when neither its name nor -f says. */
csgm_format cli_outputs_format(const cli_options *options, size_t index);
/* Usage, formats of this build, directories that cannot be written. CLI_DONE or CLI_TROUBLE. */
int cli_outputs_check(cli_app *app, const char *scene_path);
/* --meta, --lod, --uv and --compress. CLI_DONE or CLI_TROUBLE, reported. */
int cli_outputs_check_contents(cli_app *app);
/* --compress draco or --draco. */
bool cli_outputs_draco(const cli_options *options);
/* What --normals asks for, given the formats. */
csgm_normals cli_outputs_normals(const cli_options *options);
/* Whether it has colours or materials. */
bool cli_format_keeps_looks(csgm_format format);
/* Whether colours and materials are asked for: not where no format has them. */
bool cli_outputs_colors(const cli_options *options);
/* Of --unit. */
csgm_unit cli_outputs_unit(const cli_options *options);
/* scene_path: the file names it as its source; NULL = it names none. The app keeps the texts. */
csgm_write_options cli_outputs_options(cli_app *app, const char *scene_path);
/* To all -o files. An exit status; failures are reported. */
int cli_outputs_write_view(cli_app *app, const csgm_mesh_view *mesh,
                           const csgm_write_options *options);
/* Meshes the levels of --lod, too. */
int cli_outputs_write(cli_app *app, cli_work *work);

/* What would fail after minutes of work is refused now: a missing or locked folder. CLI_DONE or
 * CLI_TROUBLE, reported. */
int cli_outputs_check_place(cli_app *app, const char *path);

#endif
