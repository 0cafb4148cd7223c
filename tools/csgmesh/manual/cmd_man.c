/* SPDX-License-Identifier: MIT
 * csgmesh man [COMMAND]: a page of the manual in the macros of man(7), made from the tables.
 */
#include <stdio.h>
#include <string.h>

#include "core/cli.h"
#include "core/commands.h"
#include "core/format_lists.h"
#include "manual/page.h"

static void put_options(cli_command command)
{
    puts(".SH OPTIONS");
    for (const cli_option_row *row = NULL; (row = cli_next_option(command, row));) {
        if (!row->section)
            cli_page_option(command, row);
        else if (command != CLI_OPENSCAD)
            printf(".SS %s\n", row->section);
    }
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
    cli_page_head(name, row->summary);
    printf(".SH SYNOPSIS\n.B csgmesh %s%s%s\n.I ", command == CLI_MESH ? "[" : "", row->name,
           command == CLI_MESH ? "]" : "");
    cli_page_text(row->operands);
    puts("\n.RI [ options ]");
    cli_page_examples(row->examples);
    put_options(command);
    if (command == CLI_DIFF)
        cli_page_status("the same", "different");
    else
        cli_page_status("done", "the input is at fault");
    put_others(command);
}

static void put_whole_page(void)
{
    char formats[160];
    cli_formats_list(formats, sizeof formats, " .", CSGM_IS_WRITTEN);
    cli_page_head("csgmesh", "text scenes of solids and blends to watertight triangle meshes");
    puts(".SH SYNOPSIS\n.B csgmesh\n.RI [ COMMAND ]\n.IR FILE ...\n.RI [ options ]\n"
         ".SH DESCRIPTION\n.B csgmesh\ncompiles a short text that says which solids there are and "
         "how "
         "they join into a watertight\ntriangle mesh, with fillets where they meet. The language "
         "is that "
         "of OpenSCAD, with blends.\nThe extension of the output chooses the format:");
    cli_page_text(formats + 1);
    puts(".");
    puts("Without a command the scene is meshed.\n.SH COMMANDS");
    for (int i = 0; i < CLI_COMMAND_COUNT; i++) {
        printf(".TP\n.BR csgmesh\\-%s (1)\n", cli_command_rows[i].name);
        cli_page_line(cli_command_rows[i].summary);
    }
    cli_page_examples(cli_command_rows[CLI_MESH].examples);
    cli_page_status("done", "the input is at fault");
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
