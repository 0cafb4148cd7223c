/* SPDX-License-Identifier: MIT
 * The completions of zsh: sourced, or as a file _csgmesh in $fpath.
 */
#include <stdio.h>
#include <string.h>

#include "core/commands.h"
#include "manual/completion.h"

static const char HEAD[] =
    "#compdef csgmesh\n"
    "# The completions of csgmesh for zsh, made by `csgmesh completion zsh`.\n\n"
    "_csgmesh() {\n"
    "  local command= i at=0\n"
    "  local -a specs commands\n"
    "  for ((i = 2; i < CURRENT; i++)); do\n"
    "    case $words[i] in\n"
    "      (";

static const char AFTER_VALUE_OPTIONS[] = ") ((i++)) ;;\n"
                                          "      (-*) ;;\n"
                                          "      (";

static const char AFTER_COMMANDS[] =
    ") command=$words[i] at=$i; break ;;\n"
    "      (*) command=mesh; break ;;\n"
    "    esac\n"
    "  done\n"
    "  if ((at)); then # the command's name is no operand\n"
    "    words=(\"${(@)words[1,at-1]}\" \"${(@)words[at+1,-1]}\")\n"
    "    ((CURRENT--))\n"
    "  fi\n"
    "  case $command in\n";

static const char TAIL[] = "  esac\n"
                           "  _arguments -s -S $specs\n"
                           "}\n\n"
                           "if [[ $funcstack[1] == _csgmesh ]]; then\n"
                           "  _csgmesh \"$@\"\n"
                           "else\n"
                           "  compdef _csgmesh csgmesh\n"
                           "fi\n";

static const char QUOTE[] = "'\\''";

static bool may_repeat(const cli_option_row *option)
{
    return option->kind &&
           (strcmp(option->kind, "LIST") == 0 || strcmp(option->kind, "POINTS") == 0);
}

/* "[help]:FILE:_files" */
static void put_description(cli_command command, const cli_option_row *option)
{
    char words[WORDS_SIZE];
    cli_taking taking = cli_option_taking(option);
    putchar('[');
    cli_put_brief(command, option, "[]\\:", QUOTE);
    putchar(']');
    if (taking == CLI_TAKES_NOTHING)
        return;
    printf("%s%s:", taking == CLI_MAY_TAKE_VALUE ? "::" : ":",
           option->name ? option->name : "value");
    switch (cli_value_completer(command, option)) {
    case COMPLETE_FILES:
        fputs("_files", stdout);
        break;
    case COMPLETE_FOLDERS:
        fputs("_files -/", stdout);
        break;
    case COMPLETE_WORDS:
        printf("(%s)", cli_value_words(command, option, words, sizeof words));
        break;
    case COMPLETE_NOTHING:
        putchar(' ');
    }
}

static void put_spec(cli_command command, const cli_option_row *option)
{
    cli_taking taking = cli_option_taking(option);
    const char *behind_name = taking == CLI_TAKES_VALUE      ? "="
                              : taking == CLI_MAY_TAKE_VALUE ? "=-"
                                                             : "";
    bool both = option->letter && option->name;
    fputs("        '", stdout);
    if (may_repeat(option))
        putchar('*');
    else if (both)
        printf("(-%c --%s)", option->letter, option->name);
    if (both)
        printf("'{-%c%s,--%s%s}'", option->letter, taking == CLI_TAKES_VALUE ? "+" : "",
               option->name, behind_name);
    else if (option->name)
        printf("--%s%s", option->name, behind_name);
    else
        printf("-%c%s", option->letter, taking == CLI_TAKES_VALUE ? "+" : "");
    put_description(command, option);
    puts("'");
}

/* _files -g "*.(txt|scad)(-.)" goes on with any file where none has the extension. */
static void put_operands(cli_command command)
{
    char words[WORDS_SIZE];
    switch (cli_operand_completer(command)) {
    case COMPLETE_WORDS:
        printf("        '1: :(%s)'\n", cli_operand_words(command, words, sizeof words));
        return;
    case COMPLETE_FILES:
        cli_operand_extensions(command, words, sizeof words);
        if (*words)
            printf("        '*:file:_files -g \"*.(%s)(-.)\"'\n", words);
        else
            puts("        '*:file:_files'");
        return;
    default:
        return;
    }
}

static void put_command(cli_command command)
{
    printf("    (%s%s)\n      specs=(\n", command == CLI_MESH ? "''|" : "",
           cli_command_rows[command].name);
    for (const cli_option_row *row = NULL; (row = cli_next_option(command, row));)
        if (!row->section)
            put_spec(command, row);
    put_operands(command);
    puts("      )");
    if (command == CLI_MESH) { /* no command yet: one of them, or a scene */
        puts("      if [[ -z $command ]]; then\n        commands=(");
        for (int i = 0; i < CLI_COMMAND_COUNT; i++) {
            printf("          '%s:", cli_command_rows[i].name);
            for (const char *c = cli_command_rows[i].summary; *c; c++)
                *c == '\'' ? fputs(QUOTE, stdout) : putchar(*c);
            puts("'");
        }
        puts("        )\n"
             "        [[ $PREFIX == -* ]] || _describe -t commands command commands\n"
             "      fi");
    }
    puts("      ;;");
}

void cli_completion_zsh(void)
{
    fputs(HEAD, stdout);
    cli_put_value_options("|");
    fputs(AFTER_VALUE_OPTIONS, stdout);
    cli_put_commands("|");
    fputs(AFTER_COMMANDS, stdout);
    for (int command = 0; command < CLI_COMMAND_COUNT; command++)
        put_command((cli_command)command);
    fputs(TAIL, stdout);
}
