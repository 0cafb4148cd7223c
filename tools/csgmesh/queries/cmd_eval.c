/* SPDX-License-Identifier: MIT
 * csgmesh eval SCENE --at X,Y,Z...: the field at points, by the double precision reference.
 */
#include <inttypes.h>
#include <stdio.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/json.h"
#include "core/options.h"

typedef struct field_sample {
    csgm_vec3 at, gradient;
    double value, lambda;
    uint32_t primitives;
} field_sample;

static void print_json(const field_sample *sample)
{
    cli_json json = cli_json_make(stdout, false);
    cli_json_begin(&json, '{');
    cli_json_vec3(&json, "at", sample->at);
    cli_json_number(&json, "f", sample->value);
    cli_json_vec3(&json, "gradient", sample->gradient);
    cli_json_number(&json, "lambda", sample->lambda);
    cli_json_count(&json, "primitives", sample->primitives);
    cli_json_end(&json, '}');
    putchar('\n');
}

static void print_text(const field_sample *sample)
{
    char value[32];
    cli_format_double(value, sizeof value, sample->value);
    printf("at %.9g,%.9g,%.9g: f = %s (%s)\n", sample->at.x, sample->at.y, sample->at.z, value,
           sample->value > 0   ? "inside"
           : sample->value < 0 ? "outside"
                               : "on the surface");
    printf("  gradient    %.12g,%.12g,%.12g\n", sample->gradient.x + 0.0, sample->gradient.y + 0.0,
           sample->gradient.z + 0.0);
    printf("  lambda      %.9g\n", sample->lambda);
    printf("  primitives  %" PRIu32 " active here\n", sample->primitives);
}

static void eval_points(const cli_options *options, const csgm_scene *scene)
{
    for (size_t i = 0; i < options->points.count; i++) {
        field_sample sample = {.at = options->points.items[i]};
        sample.value = csgm_scene_eval(scene, sample.at, &sample.gradient);
        sample.primitives = csgm_scene_active_primitives(scene, sample.at);
        sample.lambda = csgm_scene_get_info(scene).lipschitz;
        (options->json ? print_json : print_text)(&sample);
    }
}

int cli_cmd_eval(cli_app *app)
{
    const cli_options *options = app->options;
    if (options->operands.count != 1)
        return cli_usage_error(app, "as csgmesh eval mug.txt --at 0,0,10",
                               options->operands.count ? "one scene at a time" : "no scene given");
    if (!options->points.count)
        return cli_usage_error(app, "add --at X,Y,Z", "no point given");
    csgm_scene *scene = NULL;
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_exit_status(cli_app_load(app, options->operands.items[0], &scene));
    if (status == CLI_DONE)
        eval_points(options, scene);
    csgm_scene_destroy(scene);
    return cli_finish_stdout(app, status);
}
