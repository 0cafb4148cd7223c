/* SPDX-License-Identifier: MIT
 * The subcommands of commands.def.
 */
#ifndef CLI_COMMANDS_H
#define CLI_COMMANDS_H

#include <stdbool.h>

typedef struct cli_app cli_app;

typedef enum cli_command {
#define COMMAND(NAME, name, operands, summary, examples) CLI_##NAME,
#include "core/commands.def"
#undef COMMAND
    CLI_COMMAND_COUNT
} cli_command;

void cli_help_command(cli_command command);

/* The command of this name. false: there is none, which is reported with the nearest one as a hint.
 */
bool cli_command_find(cli_app *app, const char *name, cli_command *out);
/* The operand of `help` and `man`, which may be left out. false: it is no command (reported). */
bool cli_read_topic(cli_app *app, bool *is_given, cli_command *topic);

#define COMMAND(NAME, name, operands, summary, examples) int cli_cmd_##name(cli_app *app);
#include "core/commands.def"
#undef COMMAND

#endif
