/* SPDX-License-Identifier: MIT
 * What pages of the manual are put together from, in the macros of man(7), on standard output.
 */
#ifndef CLI_MANUAL_PAGE_H
#define CLI_MANUAL_PAGE_H

#include "manual/rows.h"

/* Text of one line: nothing of it is a macro. A hyphen is the sign that is typed. */
void cli_page_text(const char *text);
/* The same, and the end of the line. */
void cli_page_line(const char *text);
/* "csgmesh-mesh", and what it does in a few words. */
void cli_page_head(const char *name, const char *summary);
/* Lines of examples, without the blanks that the help indents them by. */
void cli_page_examples(const char *text);
void cli_page_option(cli_command command, const cli_option_row *option);
/* What exit status 0 and 1 mean. */
void cli_page_status(const char *zero, const char *one);

#endif
