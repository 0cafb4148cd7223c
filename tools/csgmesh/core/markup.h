/* SPDX-License-Identifier: MIT
 * Any text as text of XML and HTML.
 */
#ifndef CLI_MARKUP_H
#define CLI_MARKUP_H

#include <stdio.h>

typedef enum cli_markup {
    CLI_XML,       /* what XML cannot hold, and ends of lines, become a question mark */
    CLI_XML_LINES, /* ends of lines and tabs stay */
    CLI_HTML,      /* all stay */
} cli_markup;

void cli_put_markup(FILE *out, const char *text, cli_markup markup);

#endif
