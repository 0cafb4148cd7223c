/* SPDX-License-Identifier: MIT
 * csgmesh params SCENE: what may be set, as JSON in the layout that OpenSCAD exports parameters in.
 * What is under [Hidden] is not shown. "value" stands where -p, -P or -D set one.
 */
#include <math.h>
#include <string.h>

#include "core/cli.h"
#include "core/json.h"

static void put_value(cli_json *json, const char *key, const csgm_param_value *value)
{
    switch (value->kind) {
    case CSGM_PARAM_NUMBER:
        cli_json_number(json, key, value->numbers[0]);
        break;
    case CSGM_PARAM_BOOLEAN:
        cli_json_bool(json, key, value->numbers[0] != 0);
        break;
    case CSGM_PARAM_STRING:
        cli_json_string(json, key, value->text);
        break;
    case CSGM_PARAM_VECTOR:
        cli_json_open(json, key, '[');
        for (size_t i = 0; i < value->number_count; i++)
            cli_json_number(json, NULL, value->numbers[i]);
        cli_json_end(json, ']');
    }
}

static void put_limit(cli_json *json, const char *key, double limit)
{
    if (!isnan(limit))
        cli_json_number(json, key, limit);
}

static void put_choices(cli_json *json, const csgm_param *param)
{
    cli_json_open(json, "options", '[');
    for (size_t i = 0; i < param->choice_count; i++) {
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "name", param->choices[i].label);
        put_value(json, "value", &param->choices[i].value);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

static void put_param(cli_json *json, const csgm_param *param)
{
    static const char *const types[] = {[CSGM_PARAM_NUMBER] = "number",
                                        [CSGM_PARAM_BOOLEAN] = "boolean",
                                        [CSGM_PARAM_STRING] = "string",
                                        [CSGM_PARAM_VECTOR] = "number"};
    cli_json_open(json, NULL, '{');
    cli_json_string(json, "name", param->name);
    cli_json_string(json, "type", types[param->initial.kind]);
    cli_json_string(json, "group", param->section);
    if (param->description)
        cli_json_string(json, "caption", param->description);
    put_value(json, "initial", &param->initial);
    if (param->is_overridden)
        put_value(json, "value", &param->value);
    put_limit(json, "min", param->minimum);
    put_limit(json, "max", param->maximum);
    put_limit(json, "step", param->step);
    if (param->length_most)
        cli_json_count(json, "maxLength", param->length_most);
    if (param->choice_count)
        put_choices(json, param);
    cli_json_count(json, "line", param->line);
    cli_json_end(json, '}');
}

/* The file's name without folder and extension. */
static void put_title(cli_json *json, const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    char title[256];
    snprintf(title, sizeof title, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name),
             name);
    cli_json_string(json, "title", title);
}

static void put_params(const csgm_params *params, const char *path)
{
    cli_json json = cli_json_make(stdout, false);
    const csgm_param *param;
    cli_json_begin(&json, '{');
    cli_json_break(&json);
    cli_json_string(&json, "fileFormatVersion", "1");
    cli_json_break(&json);
    put_title(&json, path);
    cli_json_break(&json);
    cli_json_open(&json, "parameters", '[');
    for (size_t i = 0; (param = csgm_params_get(params, i)); i++)
        if (strcmp(param->section, "Hidden") != 0) {
            cli_json_break(&json);
            put_param(&json, param);
        }
    cli_json_break(&json);
    cli_json_end(&json, ']');
    cli_json_break(&json);
    cli_json_end(&json, '}');
    putchar('\n');
}

int cli_cmd_params(cli_app *app)
{
    const cli_list *operands = &app->options.operands;
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
