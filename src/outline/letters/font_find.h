/* SPDX-License-Identifier: MIT
 * Which file holds the font of a name: fontconfig, or nothing. What is found depends on the machine
 * and its configuration; name a font file where the same mesh is wanted everywhere.
 */
#ifndef CSG_OUTLINE_FONT_FIND_H
#define CSG_OUTLINE_FONT_FIND_H

#include <stdbool.h>
#include <stdint.h>

typedef struct csg_font_finder csg_font_finder;

typedef struct csg_font_place {
    char path[1024];
    unsigned index; /* as of csg_font_open */
    char family[96], style[64];
    bool same_family, same_style; /* those that were asked for, or none were */
} csg_font_place;

/* NULL: out of memory, or built without fontconfig. */
csg_font_finder *csg_font_finder_create(void);
void csg_font_finder_destroy(csg_font_finder *finder);
bool csg_font_finder_exists(void); /* false: built without fontconfig */
/* Fonts of this file can be found by name from now on. */
bool csg_font_finder_add(csg_font_finder *finder, const char *path);
/* The nearest font to a name such as "Liberation Sans:style=Bold Italic"; if `character` is not 0,
 * one that has it. False: there is none. */
bool csg_font_find(csg_font_finder *finder, const char *name, uint32_t character,
                   csg_font_place *out);

#endif
