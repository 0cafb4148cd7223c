/* SPDX-License-Identifier: MIT
 * The completions of bash, from 3.2 on and without the package bash-completion.
 */
#include <stdio.h>

#include "core/commands.h"
#include "manual/completion.h"

static const char HEAD[] =
    "# The completions of csgmesh for bash, made by `csgmesh completion bash`.\n\n"
    "# Files with one of the extensions \"a|b\", and folders; any file where there is none or no\n"
    "# extension was given.\n"
    "_csgmesh_files() {\n"
    "    local name\n"
    "    local -a others=()\n"
    "    compopt -o filenames 2>/dev/null\n"
    "    while IFS= read -r name; do\n"
    "        if [[ -z $1 || -d $name || \"|$1|\" == *\"|${name##*.}|\"* ]]; then\n"
    "            COMPREPLY+=(\"$name\")\n"
    "        else\n"
    "            others+=(\"$name\")\n"
    "        fi\n"
    "    done < <(compgen -f -- \"$cur\")\n"
    "    [[ ${#COMPREPLY[@]} -gt 0 ]] || COMPREPLY=(${others[@]+\"${others[@]}\"})\n"
    "}\n\n"
    "_csgmesh_folders() {\n"
    "    local name\n"
    "    compopt -o filenames 2>/dev/null\n"
    "    while IFS= read -r name; do COMPREPLY+=(\"$name\"); done < <(compgen -d -- \"$cur\")\n"
    "}\n\n"
    "_csgmesh_words() {\n"
    "    local word\n"
    "    while IFS= read -r word; do COMPREPLY+=(\"$word\"); done < <(compgen -W \"$1\" -- "
    "\"$cur\")\n"
    "}\n\n"
    "_csgmesh() {\n"
    "    local cur=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]} command= i\n"
    "    local equals=\n"
    "    COMPREPLY=()\n"
    "    # --option=value comes as three words\n"
    "    if [[ $cur == = ]]; then\n"
    "        cur= equals=1\n"
    "    elif [[ $option == = && $COMP_CWORD -gt 1 ]]; then\n"
    "        option=${COMP_WORDS[COMP_CWORD - 2]} equals=1\n"
    "    fi\n"
    "    for ((i = 1; i < COMP_CWORD; i++)); do\n"
    "        case ${COMP_WORDS[i]} in\n"
    "        ";

static const char AFTER_VALUE_OPTIONS[] =
    ")\n"
    "            ((i++))\n"
    "            [[ ${COMP_WORDS[i]} != = ]] || ((i++)) ;;\n"
    "        =) ((i++)) ;; # of an option that may have a value\n"
    "        -*) ;;\n"
    "        ";

static const char AFTER_COMMANDS[] = ")\n"
                                     "            command=${COMP_WORDS[i]}\n"
                                     "            break ;;\n"
                                     "        *)\n"
                                     "            command=mesh\n"
                                     "            break ;;\n"
                                     "        esac\n"
                                     "    done\n"
                                     "    case $command in\n";

/* How an option is written: -o|--output. */
static void put_forms(const cli_option_row *option, const char *between)
{
    if (option->letter)
        printf("-%c", option->letter);
    if (option->letter && option->name)
        fputs(between, stdout);
    if (option->name)
        printf("--%s", option->name);
}

static void put_value_case(cli_command command, const cli_option_row *option)
{
    char words[WORDS_SIZE];
    bool may = cli_option_taking(option) == CLI_MAY_TAKE_VALUE;
    fputs("        ", stdout);
    put_forms(option, "|");
    printf(") %s", may ? "[[ -z $equals ]] || { " : "");
    switch (cli_value_completer(command, option)) {
    case COMPLETE_FILES:
        fputs("_csgmesh_files ''; return", stdout);
        break;
    case COMPLETE_FOLDERS:
        fputs("_csgmesh_folders; return", stdout);
        break;
    case COMPLETE_WORDS:
        printf("_csgmesh_words '%s'; return",
               cli_value_words(command, option, words, sizeof words));
        break;
    case COMPLETE_NOTHING:
        fputs("return", stdout);
    }
    printf("%s ;;\n", may ? "; }" : "");
}

static void put_operands(cli_command command)
{
    char words[WORDS_SIZE];
    switch (cli_operand_completer(command)) {
    case COMPLETE_WORDS:
        printf("        _csgmesh_words '%s' ;;\n", cli_operand_words(command, words, sizeof words));
        return;
    case COMPLETE_FILES:
        printf("        _csgmesh_files '%s' ;;\n",
               cli_operand_extensions(command, words, sizeof words));
        return;
    default:
        puts("        ;;");
    }
}

static void put_command(cli_command command)
{
    printf("    %s%s)\n        case $option in\n", command == CLI_MESH ? "''|" : "",
           cli_command_rows[command].name);
    for (const cli_option_row *row = NULL; (row = cli_next_option(command, row));)
        if (!row->section && cli_option_taking(row) != CLI_TAKES_NOTHING)
            put_value_case(command, row);
    fputs("        esac\n        if [[ $cur == -* ]]; then\n            _csgmesh_words '", stdout);
    const char *separator = "";
    for (const cli_option_row *row = NULL; (row = cli_next_option(command, row));)
        if (!row->section) {
            fputs(separator, stdout);
            put_forms(row, " ");
            separator = " ";
        }
    fputs("'\n            return\n        fi\n", stdout);
    if (command == CLI_MESH) { /* no command yet: one of them, or a scene */
        fputs("        [[ -n $command ]] || _csgmesh_words '", stdout);
        cli_put_commands(" ");
        puts("'");
        puts("        [[ -n ${COMPREPLY[0]-} && -n $cur ]] && return");
        char extensions[WORDS_SIZE];
        printf("        local -a names=(${COMPREPLY[@]+\"${COMPREPLY[@]}\"})\n"
               "        COMPREPLY=()\n"
               "        _csgmesh_files '%s'\n"
               "        COMPREPLY+=(${names[@]+\"${names[@]}\"}) ;;\n",
               cli_operand_extensions(command, extensions, sizeof extensions));
        return;
    }
    put_operands(command);
}

void cli_completion_bash(void)
{
    fputs(HEAD, stdout);
    cli_put_value_options("|");
    fputs(AFTER_VALUE_OPTIONS, stdout);
    cli_put_commands("|");
    fputs(AFTER_COMMANDS, stdout);
    for (int command = 0; command < CLI_COMMAND_COUNT; command++)
        put_command((cli_command)command);
    fputs("    esac\n}\n\ncomplete -F _csgmesh csgmesh\n", stdout);
}
