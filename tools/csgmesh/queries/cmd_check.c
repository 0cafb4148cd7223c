/* SPDX-License-Identifier: MIT
 * csgmesh check SCENE...: parses and evaluates each, reports, writes nothing, and makes no more of
 * it than mistakes depend on, unless --solids asks for all. The worst exit status of all scenes is
 * that of the command.
 */
#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"

int cli_cmd_check(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    if (!operands->count)
        return cli_usage_error(app, "as csgmesh check mug.txt", "no scene given");
    int worst = cli_app_open(app);
    app->only_checks = !app->options->solids;
    for (size_t i = 0; app->context && i < operands->count; i++) {
        csgm_scene *scene = NULL;
        int status = cli_exit_status(cli_app_load(app, operands->items[i], &scene));
        csgm_scene_destroy(scene);
        worst = status > worst ? status : worst;
    }
    return worst;
}
