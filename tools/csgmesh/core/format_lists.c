/* SPDX-License-Identifier: MIT
 * Lists of formats; see format_lists.h. The library says which formats there are, nothing here
 * does.
 */
#include "core/format_lists.h"

#include <stdio.h>
#include <string.h>

static csgm_format next_with(csgm_format format, uint32_t traits)
{
    int next = (int)format + 1;
    while (next < CSGM_FORMAT_COUNT && (csgm_format_traits((csgm_format)next) & traits) != traits)
        next++;
    return (csgm_format)next;
}

static void append(char *buffer, size_t size, const char *before, const char *text)
{
    size_t length = strlen(buffer);
    snprintf(buffer + length, size - length, "%s%s", before, text);
}

void cli_formats_list(char *buffer, size_t size, const char *before, uint32_t traits)
{
    *buffer = 0;
    for (csgm_format f = next_with(CSGM_FORMAT_AUTO, traits); f < CSGM_FORMAT_COUNT;
         f = next_with(f, traits))
        append(buffer, size, before, csgm_format_name(f));
}

void cli_formats_of_this_build(char *buffer, size_t size)
{
    *buffer = 0;
    for (csgm_drawing_format d = CSGM_DRAWING_NONE + 1; d < CSGM_DRAWING_COUNT; d++)
        if (csgm_drawing_format_available(d))
            append(buffer, size, *buffer ? " " : "flat scenes: ", csgm_drawing_format_name(d));
    append(buffer, size, *buffer ? "; " : "", "formats:");
    for (csgm_format f = next_with(CSGM_FORMAT_AUTO, 0); f < CSGM_FORMAT_COUNT; f = next_with(f, 0))
        if (csgm_format_available(f, false))
            append(buffer, size, " ", csgm_format_name(f));
}

const char *cli_formats_in_words(char *buffer, size_t size, uint32_t traits)
{
    *buffer = 0;
    for (csgm_format f = next_with(CSGM_FORMAT_AUTO, traits), next; f < CSGM_FORMAT_COUNT;
         f = next) {
        next = next_with(f, traits);
        const char *before = !*buffer ? "" : next == CSGM_FORMAT_COUNT ? " or " : ", ";
        append(buffer, size, before, csgm_format_title(f));
    }
    return buffer;
}
