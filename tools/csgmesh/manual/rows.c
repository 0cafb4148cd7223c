/* SPDX-License-Identifier: MIT
 * The tables as rows; see rows.h.
 */
#include "manual/rows.h"

#include <stdio.h>
#include <string.h>

#include "core/command_bits.h"
#include "core/commands.h"

const cli_command_row cli_command_rows[CLI_COMMAND_COUNT] = {
#define COMMAND(NAME, name, operands, summary, examples) {#name, operands, summary, examples},
#include "core/commands.def"
#undef COMMAND
};

/* Of OpenSCAD's names some are letters again: --o. */
static const cli_option_row rows[] = {
#define SECTION(title) {.section = title},
#define OPTION(field, letter_, name_, kind_, argument_, commands_, help_)                          \
    {NULL, name_, #kind_, argument_, help_, CLI_OPTION_##field, letter_, commands_, false},
#define HELP_FOR(field, commands_, help_)                                                          \
    {.help = help_, .id = CLI_OPTION_##field, .commands = commands_, .is_help_for = true},
#include "core/options.def"
#undef SECTION
#undef OPTION
    {.section = "Options"},
#define OPENSCAD_OPTION(NAME, letter_, name_, argument_, help_)                                    \
    {.name = sizeof(name_) > 2 ? (name_) : NULL,                                                   \
     .argument = argument_,                                                                        \
     .help = help_,                                                                                \
     .id = CLI_OPTION_COUNT,                                                                       \
     .letter = letter_,                                                                            \
     .commands = OPENSCAD},
#define OPENSCAD_REFUSED(NAME, letter, name, argument, why)
#include "openscad/openscad_options.def"
#undef OPENSCAD_OPTION
#undef OPENSCAD_REFUSED
};

static const cli_option_row *const end = rows + sizeof rows / sizeof *rows;

static bool section_has_any(const cli_option_row *section, int command_bit)
{
    for (const cli_option_row *row = section + 1; row < end && !row->section; row++)
        if (row->commands & command_bit)
            return true;
    return false;
}

const cli_option_row *cli_next_option(cli_command command, const cli_option_row *row)
{
    int bit = 1 << command;
    for (row = row ? row + 1 : rows; row < end; row++)
        if (row->section ? section_has_any(row, bit) : row->commands & bit && !row->is_help_for)
            return row;
    return NULL;
}

const char *cli_option_text(cli_command command, const cli_option_row *row)
{
    for (const cli_option_row *other = rows; other < end; other++)
        if (other->is_help_for && other->id == row->id && other->commands & 1 << command)
            return other->help;
    return row->help;
}

cli_taking cli_option_taking(const cli_option_row *row)
{
    if (!row->argument)
        return CLI_TAKES_NOTHING;
    bool may = row->kind ? strcmp(row->kind, "REPORT") == 0 : *row->argument == '[';
    return may ? CLI_MAY_TAKE_VALUE : CLI_TAKES_VALUE;
}

const char *cli_option_value(const cli_option_row *row, char *buffer, size_t size)
{
    switch (cli_option_taking(row)) {
    case CLI_TAKES_NOTHING:
        *buffer = '\0';
        break;
    case CLI_TAKES_VALUE:
        snprintf(buffer, size, " %s", row->argument);
        break;
    case CLI_MAY_TAKE_VALUE: /* OpenSCAD's rows have the brackets */
        snprintf(buffer, size, row->kind ? "[=%s]" : "%s", row->argument);
    }
    return buffer;
}
