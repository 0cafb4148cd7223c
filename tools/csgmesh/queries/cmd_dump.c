/* SPDX-License-Identifier: MIT
 * csgmesh dump --scene|--tape|--vm|--csg SCENE: the evaluated tree as scene text, the tape, a
 * formula, or the tree as OpenSCAD says it.
 */
#include <stdio.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"

static void put_on_stdout(void *user, const char *text, size_t length)
{
    fwrite(text, 1, length, user);
}

int cli_cmd_dump(cli_app *app)
{
    const cli_options *options = app->options;
    if (options->operands.count != 1)
        return cli_usage_error(app, "as csgmesh dump --scene mug.txt",
                               options->operands.count ? "one scene at a time" : "no scene given");
    if (options->tree + options->tape + options->vm + options->csg != 1)
        return cli_usage_error(app, NULL, "say which: --scene, --tape, --vm or --csg");
    csgm_dump what = options->tape  ? CSGM_DUMP_TAPE
                     : options->vm  ? CSGM_DUMP_VM
                     : options->csg ? CSGM_DUMP_OPENSCAD
                                    : CSGM_DUMP_SCENE;
    if (options->csg)
        app->flat = CSGM_FLAT_KEPT;
    csgm_scene *scene = NULL;
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_exit_status(cli_app_load(app, options->operands.items[0], &scene));
    if (status == CLI_DONE)
        status = cli_exit_status(csgm_scene_dump(app->context, scene, what, put_on_stdout, stdout));
    csgm_scene_destroy(scene);
    return cli_finish_stdout(app, status);
}
