/* SPDX-License-Identifier: MIT
 * The command line as a struct. options.def and commands.def are the lists; a field's type follows
 * from its kind.
 */
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include "core/commands.h"
#include "core/option_kinds.h"

typedef enum cli_option_id {
#define SECTION(title)
#define OPTION(field, letter, name, kind, argument, commands, help) CLI_OPTION_##field,
#include "core/options.def"
#undef OPTION
    CLI_OPTION_COUNT
} cli_option_id;

typedef struct cli_options {
#define OPTION(field, letter, name, kind, argument, commands, help) cli_kind_##kind field;
#include "core/options.def"
#undef OPTION
#undef SECTION
    cli_command command;
    cli_list operands;
    bool given[CLI_OPTION_COUNT];
    const char *texts[CLI_OPTION_COUNT]; /* values as they were given, the last; NULL of a FLAG */
} cli_options;

/* What was wrong with the command line, for one line on stderr. */
typedef struct cli_problem {
    char message[320];
    char hint[320]; /* "" = none */
} cli_problem;

/* argv[1...]; the command is already known. On false *problem says why. The options own their lists
 * either way. */
bool cli_options_parse(cli_options *options, cli_command command, int argc, char **argv,
                       cli_problem *problem);
/* The index of the first argument that is neither an option nor an option's value; argc: none. What
 * is wrong with the options is not told here. */
int cli_options_first_operand(int argc, char **argv);
/* The next option that was given and that another command does not take; *at: 0 for the first.
 * false: there is none. */
bool cli_options_unfit(const cli_options *options, cli_command as, size_t *at, char *label,
                       size_t size);
void cli_options_release(cli_options *options);

#endif
