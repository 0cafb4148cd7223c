/* SPDX-License-Identifier: MIT
 * Text -> an outline, as text() of OpenSCAD 2021.01 sets it: a capital letter of size 10 is about
 * 10 high (an em is size * 100 / 72), and letters stand at 1000 / 1024 of the font's distances.
 * Beyond OpenSCAD: characters that the font lacks are taken from other fonts, scripts are set in
 * their own runs, those from right to left in their order (UAX #9, see bidi.h).
 */
#ifndef CSG_OUTLINE_TEXT_H
#define CSG_OUTLINE_TEXT_H

#include "outline/letters/font.h"

/* Fonts found and opened, kept for the next text. Not to be used by two threads at once. */
typedef struct csg_fonts csg_fonts;

csgm_status csg_fonts_create(csg_memory *memory, csg_fonts **out);
void csg_fonts_destroy(csg_fonts *fonts); /* NULL is a no-op */
/* A font file whose fonts can be named from now on (use <font.ttf>). */
csgm_status csg_fonts_add_file(csg_fonts *fonts, const char *path, csg_problem *problem);

/* Files opened so far, in the order of first use; NULL when index is past the end. */
const char *csg_fonts_file(const csg_fonts *fonts, size_t index);

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

/* Loops as of csg_svg_outline (svg.h), but without that file's need of a library. CSGM_ERR_IO,
 * CSGM_ERR_FORMAT: a font file that cannot be read; CSGM_ERR_SCENE: no font at all;
 * CSGM_ERR_UNSUPPORTED. *out is initialised, and empty unless CSGM_OK. */
csgm_status csg_text_outline(csg_fonts *fonts, const csg_text_request *request, csg_outline *out,
                             csg_text_report *report);

/* fontmetrics(): of the font that text of this size would be set in. */
csgm_status csg_text_font_metrics(csg_fonts *fonts, const char *font, double size,
                                  csg_font_metrics *out, csg_text_report *report);

#endif
