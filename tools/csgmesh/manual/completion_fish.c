/* SPDX-License-Identifier: MIT
 * The completions of fish, from 3.0 on.
 */
#include <stdio.h>

#include "core/commands.h"
#include "manual/completion.h"

static const char HEAD[] =
    "# The completions of csgmesh for fish, made by `csgmesh completion fish`.\n\n"
    "# The command of the line so far; nothing where there is none yet.\n"
    "function __csgmesh_command\n"
    "    set -l words (commandline -opc)\n"
    "    set -e words[1]\n"
    "    set -l is_value 0\n"
    "    for word in $words\n"
    "        if test $is_value = 1\n"
    "            set is_value 0\n"
    "            continue\n"
    "        end\n"
    "        switch $word\n"
    "            case ";

static const char AFTER_VALUE_OPTIONS[] = "\n"
                                          "                set is_value 1\n"
                                          "            case '-*'\n"
                                          "            case ";

static const char AFTER_COMMANDS[] = "\n"
                                     "                echo $word\n"
                                     "                return\n"
                                     "            case '*'\n"
                                     "                echo mesh\n"
                                     "                return\n"
                                     "        end\n"
                                     "    end\n"
                                     "    echo none\n"
                                     "end\n\n"
                                     "function __csgmesh_is\n"
                                     "    contains -- (__csgmesh_command) $argv\n"
                                     "end\n\n";

static void put_condition(cli_command command)
{
    printf("complete -c csgmesh -n '__csgmesh_is %s%s'", command == CLI_MESH ? "none " : "",
           cli_command_rows[command].name);
}

static void put_option(cli_command command, const cli_option_row *option)
{
    char words[WORDS_SIZE];
    put_condition(command);
    if (option->letter)
        printf(" -s %c", option->letter);
    if (option->name)
        printf(" -l %s", option->name);
    if (cli_option_taking(option) == CLI_TAKES_VALUE)
        switch (cli_value_completer(command, option)) {
        case COMPLETE_FILES:
            fputs(" -r -F", stdout);
            break;
        case COMPLETE_FOLDERS:
            fputs(" -x -a '(__fish_complete_directories)'", stdout);
            break;
        case COMPLETE_WORDS:
            printf(" -x -a '%s'", cli_value_words(command, option, words, sizeof words));
            break;
        case COMPLETE_NOTHING:
            fputs(" -x", stdout);
        }
    fputs(" -d '", stdout);
    cli_put_brief(command, option, "\\", "\\'");
    puts("'");
}

static void put_operands(cli_command command)
{
    char words[WORDS_SIZE];
    if (cli_operand_completer(command) == COMPLETE_FILES)
        return; /* as it is without a word */
    put_condition(command);
    puts(" -f");
    if (cli_operand_completer(command) != COMPLETE_WORDS)
        return;
    put_condition(command);
    printf(" -a '%s'\n", cli_operand_words(command, words, sizeof words));
}

void cli_completion_fish(void)
{
    fputs(HEAD, stdout);
    cli_put_value_options(" ");
    fputs(AFTER_VALUE_OPTIONS, stdout);
    cli_put_commands(" ");
    fputs(AFTER_COMMANDS, stdout);
    for (int i = 0; i < CLI_COMMAND_COUNT; i++) {
        printf("complete -c csgmesh -n '__csgmesh_is none' -a %s -d '", cli_command_rows[i].name);
        for (const char *c = cli_command_rows[i].summary; *c; c++)
            *c == '\'' ? fputs("\\'", stdout) : putchar(*c);
        puts("'");
    }
    for (int command = 0; command < CLI_COMMAND_COUNT; command++) {
        for (const cli_option_row *row = NULL; (row = cli_next_option((cli_command)command, row));)
            if (!row->section)
                put_option((cli_command)command, row);
        put_operands((cli_command)command);
    }
}
