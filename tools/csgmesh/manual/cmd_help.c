/* SPDX-License-Identifier: MIT
 * csgmesh help [COMMAND]: texts made from the tables, examples first.
 */
#include <stdio.h>
#include <string.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/format_lists.h"
#include "core/options.h"
#include "manual/rows.h"

enum { TEXT_COLUMN = 28, LINE_WIDTH = 92 };

static void print_form(const cli_option_row *option, char *buffer, size_t size)
{
    char letter[8] = "    ", name[64] = "", value[64];
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c%s", option->letter, option->name ? ", " : "");
    if (option->name)
        snprintf(name, sizeof name, "--%s", option->name);
    snprintf(buffer, size, "  %s%s%s", letter, name, cli_option_value(option, value, sizeof value));
}

/* Words of `text` from TEXT_COLUMN on; `column` is where the cursor stands. */
static void print_wrapped(const char *text, int column)
{
    if (column >= TEXT_COLUMN) {
        putchar('\n');
        column = 0;
    }
    printf("%*s", TEXT_COLUMN - column, "");
    column = TEXT_COLUMN;
    for (bool first = true; *text; first = false) {
        int word = (int)strcspn(text, " ");
        bool breaks = !first && column + 1 + word > LINE_WIDTH;
        if (breaks)
            printf("\n%*s", TEXT_COLUMN, "");
        printf("%s%.*s", first || breaks ? "" : " ", word, text);
        column = (breaks ? TEXT_COLUMN : column + !first) + word;
        text += word + (text[word] == ' ');
    }
    putchar('\n');
}

void cli_help_command(cli_command command)
{
    const cli_command_row *row = &cli_command_rows[command];
    printf("csgmesh %s: %s\n\n%s\nUsage: csgmesh %s%s%s [options]\n", row->name, row->summary,
           row->examples, command == CLI_MESH ? "[mesh]" : row->name, *row->operands ? " " : "",
           row->operands);
    for (const cli_option_row *option = NULL; (option = cli_next_option(command, option));) {
        char form[160];
        if (option->section) {
            printf("\n%s\n", option->section);
            continue;
        }
        print_form(option, form, sizeof form);
        printf("%s", form);
        print_wrapped(cli_option_text(command, option), (int)strlen(form));
    }
}

void cli_help(void)
{
    char formats[160];
    cli_formats_list(formats, sizeof formats, " .", CSGM_IS_WRITTEN);
    printf("csgmesh compiles text scenes of solids and blends to watertight triangle meshes.\n\n"
           "  csgmesh mug.txt -o mug.glb                  a mesh: few triangles, small where it is "
           "curved\n"
           "  csgmesh mug.txt -o mug.stl --quality fine   four times nearer\n"
           "  csgmesh mug.txt -o mug.glb -D radius=50     another value for the scene's 'radius'\n"
           "  csgmesh render mug.txt -o mug.png           a picture of it\n"
           "  csgmesh check mug.txt                       look for mistakes, write nothing\n"
           "  csgmesh info mug.glb                        what is in a file\n\n"
           "Usage: csgmesh [COMMAND] FILE... [options]\n\nCommands\n");
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++)
        printf("  %-10s  %s\n", cli_command_rows[i].name, cli_command_rows[i].summary);
    printf(
        "\nThe options most used (csgmesh help mesh lists all)\n"
        "  -o FILE        %s; - is standard output\n"
        "  -r N            cells along the longest side\n"
        "  -s H            or the edge of a cell\n"
        "  -D NAME=EXPR    replace an assignment of the scene (csgmesh params SCENE lists them)\n"
        "  --stats         counts, measures and times as JSON\n"
        "  -q              errors only\n\n"
        "Exit status: 0 done, 1 the input is at fault, 2 trouble (usage, files, limits).\n",
        formats);
}

bool cli_read_topic(cli_app *app, bool *is_given, cli_command *topic)
{
    const cli_list *operands = &app->options->operands;
    *is_given = operands->count > 0;
    if (operands->count > 1) {
        cli_usage_error(app, NULL, "one command at a time: '%s' is one too many",
                        operands->items[1]);
        return false;
    }
    return !*is_given || cli_command_find(app, operands->items[0], topic);
}

int cli_cmd_help(cli_app *app)
{
    bool is_given;
    cli_command topic;
    if (!cli_read_topic(app, &is_given, &topic))
        return CLI_TROUBLE;
    if (is_given)
        cli_help_command(topic);
    else
        cli_help();
    return cli_finish_stdout(app, CLI_DONE);
}
