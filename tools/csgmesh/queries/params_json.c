/* SPDX-License-Identifier: MIT
 * The parameters of a scene in the layout that OpenSCAD exports them in.
 */
#include "queries/params_json.h"

#include <math.h>
#include <string.h>

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

void cli_put_params(cli_json *json, const csgm_params *params)
{
    const csgm_param *param;
    cli_json_open(json, "parameters", '[');
    for (size_t i = 0; (param = csgm_params_get(params, i)); i++)
        if (strcmp(param->section, "Hidden") != 0) {
            cli_json_break(json);
            put_param(json, param);
        }
    cli_json_break(json);
    cli_json_end(json, ']');
}
