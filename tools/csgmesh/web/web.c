/* SPDX-License-Identifier: MIT
 * The program as WebAssembly (tools/web): what a page's worker calls. It has put the scene and what
 * that includes into the module's file system, and takes written files from there.
 *
 * A request is a command line of `csgmesh mesh`, its arguments ended by a NUL each, in memory of
 * web_allocate() that the call takes. One is under way at a time. What the calls return lives until
 * the next call.
 */
#include <stdlib.h>
#include <string.h>

#include "core/cli.h"
#include "core/options.h"
#include "view/view_job.h"

#define EXPORT(name) __attribute__((export_name(#name))) name

typedef struct request {
    char *text; /* the arguments, one after the other */
    char **items;
    int count;
} request;

static view_job shown;
static cli_options shown_options;
static request shown_request;
static bool is_shown; /* there is one */
static char *answer, *model;
static size_t model_length;

/* ---- requests --------------------------------------------------------------------------------- */

static bool split(request *r, char *text, size_t length)
{
    *r = (request){.text = text};
    for (size_t i = 0; i < length; i++)
        r->count += text[i] == '\0';
    r->items = calloc((size_t)r->count + 1, sizeof *r->items);
    for (int i = 0; r->items && i < r->count; i++, text += strlen(text) + 1)
        r->items[i] = text;
    return r->items != NULL;
}

static void release(request *r)
{
    free(r->items);
    free(r->text);
    *r = (request){.text = NULL};
}

/* Options of `csgmesh mesh`. false: they are wrong, which is among the findings. */
static bool parse(cli_app *app, const request *r)
{
    cli_problem problem;
    if (cli_options_parse(app->options, CLI_MESH, r->count, r->items, &problem))
        return true;
    cli_usage_error(app, problem.hint[0] ? problem.hint : NULL, "%s", problem.message);
    return false;
}

static const char *answer_with(char *text)
{
    free(answer);
    answer = text;
    return answer ? answer : "";
}

static void end_shown(void)
{
    if (is_shown) {
        view_job_release(&shown);
        cli_options_release(shown.app.options);
        release(&shown_request);
    }
    is_shown = false;
}

/* ---- what the worker calls -------------------------------------------------------------------- */

void *web_allocate(size_t bytes);
int web_begin(char *text, size_t length);
int web_mesh(bool coarsely);
const void *web_model(void);
size_t web_model_length(void);
const char *web_state(char *phase);
int web_write(char *text, size_t length);
const char *web_answer(void);
const char *web_about(void);

void *EXPORT(web_allocate)(size_t bytes)
{
    return malloc(bytes);
}

/* Reads the scene and its parameters; an exit status of csgmesh, which web_state has the reasons
 * of. */
int EXPORT(web_begin)(char *text, size_t length)
{
    end_shown();
    shown_options = (cli_options){.command = CLI_MESH};
    shown = (view_job){.app = {.options = &shown_options, .start_s = cli_now_s()}};
    is_shown = true;
    if (!split(&shown_request, text, length) || !view_job_begin(&shown))
        return CLI_TROUBLE;
    if (!parse(&shown.app, &shown_request))
        return CLI_TROUBLE;
    int status = view_job_read(&shown);
    view_job_read_parameters(&shown);
    return status;
}

/* Of the scene that was read. web_model has it then. */
int EXPORT(web_mesh)(bool coarsely)
{
    int status = CLI_DONE;
    view_job_drop_mesh(&shown);
    if (coarsely)
        status = view_job_mesh_coarsely(&shown) ? CLI_DONE : CLI_TROUBLE;
    else
        status = cli_work_mesh(&shown.app, &shown.work);
    if (status == CLI_DONE && !coarsely)
        view_job_mesh_marks(&shown);
    free(model);
    model = status == CLI_DONE ? view_job_model(&shown, &model_length) : NULL;
    return status == CLI_DONE && !model ? CLI_TROUBLE : status;
}

const void *EXPORT(web_model)(void)
{
    return model;
}

size_t EXPORT(web_model_length)(void)
{
    return model ? model_length : 0;
}

/* Members of a JSON object, as of view_job_state; phase is memory of web_allocate. */
const char *EXPORT(web_state)(char *phase)
{
    const char *state = answer_with(view_job_state(&shown, phase, 0));
    free(phase);
    return state;
}

/* The whole of `csgmesh mesh`, output files and all; web_answer has what it says, a JSON object a
 * line. */
int EXPORT(web_write)(char *text, size_t length)
{
    cli_options options = {.command = CLI_MESH};
    cli_app app = {.options = &options, .start_s = cli_now_s(), .console = cli_console_make()};
    cli_text said;
    request wanted;
    int status = CLI_TROUBLE;
    if (!cli_text_open(&said))
        return status;
    if (split(&wanted, text, length)) {
        app.console.json = true;
        app.console.out = said.out;
        if (parse(&app, &wanted))
            status = cli_cmd_mesh(&app);
        cli_console_flush(&app.console);
        csgm_context_destroy(app.context);
        cli_options_release(&options);
    }
    release(&wanted);
    answer_with(cli_text_close(&said));
    return status;
}

const char *EXPORT(web_answer)(void)
{
    return answer ? answer : "";
}

/* JSON: the version, what the build has and lacks. */
const char *EXPORT(web_about)(void)
{
    cli_text text;
    if (!cli_text_open(&text))
        return "";
    cli_json json = cli_json_make(text.out, false);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "version", csgm_version());
    cli_json_string(&json, "features", csgm_build_features());
    cli_json_end(&json, '}');
    return answer_with(cli_text_close(&text));
}
