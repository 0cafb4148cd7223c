/* SPDX-License-Identifier: MIT
 * The fonts of one compilation: by name or file, opened once.
 */
#ifndef CSG_OUTLINE_FONTS_H
#define CSG_OUTLINE_FONTS_H

#include "outline/letters/font.h"

/* Fonts found and opened, kept for the next text. Not to be used by two threads at once. */
typedef struct csg_fonts csg_fonts;

csgm_status csg_fonts_create(csg_memory *memory, csg_fonts **out);
void csg_fonts_destroy(csg_fonts *fonts); /* NULL is a no-op */
/* A font file whose fonts can be named from now on (use <font.ttf>). */
csgm_status csg_fonts_add_file(csg_fonts *fonts, const char *path, csg_problem *problem);

/* Files opened so far, in the order of first use; NULL when index is past the end. */
const char *csg_fonts_file(const csg_fonts *fonts, size_t index);

typedef struct csg_font_choice {
    csg_font *font;
    char name[176];
    bool font_missing, style_missing;
} csg_font_choice;

/* By name or file. */
csgm_status csg_fonts_choose(csg_fonts *fonts, const char *name, csg_font_choice *out,
                             csg_problem *problem);
/* A font like `name` that has the character; *out = NULL: none has it. */
csgm_status csg_fonts_choose_for(csg_fonts *fonts, const char *name, uint32_t character,
                                 csg_font_choice *out, csg_problem *problem);
csg_memory *csg_fonts_memory(const csg_fonts *fonts);

#endif
