/* SPDX-License-Identifier: MIT
 * Help texts, made from commands.def and options.def: examples first.
 */
#include <stdio.h>
#include <string.h>

#include "core/cli.h"
#include "core/command_bits.h"
#include "core/format_lists.h"

typedef struct command_help {
    const char *name, *operands, *summary, *examples;
} command_help;

static const command_help commands[] = {
#define COMMAND(NAME, name, operands, summary, examples) {#name, operands, summary, examples},
#include "core/commands.def"
#undef COMMAND
};

typedef struct option_help {
    const char *section; /* of a SECTION row, else NULL */
    const char *name, *kind, *argument, *help;
    char letter;
    int commands;
} option_help;

static const option_help option_rows[] = {
#define SECTION(title) {.section = title},
#define OPTION(field, letter_, name_, kind_, argument_, commands_, help_)                          \
    {NULL, name_, #kind_, argument_, help_, letter_, commands_},
#include "core/options.def"
#undef SECTION
#undef OPTION
};

enum { OPTION_ROWS = sizeof option_rows / sizeof *option_rows, TEXT_COLUMN = 28, LINE_WIDTH = 92 };

static void print_form(const option_help *option, char *buffer, size_t size)
{
    char letter[8] = "    ", name[64] = "";
    bool is_report = strcmp(option->kind, "REPORT") == 0;
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c%s", option->letter, option->name ? ", " : "");
    if (option->name)
        snprintf(name, sizeof name, "--%s", option->name);
    snprintf(buffer, size, "  %s%s%s%s%s", letter, name,
             !option->argument ? ""
             : is_report       ? "[="
                               : " ",
             option->argument ? option->argument : "", is_report ? "]" : "");
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

/* OpenSCAD's own, of csgmesh openscad. */
static void print_openscad_options(void)
{
    static const struct {
        char letter;
        const char *name, *argument, *help;
    } rows[] = {
#define OPENSCAD_OPTION(NAME, letter, name, argument, help) {letter, name, argument, help},
#define OPENSCAD_REFUSED(NAME, letter, name, argument, why)
#include "openscad/openscad_options.def"
#undef OPENSCAD_OPTION
#undef OPENSCAD_REFUSED
    };
    putchar('\n');
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char letter[8] = "    ", form[96];
        bool has_name = rows[i].name[1];
        if (rows[i].letter)
            snprintf(letter, sizeof letter, "-%c%s", rows[i].letter, has_name ? ", " : "");
        snprintf(form, sizeof form, "  %s%s%s%s%s", letter, has_name ? "--" : "",
                 has_name ? rows[i].name : "",
                 rows[i].argument && rows[i].argument[0] != '[' ? " " : "",
                 rows[i].argument ? rows[i].argument : "");
        printf("%s", form);
        print_wrapped(rows[i].help, (int)strlen(form));
    }
}

static bool section_has_rows(size_t section, int command_bit)
{
    for (size_t i = section + 1; i < OPTION_ROWS && !option_rows[i].section; i++)
        if (option_rows[i].commands & command_bit)
            return true;
    return false;
}

static void print_options(int command_bit)
{
    for (size_t i = 0; i < OPTION_ROWS; i++) {
        const option_help *option = &option_rows[i];
        if (option->section) {
            if (section_has_rows(i, command_bit))
                printf("\n%s\n", option->section);
        } else if (option->commands & command_bit) {
            char form[96];
            print_form(option, form, sizeof form);
            printf("%s", form);
            print_wrapped(option->help, (int)strlen(form));
        }
    }
}

void cli_help_command(cli_command command)
{
    const command_help *row = &commands[command];
    printf("csgmesh %s: %s\n\n%s\nUsage: csgmesh %s %s [options]\n", row->name, row->summary,
           row->examples, command == CLI_MESH ? "[mesh]" : row->name, row->operands);
    if (command == CLI_OPENSCAD)
        print_openscad_options();
    else
        print_options(1 << command);
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
           "  csgmesh check mug.txt                       look for mistakes, write nothing\n"
           "  csgmesh info mug.glb                        what is in a file\n\n"
           "Usage: csgmesh [COMMAND] FILE... [options]\n\nCommands\n");
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++)
        printf("  %-8s %-22s %s\n", commands[i].name, commands[i].operands, commands[i].summary);
    printf("  %-8s %-22s %s\n", "help", "[COMMAND]", "all options of a command, with examples");
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
