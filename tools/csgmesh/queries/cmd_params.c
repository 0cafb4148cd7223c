/* SPDX-License-Identifier: MIT
 * csgmesh params SCENE: what may be set, as JSON in the layout that OpenSCAD exports parameters in.
 * What is under [Hidden] is not shown. "value" stands where -p, -P or -D set one.
 */
#include <string.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"
#include "queries/params_json.h"

/* The file's name without folder and extension. */
static void put_title(cli_json *json, const char *path)
{
    const char *name = cli_file_name(path);
    const char *dot = strrchr(name, '.');
    char title[256];
    snprintf(title, sizeof title, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name),
             name);
    cli_json_string(json, "title", title);
}

static void put_params(const csgm_params *params, const char *path)
{
    cli_json json = cli_json_make(stdout, false);
    cli_json_begin(&json, '{');
    cli_json_break(&json);
    cli_json_string(&json, "fileFormatVersion", "1");
    cli_json_break(&json);
    put_title(&json, path);
    cli_json_break(&json);
    cli_put_params(&json, params);
    cli_json_break(&json);
    cli_json_end(&json, '}');
    putchar('\n');
}

int cli_cmd_params(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    if (operands->count != 1)
        return cli_usage_error(app, "as csgmesh params mug.txt",
                               operands->count ? "one scene at a time" : "no scene given");
    csgm_params *params = NULL;
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_exit_status(cli_app_load_params(app, operands->items[0], &params));
    if (status == CLI_DONE)
        put_params(params, operands->items[0]);
    csgm_params_destroy(params);
    return cli_finish_stdout(app, status);
}
