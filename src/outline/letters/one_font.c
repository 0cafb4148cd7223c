/* SPDX-License-Identifier: MIT
 * Instead of font_find.c in a build that brings one font (-Done_font): it is the nearest to every
 * name.
 */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "outline/letters/font_find.h"

struct csg_font_finder {
    char unused;
};

static csg_font_finder the_finder;

csg_font_finder *csg_font_finder_create(void)
{
    return &the_finder;
}
void csg_font_finder_destroy(csg_font_finder *finder)
{
    (void)finder;
}
bool csg_font_finder_exists(void)
{
    return true;
}
bool csg_font_finder_add(csg_font_finder *finder, const char *path)
{
    (void)finder, (void)path;
    return false;
}

/* Is `wanted` among the names of `list`, which commas part, or is the list empty? */
static bool has_name(const char *list, size_t length, const char *wanted)
{
    size_t size = strlen(wanted);
    if (length == 0)
        return true;
    for (const char *end = list + length; list < end;) {
        const char *comma = memchr(list, ',', (size_t)(end - list));
        size_t part = (size_t)((comma ? comma : end) - list);
        if (part == size && strncasecmp(list, wanted, size) == 0)
            return true;
        list += part + 1;
    }
    return false;
}

bool csg_font_find(csg_font_finder *finder, const char *name, uint32_t character,
                   csg_font_place *out)
{
    (void)finder, (void)character; /* whoever asks for one looks into the font */
    *out = (csg_font_place){.path = CSG_ONE_FONT_FILE, .family = CSG_ONE_FONT, .style = "Regular"};
    const char *style = strstr(name, ":style=");
    out->same_family = has_name(name, strcspn(name, ":"), out->family);
    out->same_style = !style || has_name(style + 7, strcspn(style + 7, ":"), out->style);
    return true;
}
