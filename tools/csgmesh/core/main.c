/* SPDX-License-Identifier: MIT
 * csgmesh, the command line: finds the subcommand, parses its options and runs it. It includes
 * csgmesh.h alone and is the library's first outside customer.
 */
#include <stdio.h>
#include <string.h>

#include "batch/batch_hash.h"
#include "core/cli.h"
#include "core/interrupt.h"
#include "core/roots.h"
#include "core/sources.h"
#include "core/trace.h"

static const struct {
    const char *name;
    int (*run)(cli_app *app);
} commands[] = {
#define COMMAND(NAME, name, operands, summary, examples) {#name, cli_cmd_##name},
#include "core/commands.def"
#undef COMMAND
};

static bool find_command(const char *name, cli_command *command)
{
    for (int i = 0; i < CLI_COMMAND_COUNT; i++) {
        if (strcmp(name, commands[i].name) == 0) {
            *command = (cli_command)i;
            return true;
        }
    }
    return false;
}

int cli_print_version(cli_app *app)
{
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        printf("csgmesh %s (%s)\n%s\n%s\n", csgm_version(), csgm_context_isa(app->context),
               csgm_build_features(), batch_hash_feature());
    return cli_finish_stdout(app, status);
}

static int help(cli_app *app, const char *topic)
{
    cli_command command;
    if (!topic)
        cli_help();
    else if (find_command(topic, &command))
        cli_help_command(command);
    else
        return cli_usage_error(app, NULL, "there is no command '%s'", topic);
    return cli_finish_stdout(app, CLI_DONE);
}

static int run_command(cli_app *app, cli_command command, bool is_named, int argc, char **argv)
{
    cli_problem problem;
    if (command == CLI_OPENSCAD) {
        app->arguments = (cli_list){(const char **)argv, (size_t)argc};
        return commands[command].run(app);
    }
    bool parsed = cli_options_parse(&app->options, command, argc, argv, &problem);
    cli_console_configure(&app->console, &app->options);
    if (!parsed)
        return cli_usage_error(app, problem.hint[0] ? problem.hint : NULL, "%s", problem.message);
    if (app->options.version)
        return cli_print_version(app);
    if (app->options.help)
        return help(app, is_named ? commands[command].name : NULL);
    int status = cli_roots_confine(app);
    if (status == CLI_DONE && app->options.trace) /* it is written whatever the command says */
        status = cli_sources_guard(app);
    if (status == CLI_DONE)
        status = cli_trace_begin(app);
    if (status == CLI_DONE)
        status = commands[command].run(app);
    if (app->options.summary)
        cli_console_summary(&app->console);
    return cli_trace_end(app, status);
}

/* Where the command's name stands: the first argument that is neither an option nor the value of
 * one. 0: there is none, it is a scene to be meshed. */
static int find_named(int argc, char **argv, cli_command *command)
{
    int operand = cli_options_first_operand(argc, argv);
    return operand < argc && find_command(argv[operand], command) ? operand : 0;
}

static int dispatch(cli_app *app, int argc, char **argv)
{
    cli_command command = CLI_MESH;
    if (argc < 2) {
        cli_help();
        cli_finish_stdout(app, CLI_DONE);
        return CLI_TROUBLE;
    }
    int operand = cli_options_first_operand(argc, argv);
    if (operand < argc && strcmp(argv[operand], "help") == 0)
        return help(app, operand + 1 < argc ? argv[operand + 1] : NULL);
    int named = find_named(argc, argv, &command);
    if (named > 0) /* the options before it go where those behind it are */
        memmove(argv + 2, argv + 1, (size_t)(named - 1) * sizeof *argv);
    int skipped = 1 + (named > 0);
    return run_command(app, command, named > 0, argc - skipped, argv + skipped);
}

int main(int argc, char **argv)
{
    cli_app app = {.start_s = cli_now_s(), .console = cli_console_make()};
    cli_interrupt_install();
    int status = dispatch(&app, argc, argv);
    cli_console_flush(&app.console);
    csgm_context_destroy(app.context);
    cli_options_release(&app.options);
    return status;
}
