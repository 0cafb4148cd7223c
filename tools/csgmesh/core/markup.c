/* SPDX-License-Identifier: MIT
 * The characters of markup become entities; see markup.h.
 */
#include "core/markup.h"

#include <stdbool.h>

static bool is_kept(unsigned char c, cli_markup markup)
{
    if (c >= 0x20 && c != 0x7F)
        return true;
    return markup == CLI_HTML || (markup == CLI_XML_LINES && (c == '\n' || c == '\t'));
}

void cli_put_markup(FILE *out, const char *text, cli_markup markup)
{
    for (; *text; text++) {
        unsigned char c = (unsigned char)*text;
        const char *entity = c == '&'                          ? "&amp;"
                             : c == '<'                        ? "&lt;"
                             : c == '>'                        ? "&gt;"
                             : c == '"'                        ? "&quot;"
                             : c == '\'' && markup == CLI_HTML ? "&#39;"
                                                               : NULL;
        if (entity)
            fputs(entity, out);
        else
            fputc(is_kept(c, markup) ? c : '?', out);
    }
}
