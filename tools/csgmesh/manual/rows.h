/* SPDX-License-Identifier: MIT
 * commands.def, options.def and openscad_options.def as rows of text: what help, pages of the
 * manual and completions are made from.
 */
#ifndef CLI_MANUAL_ROWS_H
#define CLI_MANUAL_ROWS_H

#include "core/options.h"

typedef struct cli_command_row {
    const char *name, *operands, *summary, *examples;
} cli_command_row;

typedef struct cli_option_row {
    const char *section;     /* of a SECTION row, else NULL */
    const char *name, *kind; /* NULL: it has a letter only; a row of OpenSCAD's command line */
    const char *argument, *help;
    cli_option_id id;
    char letter;
    int commands;     /* as in command_bits.h */
    bool is_help_for; /* a HELP_FOR row: id, commands and help alone */
} cli_option_row;

typedef enum cli_taking { CLI_TAKES_NOTHING, CLI_TAKES_VALUE, CLI_MAY_TAKE_VALUE } cli_taking;

extern const cli_command_row cli_command_rows[CLI_COMMAND_COUNT];
/* The rows of a command, one after the other from row = NULL on: those of its options, and before
 * them the sections that have any. NULL: no more. */
const cli_option_row *cli_next_option(cli_command command, const cli_option_row *row);
/* What this command says of it. */
const char *cli_option_text(cli_command command, const cli_option_row *row);
/* Does a value follow? One that may be there stands behind a '='. */
cli_taking cli_option_taking(const cli_option_row *row);
/* "", " FILE" or "[=FILE]". Returns the buffer. */
const char *cli_option_value(const cli_option_row *row, char *buffer, size_t size);

#endif
