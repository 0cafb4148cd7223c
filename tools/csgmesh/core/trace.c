/* SPDX-License-Identifier: MIT
 * The trace of a run; see trace.h.
 */
#include "core/trace.h"

#include <string.h>

#include "core/options.h"
#include "core/textfile.h"
#include "mesh/outputs.h"

int cli_trace_begin(cli_app *app)
{
    const char *path = app->options->trace;
    if (!path)
        return CLI_DONE;
    if (cli_outputs_check_place(app, path) != CLI_DONE)
        return CLI_TROUBLE;
    if (csgm_trace_create(NULL, 0, &app->trace) == CSGM_OK)
        return CLI_DONE;
    cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    return CLI_TROUBLE;
}

void cli_trace_open(cli_app *app)
{
    static const char *const names[] = {
#define COMMAND(NAME, name, operands, summary, examples) #name,
#include "core/commands.def"
#undef COMMAND
    };
    const cli_list *operands = &app->options->operands;
    if (app->zone_note)
        csgm_trace_begin(app->context, "job", app->zone_note);
    else
        csgm_trace_begin(app->context, names[app->options->command],
                         operands->count ? operands->items[0] : NULL);
}

static void print_to_file(void *user, const char *text, size_t length)
{
    fwrite(text, 1, length, user);
}

static int write_trace(cli_app *app)
{
    cli_text text;
    uint64_t dropped = csgm_trace_dropped(app->trace);
    if (cli_text_open(&text))
        csgm_trace_print(app->trace, print_to_file, text.out);
    if (dropped)
        cli_console_say(&app->console, CSGM_WARNING, NULL,
                        "%llu zones found no room and are not in %s", (unsigned long long)dropped,
                        app->options->trace);
    return cli_text_write(app, &text, app->options->trace);
}

int cli_trace_end(cli_app *app, int status)
{
    if (!app->trace)
        return status;
    csgm_context_destroy(app->context); /* its zones end */
    app->context = NULL;
    int written = app->overwriter ? status : write_trace(app);
    csgm_trace_destroy(app->trace);
    app->trace = NULL;
    return written > status ? written : status;
}
