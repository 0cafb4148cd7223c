/* SPDX-License-Identifier: MIT
 * csgmesh deps SCENE: every file that was read, in order of first reading.
 */
#include <stdio.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"

int cli_cmd_deps(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    if (operands->count != 1)
        return cli_usage_error(app, "as csgmesh deps mug.txt",
                               operands->count ? "one scene at a time" : "no scene given");
    csgm_scene *scene = NULL;
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_exit_status(cli_app_load(app, operands->items[0], &scene));
    const char *path;
    for (size_t i = 0; scene && (path = csgm_scene_dependency(scene, i)); i++)
        puts(path);
    csgm_scene_destroy(scene);
    return cli_finish_stdout(app, status);
}
