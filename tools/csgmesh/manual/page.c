/* SPDX-License-Identifier: MIT
 * Pieces of pages; see page.h.
 */
#include "manual/page.h"

#include <stdio.h>
#include <string.h>

#include "csgmesh/csgmesh.h"

void cli_page_text(const char *text)
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

void cli_page_line(const char *text)
{
    cli_page_text(text);
    putchar('\n');
}

void cli_page_examples(const char *text)
{
    puts(".SH EXAMPLES\n.EX");
    while (*text) {
        char line[256];
        int length = (int)strcspn(text, "\n");
        int indent = (int)strspn(text, " ");
        snprintf(line, sizeof line, "%.*s", length - indent, text + indent);
        cli_page_line(line);
        text += length + (text[length] == '\n');
    }
    puts(".EE");
}

void cli_page_head(const char *name, const char *summary)
{
    printf(".\\\" SPDX-License-Identifier: MIT\n.TH ");
    for (const char *c = name; *c; c++)
        putchar(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
    printf(" 1 \"\" \"csgmesh %s\" \"csgmesh\"\n.nh\n.SH NAME\n", csgm_version());
    cli_page_text(name);
    printf(" \\- ");
    cli_page_line(summary);
}

void cli_page_option(cli_command command, const cli_option_row *option)
{
    char value[64];
    puts(".TP");
    if (option->letter)
        printf("\\fB\\-%c\\fR", option->letter);
    if (option->letter && option->name)
        fputs(", ", stdout);
    if (option->name) {
        fputs("\\fB", stdout);
        cli_page_text("--");
        cli_page_text(option->name);
        fputs("\\fR", stdout);
    }
    cli_option_value(option, value, sizeof value);
    if (*value) {
        fputs("\\fI", stdout);
        cli_page_text(value);
        fputs("\\fR", stdout);
    }
    putchar('\n');
    cli_page_line(cli_option_text(command, option));
}

void cli_page_status(const char *zero, const char *one)
{
    printf(".SH \"EXIT STATUS\"\n.TP\n.B 0\n%s\n.TP\n.B 1\n%s\n.TP\n.B 2\ntrouble: usage, files, "
           "limits\n",
           zero, one);
}
