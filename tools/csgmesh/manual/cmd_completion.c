/* SPDX-License-Identifier: MIT
 * csgmesh completion SHELL: the script by which a shell completes command lines, made from the
 * tables.
 */
#include <stdio.h>
#include <string.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/format_lists.h"
#include "core/options.h"
#include "manual/completion.h"

static const char SCENES[] = "txt|scad|csg";

/* ---- values and operands ------------------------------------------------------------- */

completer cli_value_completer(cli_command command, const cli_option_row *option)
{
    if (cli_option_taking(option) == CLI_TAKES_NOTHING)
        return COMPLETE_NOTHING;
    if (strcmp(option->argument, "FILE") == 0)
        return COMPLETE_FILES;
    if (strcmp(option->argument, "DIR") == 0)
        return COMPLETE_FOLDERS;
    char words[WORDS_SIZE];
    return *cli_value_words(command, option, words, sizeof words) ? COMPLETE_WORDS
                                                                  : COMPLETE_NOTHING;
}

static void replace(char *text, char from, char to)
{
    for (; *text; text++)
        if (*text == from)
            *text = to;
}

static void put_formats(cli_command command, char *buffer, size_t size)
{
    if (command == CLI_RENDER) {
        snprintf(buffer, size, "png ppm");
        return;
    }
    char list[WORDS_SIZE];
    cli_formats_list(list, sizeof list, " ", command == CLI_INFO ? CSGM_IS_READ : CSGM_IS_WRITTEN);
    snprintf(buffer, size, "%s", list + (*list == ' '));
    for (int i = CSGM_DRAWING_NONE + 1; command != CLI_INFO && i < CSGM_DRAWING_COUNT; i++) {
        size_t length = strlen(buffer);
        snprintf(buffer + length, size - length, " %s",
                 csgm_drawing_format_name((csgm_drawing_format)i));
    }
}

const char *cli_value_words(cli_command command, const cli_option_row *option, char *buffer,
                            size_t size)
{
    *buffer = '\0';
    if (option->kind && strcmp(option->kind, "CHOICE") == 0) {
        snprintf(buffer, size, "%s", option->argument);
        replace(buffer, '|', ' ');
    } else if (option->argument && strcmp(option->argument, "FORMAT") == 0) {
        put_formats(command, buffer, size);
    }
    return buffer;
}

/* bash|zsh|fish, the names of commands, or files. */
completer cli_operand_completer(cli_command command)
{
    const char *operands = cli_command_rows[command].operands;
    bool is_words = (*operands >= 'a' && *operands <= 'z') || strcmp(operands, "[COMMAND]") == 0;
    return !*operands ? COMPLETE_NOTHING : is_words ? COMPLETE_WORDS : COMPLETE_FILES;
}

const char *cli_operand_words(cli_command command, char *buffer, size_t size)
{
    const char *operands = cli_command_rows[command].operands;
    *buffer = '\0';
    if (*operands != '[') {
        snprintf(buffer, size, "%s", operands);
        replace(buffer, '|', ' ');
        return buffer;
    }
    for (size_t i = 0, at = 0; i < CLI_COMMAND_COUNT && at < size; i++)
        at += (size_t)snprintf(buffer + at, size - at, "%s%s", i ? " " : "",
                               cli_command_rows[i].name);
    return buffer;
}

const char *cli_operand_extensions(cli_command command, char *buffer, size_t size)
{
    const char *operands = cli_command_rows[command].operands;
    char meshes[WORDS_SIZE] = "";
    bool has_scenes = strstr(operands, "SCENE"), has_meshes = strstr(operands, "MESH");
    if (has_meshes)
        cli_formats_list(meshes, sizeof meshes, "|", CSGM_IS_READ);
    snprintf(buffer, size, "%s%s%s", has_scenes ? SCENES : "", meshes,
             strstr(operands, "MANIFEST") ? "|json" : "");
    return buffer;
}

/* ---- pieces of scripts --------------------------------------------------------------- */

void cli_put_commands(const char *between)
{
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++)
        printf("%s%s", i ? between : "", cli_command_rows[i].name);
}

/* Is what this row says of its name said already, by a row above it, or gainsaid, by a command
 * whose option of this name takes no value? */
static bool is_settled(const cli_option_row *option)
{
    for (int command = 0; command < CLI_COMMAND_COUNT; command++)
        for (const cli_option_row *row = NULL;
             command != CLI_OPENSCAD && (row = cli_next_option((cli_command)command, row));)
            if (row->name && option->name && row != option &&
                strcmp(row->name, option->name) == 0 &&
                (row < option || cli_option_taking(row) != CLI_TAKES_VALUE))
                return true;
    return false;
}

void cli_put_value_options(const char *between)
{
    const char *separator = "";
    for (int command = 0, seen = 0; command < CLI_COMMAND_COUNT; seen |= 1 << command++)
        for (const cli_option_row *row = NULL;
             command != CLI_OPENSCAD && (row = cli_next_option((cli_command)command, row));) {
            if (row->section || row->commands & seen || cli_option_taking(row) != CLI_TAKES_VALUE ||
                is_settled(row))
                continue;
            if (row->letter)
                printf("%s-%c", separator, row->letter);
            if (row->name)
                printf("%s--%s", row->letter ? between : separator, row->name);
            separator = between;
        }
}

/* Up to a ';', or to a ':' that ends what is a sentence without the rest. */
static size_t brief_length(const char *text)
{
    enum { SHORT = 24 };
    size_t length = strcspn(text, ";");
    const char *colon = strstr(text, ": ");
    return colon && colon - text > SHORT && (size_t)(colon - text) < length ? (size_t)(colon - text)
                                                                            : length;
}

void cli_put_brief(cli_command command, const cli_option_row *option, const char *escaped,
                   const char *quote)
{
    const char *text = cli_option_text(command, option);
    for (const char *end = text + brief_length(text); text < end; text++) {
        if (*text == '\'') {
            fputs(quote, stdout);
            continue;
        }
        if (strchr(escaped, *text))
            putchar('\\');
        putchar(*text);
    }
}

/* ---- the command --------------------------------------------------------------------- */

int cli_cmd_completion(cli_app *app)
{
    static const struct {
        const char *name;
        void (*print)(void);
    } shells[] = {
        {"bash", cli_completion_bash}, {"zsh", cli_completion_zsh}, {"fish", cli_completion_fish}};
    const cli_list *operands = &app->options->operands;
    if (operands->count != 1)
        return cli_usage_error(app, "bash, zsh or fish",
                               operands->count ? "one shell at a time" : "no shell given");
    for (size_t i = 0; i < sizeof shells / sizeof *shells; i++)
        if (strcmp(operands->items[0], shells[i].name) == 0) {
            shells[i].print();
            return cli_finish_stdout(app, CLI_DONE);
        }
    return cli_usage_error(app, "bash, zsh or fish",
                           "there are no completions for the shell '%.80s'", operands->items[0]);
}
