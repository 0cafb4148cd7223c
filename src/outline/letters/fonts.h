/* SPDX-License-Identifier: MIT
 * The fonts of one compilation: by name or file, opened once.
 */
#ifndef CSG_OUTLINE_FONTS_H
#define CSG_OUTLINE_FONTS_H

#include "outline/letters/text.h"

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
