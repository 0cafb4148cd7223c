/* SPDX-License-Identifier: MIT
 * csgmesh man [COMMAND]: a page of the manual in the macros of man(7), made from the tables.
 */
#include <stdio.h>
#include <string.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/format_lists.h"
#include "manual/rows.h"

/* Text of one line: nothing of it is a macro. A hyphen is the sign that is typed. */
static void put_text(const char *text)
{
    if (*text == '.' || *text == '\'')
        fputs("\\&", stdout);
    for (; *text; text++) {
        if (*text == '\\')
            fputs("\\e", stdout);
        else if (*text == '-')
            fputs("\\-", stdout);
        else if (*text == '\'')
            fputs("\\(aq", stdout);
        else if (*text == '^')
            fputs("\\(ha", stdout);
        else if (*text == '~')
            fputs("\\(ti", stdout);
        else if (*text == '`')
            fputs("\\(ga", stdout);
        else
            putchar(*text);
    }
}

static void put_line(const char *text)
{
    put_text(text);
    putchar('\n');
}

/* Lines of examples, without the blanks that the help indents them by. */
static void put_examples(const char *text)
{
    puts(".SH EXAMPLES\n.EX");
    while (*text) {
        char line[256];
        int length = (int)strcspn(text, "\n");
        int indent = (int)strspn(text, " ");
        snprintf(line, sizeof line, "%.*s", length - indent, text + indent);
        put_line(line);
        text += length + (text[length] == '\n');
    }
    puts(".EE");
}

static void put_head(const char *name, const char *summary)
{
    printf(".\\\" SPDX-License-Identifier: MIT\n.TH ");
    for (const char *c = name; *c; c++)
        putchar(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
    printf(" 1 \"\" \"csgmesh %s\" \"csgmesh\"\n.nh\n.SH NAME\n", csgm_version());
    put_text(name);
    printf(" \\- ");
    put_line(summary);
}

static void put_option(cli_command command, const cli_option_row *option)
{
    char value[64];
    puts(".TP");
    if (option->letter)
        printf("\\fB\\-%c\\fR", option->letter);
    if (option->letter && option->name)
        fputs(", ", stdout);
    if (option->name) {
        fputs("\\fB", stdout);
        put_text("--");
        put_text(option->name);
        fputs("\\fR", stdout);
    }
    cli_option_value(option, value, sizeof value);
    if (*value) {
        fputs("\\fI", stdout);
        put_text(value);
        fputs("\\fR", stdout);
    }
    putchar('\n');
    put_line(cli_option_text(command, option));
}

static void put_options(cli_command command)
{
    puts(".SH OPTIONS");
    for (const cli_option_row *row = NULL; (row = cli_next_option(command, row));) {
        if (!row->section)
            put_option(command, row);
        else if (command != CLI_OPENSCAD)
            printf(".SS %s\n", row->section);
    }
}

static void put_status(bool is_diff)
{
    printf(".SH \"EXIT STATUS\"\n.TP\n.B 0\n%s\n.TP\n.B 1\n%s\n.TP\n.B 2\ntrouble: usage, files, "
           "limits\n",
           is_diff ? "the same" : "done", is_diff ? "different" : "the input is at fault");
}

/* All pages but `except`; -1: all but that of the whole. */
static void put_others(int except)
{
    puts(".SH \"SEE ALSO\"");
    if (except >= 0)
        puts(".BR csgmesh (1),");
    int last = CLI_COMMAND_COUNT - 1 - (except == CLI_COMMAND_COUNT - 1);
    for (int i = 0; i < CLI_COMMAND_COUNT; i++)
        if (i != except)
            printf(".BR csgmesh\\-%s (1)%s\n", cli_command_rows[i].name, i == last ? "" : ",");
}

static void put_command_page(cli_command command)
{
    const cli_command_row *row = &cli_command_rows[command];
    char name[64];
    snprintf(name, sizeof name, "csgmesh-%s", row->name);
    put_head(name, row->summary);
    printf(".SH SYNOPSIS\n.B csgmesh %s%s%s\n.I ", command == CLI_MESH ? "[" : "", row->name,
           command == CLI_MESH ? "]" : "");
    put_text(row->operands);
    puts("\n.RI [ options ]");
    put_examples(row->examples);
    put_options(command);
    put_status(command == CLI_DIFF);
    put_others(command);
}

static void put_whole_page(void)
{
    char formats[160];
    cli_formats_list(formats, sizeof formats, " .", CSGM_IS_WRITTEN);
    put_head("csgmesh", "text scenes of solids and blends to watertight triangle meshes");
    puts(".SH SYNOPSIS\n.B csgmesh\n.RI [ COMMAND ]\n.IR FILE ...\n.RI [ options ]\n"
         ".SH DESCRIPTION\n.B csgmesh\ncompiles a short text that says which solids there are and "
         "how "
         "they join into a watertight\ntriangle mesh, with fillets where they meet. The language "
         "is that "
         "of OpenSCAD, with blends.\nThe extension of the output chooses the format:");
    put_text(formats + 1);
    puts(".");
    puts("Without a command the scene is meshed.\n.SH COMMANDS");
    for (int i = 0; i < CLI_COMMAND_COUNT; i++) {
        printf(".TP\n.BR csgmesh\\-%s (1)\n", cli_command_rows[i].name);
        put_line(cli_command_rows[i].summary);
    }
    put_examples(cli_command_rows[CLI_MESH].examples);
    put_status(false);
    puts(".SH ENVIRONMENT\n.TP\n.BR CSGMESH_PATH \", \" OPENSCADPATH\nfolders, with colons "
         "between, in "
         "which include, use and import look, after those of\n.B \\-I\n.TP\n.B "
         "CSGMESH_ROOT\nfolders, "
         "with colons between, below which alone files are read and written, as\n.B "
         "\\-\\-root\nsays\n.TP\n"
         ".B CSGMESH_ISA\nthe vector instructions to use: scalar, sse2, avx2, avx512 or neon, "
         "where the "
         "processor has\nthem; the meshes are the same\n.TP\n.B NO_COLOR\nno colour in messages, "
         "where it "
         "is not empty");
    puts(".SH FILES\n.TP\n.I share/doc/csgmesh\nbelow the prefix of the installation: the manual "
         "of the "
         "language, a page about each command,\nand many scenes");
    put_others(-1);
}

int cli_cmd_man(cli_app *app)
{
    bool is_given;
    cli_command topic;
    if (!cli_read_topic(app, &is_given, &topic))
        return CLI_TROUBLE;
    if (is_given)
        put_command_page(topic);
    else
        put_whole_page();
    return cli_finish_stdout(app, CLI_DONE);
}
