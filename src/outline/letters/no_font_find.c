/* SPDX-License-Identifier: MIT
 * Instead of font_find.c where fontconfig is missing: no font is found by name.
 */
#include "outline/letters/font_find.h"

#include <stddef.h>

csg_font_finder *csg_font_finder_create(void)
{
    return NULL;
}
void csg_font_finder_destroy(csg_font_finder *finder)
{
    (void)finder;
}
bool csg_font_finder_exists(void)
{
    return false;
}
bool csg_font_finder_add(csg_font_finder *finder, const char *path)
{
    (void)finder, (void)path;
    return false;
}
bool csg_font_find(csg_font_finder *finder, const char *name, uint32_t character,
                   csg_font_place *out)
{
    (void)finder, (void)name, (void)character, (void)out;
    return false;
}
