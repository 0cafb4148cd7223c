/* SPDX-License-Identifier: MIT
 * csgmesh, the command line: finds the subcommand, parses its options and runs it. It includes
 * csgmesh.h alone and is the library's first outside customer.
 */
#include <stdio.h>
#include <string.h>

#include "cli.h"
#include "interrupt.h"

static const struct {
    const char *name;
    int (*run)(cli_app *app);
} commands[] = {
#define COMMAND(NAME, name, operands, summary, examples) {#name, cli_cmd_##name},
#define LATER_COMMAND(name)
#include "commands.def"
#undef COMMAND
#undef LATER_COMMAND
};

static const char *const later_commands[] = {
#define COMMAND(NAME, name, operands, summary, examples)
#define LATER_COMMAND(name) name,
#include "commands.def"
#undef COMMAND
#undef LATER_COMMAND
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

static bool is_later_command(const char *name)
{
    for (size_t i = 0; i < sizeof later_commands / sizeof *later_commands; i++)
        if (strcmp(name, later_commands[i]) == 0)
            return true;
    return false;
}

static int print_version(cli_app *app)
{
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        printf("csgmesh %s (%s)\n%s\n", csgm_version(), csgm_context_isa(app->context),
               csgm_build_features());
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
        return cli_usage_error(app, NULL,
                               is_later_command(topic) ? "'%s' is not available in this version"
                                                       : "there is no command '%s'",
                               topic);
    return cli_finish_stdout(app, CLI_DONE);
}

static int run_command(cli_app *app, cli_command command, bool is_named, int argc, char **argv)
{
    cli_problem problem;
    bool parsed = cli_options_parse(&app->options, command, argc, argv, &problem);
    cli_console_configure(&app->console, &app->options);
    if (!parsed)
        return cli_usage_error(app, problem.hint[0] ? problem.hint : NULL, "%s", problem.message);
    if (app->options.version)
        return print_version(app);
    if (app->options.help)
        return help(app, is_named ? commands[command].name : NULL);
    return commands[command].run(app);
}

static int run(cli_app *app, int argc, char **argv)
{
    cli_command command = CLI_MESH;
    const char *first = argc > 1 ? argv[1] : NULL;
    if (!first) {
        cli_help();
        cli_finish_stdout(app, CLI_DONE);
        return CLI_TROUBLE;
    }
    if (strcmp(first, "help") == 0)
        return help(app, argc > 2 ? argv[2] : NULL);
    if (is_later_command(first))
        return cli_usage_error(app, NULL, "'%s' is not available in this version", first);
    bool is_named = find_command(first, &command);
    return run_command(app, command, is_named, argc - 1 - is_named, argv + 1 + is_named);
}

int main(int argc, char **argv)
{
    cli_app app = {.start_s = cli_now_s(), .console = cli_console_make()};
    cli_interrupt_install();
    int status = run(&app, argc, argv);
    csgm_context_destroy(app.context);
    cli_options_release(&app.options);
    return status;
}
