/* SPDX-License-Identifier: MIT
 * What --png and --html want while a pair is compared; see diff_report.h.
 */
#include "diff/diff_report.h"

#include <stdlib.h>
#include <string.h>

#include "core/options.h"
#include "diff/diff_folders.h"
#include "render/picture_options.h"

/* The pair of the command line, not one of two folders. */
static bool is_alone(const cli_app *app, const diff_result *result)
{
    return result->a && strcmp(result->a, app->options->operands.items[0]) == 0;
}

static int check_png(cli_app *app)
{
    const char *path = app->options->diff_png;
    if (diff_is_folder(app->options->operands.items[0]))
        return cli_usage_error(app, "--html shows all pairs on one page",
                               "--png wants two files, not folders");
    return cli_picture_check(app, path);
}

int diff_report_check(cli_app *app)
{
    const cli_options *o = app->options;
    csgm_camera camera = {.azimuth_deg = 0};
    if (o->view && !o->diff_png && !o->diff_html)
        return cli_usage_error(app, NULL, "--view needs --png or --html");
    if (cli_picture_view(app, &camera) != CLI_DONE)
        return CLI_TROUBLE;
    return o->diff_png ? check_png(app) : CLI_DONE;
}

bool diff_report_draws(const cli_app *app, const diff_result *result)
{
    const cli_options *o = app->options;
    return o->diff_png || (o->diff_html && is_alone(app, result));
}

void diff_report_begin(diff_results *results, size_t index)
{
    results->items[index].page_room = index ? results->items[index - 1].page_room : DIFF_PAGE_MOST;
}

int diff_report_add(cli_app *app, const csgm_diff *diff, const diff_side sides[2],
                    diff_result *result)
{
    const cli_options *o = app->options;
    bool is_shown = o->diff_html && (result->outcome == DIFF_DIFFERENT || is_alone(app, result));
    diff_drawing drawing;
    int status = CLI_DONE;
    if (!is_shown && !o->diff_png)
        return CLI_DONE;
    if (!diff_drawing_make(app, diff, sides, &drawing))
        return CLI_TROUBLE;
    if (o->diff_png)
        status = diff_write_picture(app, &drawing, result, o->diff_png);
    if (is_shown) {
        result->models = diff_models_text(&drawing, &result->page_room);
        if (!result->models) {
            cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
            status = CLI_TROUBLE;
        }
    }
    diff_drawing_release(&drawing);
    return status;
}
