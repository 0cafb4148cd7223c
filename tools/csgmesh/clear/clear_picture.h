/* SPDX-License-Identifier: MIT
 * --picture: the worst pair at its worst pose.
 */
#ifndef CLI_CLEAR_PICTURE_H
#define CLI_CLEAR_PICTURE_H

#include "clear/clear_print.h"

/* The pair that a picture is drawn of; NULL: nothing is known of any. */
const csgm_clear_pair *cli_clear_worst(const cli_cleared *cleared);
/* scene: that of the pair's pose. CLI_DONE, or CLI_TROUBLE (reported). */
int cli_clear_picture(cli_app *app, const cli_cleared *cleared, const csgm_clear_pair *pair,
                      const csgm_scene *scene, const char *path);

#endif
