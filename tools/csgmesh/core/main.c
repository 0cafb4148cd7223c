/* SPDX-License-Identifier: MIT
 * csgmesh, the command line: finds the subcommand, parses its options and runs it. It includes
 * csgmesh.h alone and is the library's first outside customer.
 */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "core/cli.h"
#include "core/interrupt.h"
#include "core/options.h"
#include "core/repeat.h"
#include "core/sandbox.h"
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

/* "did you mean 'check'?", or how to see all; a name that says nothing is near to nothing. */
static const char *hint_for(const char *name, char *hint, size_t size)
{
    const char *names[CLI_COMMAND_COUNT + 1] = {NULL};
    for (int i = 0; i < CLI_COMMAND_COUNT; i++)
        names[i] = commands[i].name;
    const char *near = cli_nearest(name, names);
    snprintf(hint, size, near ? "did you mean '%s'?" : "csgmesh help lists the commands", near);
    return hint;
}

bool cli_command_find(cli_app *app, const char *name, cli_command *out)
{
    char hint[80];
    if (find_command(name, out))
        return true;
    cli_usage_error(app, hint_for(name, hint, sizeof hint), "there is no command '%.80s'", name);
    return false;
}

/* A scene that is not there, or the name of a command with a slip in it? Files have extensions. */
static bool looks_like_command(const char *text)
{
    return *text && !strpbrk(text, "./-") && access(text, F_OK) != 0;
}

static int refuse_unknown(cli_app *app, const char *name)
{
    static const char *const endings[] = {".txt", ".scad"};
    char hint[128], path[96];
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        snprintf(path, sizeof path, "%.70s%s", name, endings[i]);
        if (access(path, F_OK) == 0) {
            snprintf(hint, sizeof hint, "did you mean '%s'?", path);
            return cli_usage_error(app, hint, "there is no command and no file '%.80s'", name);
        }
    }
    return cli_usage_error(app, hint_for(name, hint, sizeof hint),
                           "there is no command and no file '%.80s'", name);
}

static int work(cli_app *app)
{
    int status = CLI_DONE;
    if (app->options->trace) /* it is written whatever the command says */
        status = cli_sources_guard(app);
    if (status == CLI_DONE)
        status = cli_trace_begin(app);
    if (status == CLI_DONE)
        status = commands[app->options->command].run(app);
    if (app->options->summary)
        cli_console_summary(&app->console);
    return cli_trace_end(app, status);
}

static int run_command(cli_app *app, cli_command command, bool is_named, int argc, char **argv)
{
    cli_problem problem;
    if (command == CLI_OPENSCAD) {
        app->arguments = (cli_list){(const char **)argv, (size_t)argc};
        return commands[command].run(app);
    }
    bool parsed = cli_options_parse(app->options, command, argc, argv, &problem);
    cli_console_configure(&app->console, app->options);
    if (!is_named && app->options->operands.count &&
        looks_like_command(app->options->operands.items[0]))
        return refuse_unknown(app, app->options->operands.items[0]);
    if (!parsed)
        return cli_usage_error(app, problem.hint[0] ? problem.hint : NULL, "%s", problem.message);
    if (app->options->version)
        return cli_print_version(app);
    if (app->options->help) {
        if (is_named)
            cli_help_command(command);
        else
            cli_help();
        return cli_finish_stdout(app, CLI_DONE);
    }
    int status = cli_confine(app);
    if (status == CLI_DONE)
        status = app->options->watch ? cli_repeat(app, work) : work(app);
    return status;
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
    int named = find_named(argc, argv, &command);
    if (named > 0) /* the options before it go where those behind it are */
        memmove(argv + 2, argv + 1, (size_t)(named - 1) * sizeof *argv);
    int skipped = 1 + (named > 0);
    return run_command(app, command, named > 0, argc - skipped, argv + skipped);
}

int main(int argc, char **argv)
{
    cli_options options = {.command = CLI_MESH};
    cli_app app = {.options = &options, .start_s = cli_now_s(), .console = cli_console_make()};
    cli_interrupt_install();
    int status = dispatch(&app, argc, argv);
    cli_console_flush(&app.console);
    csgm_context_destroy(app.context);
    cli_options_release(&options);
    return status;
}
