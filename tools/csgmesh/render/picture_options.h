/* SPDX-License-Identifier: MIT
 * What the options of a picture say: sizes, cameras, colours, sections.
 */
#ifndef CLI_PICTURE_OPTIONS_H
#define CLI_PICTURE_OPTIONS_H

#include "core/cli.h"

/* CLI_DONE, or CLI_TROUBLE after a message that names the option. */
int cli_picture_options(cli_app *app, csgm_render_options *out);
/* --view alone, into the camera's angles; without it they stay. */
int cli_picture_view(cli_app *app, csgm_camera *camera);
/* Whether a file of this name can be written: CLI_DONE, or CLI_TROUBLE after a message. */
int cli_picture_check(cli_app *app, const char *path);

#endif
