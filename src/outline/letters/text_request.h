/* SPDX-License-Identifier: MIT
 * What is asked of a text, and what is told of it; see text.h.
 */
#ifndef CSG_OUTLINE_TEXT_REQUEST_H
#define CSG_OUTLINE_TEXT_REQUEST_H

#include "outline/letters/font.h"

typedef enum csg_halign { CSG_HALIGN_LEFT, CSG_HALIGN_CENTER, CSG_HALIGN_RIGHT } csg_halign;
typedef enum csg_valign {
    CSG_VALIGN_BASELINE,
    CSG_VALIGN_BOTTOM,
    CSG_VALIGN_CENTER,
    CSG_VALIGN_TOP
} csg_valign;

typedef struct csg_text_request {
    const char *text; /* UTF-8; broken bytes are U+FFFD */
    size_t length;
    const char *font; /* NULL or "" = "Liberation Sans"; "Family:style=Bold"; or a file, when it has
                         a slash or ends in .ttf, .otf, .ttc or .otc */
    double size, spacing;
    csg_halign halign;
    csg_valign valign;
    csg_text_direction direction;
    const char *language, *script; /* NULL or "" = "en", and by the characters */
    int pieces;                    /* of each curve, > 0; 0 = by the tolerance */
    double tolerance;              /* of flattened curves; > 0 */
} csg_text_request;

enum { CSG_TEXT_MOST_MISSING = 8, CSG_TEXT_MOST_CHARACTERS = 100000 };

typedef struct csg_text_report {
    char font[176];     /* the font in use, "Family:style=Bold" or the file */
    bool font_missing;  /* it is not the one that was asked for */
    bool style_missing; /* its family is, its style is not */
    char other[176];    /* the first font that lent a character; empty = none */
    size_t lent;        /* characters so taken */
    uint32_t missing[CSG_TEXT_MOST_MISSING]; /* the first ones that no font has */
    size_t missing_count;                    /* all of these */
    /* textmetrics(): */
    csg_vec2 position, extent; /* corner and size of the outline's box */
    double ascent, descent;    /* above and below the baseline, before the alignment */
    csg_vec2 advance, offset;  /* to where further text would begin; of the alignment */
    csg_problem problem;
} csg_text_report;

#endif
