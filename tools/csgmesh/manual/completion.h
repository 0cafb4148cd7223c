/* SPDX-License-Identifier: MIT
 * What the completions of the three shells share: of options and operands, what completes them.
 */
#ifndef CLI_MANUAL_COMPLETION_H
#define CLI_MANUAL_COMPLETION_H

#include "manual/rows.h"

/* What a value, or an operand, is completed by. */
typedef enum completer {
    COMPLETE_NOTHING,
    COMPLETE_FILES,
    COMPLETE_FOLDERS,
    COMPLETE_WORDS /* of completer_words */
} completer;

enum { WORDS_SIZE = 320 };

completer cli_value_completer(cli_command command, const cli_option_row *option);
/* The words of a value or of operands that are completed so, with blanks between. Returns the
 * buffer. */
const char *cli_value_words(cli_command command, const cli_option_row *option, char *buffer,
                            size_t size);
completer cli_operand_completer(cli_command command);
const char *cli_operand_words(cli_command command, char *buffer, size_t size);
/* The extensions of files that are operands, with '|' between; "": any. */
const char *cli_operand_extensions(cli_command command, char *buffer, size_t size);

/* "mesh|render|..." with `between` between. */
void cli_put_commands(const char *between);
/* "-o|--output|...": those that are followed by a value, whatever the command (but openscad's). */
void cli_put_value_options(const char *between);
/* The beginning of the help, `escaped` characters behind a backslash, a ' as shells want it there.
 */
void cli_put_brief(cli_command command, const cli_option_row *option, const char *escaped,
                   const char *quote);

void cli_completion_bash(void);
void cli_completion_zsh(void);
void cli_completion_fish(void);

#endif
