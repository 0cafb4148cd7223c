/* SPDX-License-Identifier: MIT
 * One font file in memory: which characters it has, glyphs placed for a run of text, their
 * outlines. TrueType and OpenType. All numbers are for text of size CSG_FONT_SIZE, at OpenSCAD's
 * resolution of 100 dots to the inch of 72 points: an em is 138889.
 */
#ifndef CSG_OUTLINE_FONT_H
#define CSG_OUTLINE_FONT_H

#include "outline/input.h"

typedef struct csg_font csg_font;

/* Of FreeType's units of a 64th of a pixel. */
enum { CSG_FONT_SIZE = 100000 };

typedef enum csg_text_direction {
    CSG_TEXT_AUTO,
    CSG_TEXT_LTR,
    CSG_TEXT_RTL,
    CSG_TEXT_TTB,
    CSG_TEXT_BTT
} csg_text_direction;

/* `bytes` belong to the font from now on, also when it fails. index: of the face in the file, from
 * bit 16 on the named instance, as fontconfig has it. CSGM_ERR_FORMAT: broken or of another kind.
 */
csgm_status csg_font_open(csg_bytes *bytes, unsigned index, csg_font **out, csg_problem *problem);
void csg_font_close(csg_font *font);

bool csg_font_has(const csg_font *font, uint32_t character);

typedef struct csg_font_metrics {
    double ascent, descent; /* descent is below 0 */
    double interline;
    double top, bottom; /* of all glyphs */
} csg_font_metrics;

csg_font_metrics csg_font_get_metrics(const csg_font *font);

/* ---- characters ---------------------------------------------------------------------- */

typedef enum csg_character_kind {
    CSG_CHARACTER_PLAIN,
    CSG_CHARACTER_BLANK, /* these and marks are set in the font of what stands before */
    CSG_CHARACTER_MARK,
    CSG_CHARACTER_DIGIT,     /* runs from left to right in every script */
    CSG_CHARACTER_INVISIBLE, /* joiners, selectors: no font needs them */
    CSG_CHARACTER_CONTROL    /* line ends and the like: no font has them */
} csg_character_kind;

csg_character_kind csg_character_kind_of(uint32_t character);
/* A tag of ISO 15924; 0 = takes that of its neighbours. */
uint32_t csg_character_script(uint32_t character);
bool csg_script_is_rtl(uint32_t script);
/* "arab", "Latn", ...; 0 for NULL, "" and what is no tag. */
uint32_t csg_script_of_name(const char *name);

/* ---- glyphs --------------------------------------------------------------------------- */

typedef struct csg_glyph {
    uint32_t id;
    uint32_t character; /* index in the run */
    double advance_x, advance_y, offset_x, offset_y;
} csg_glyph;

typedef struct csg_font_run {
    const uint32_t *characters;
    size_t count;
    csg_text_direction direction; /* not AUTO */
    uint32_t script;              /* 0 = by the text */
    const char *language;         /* NULL or "" = "en" */
} csg_font_run;

/* In order of sight, from left to right or top to bottom. Adds to an array from `memory`. */
csgm_status csg_font_shape(csg_font *font, const csg_font_run *run, csg_memory *memory,
                           csg_glyph **glyphs, size_t *count, size_t *capacity);

typedef struct csg_font_pen {
    double scale; /* either sign */
    csg_vec2 shift;
    int pieces;       /* of each curve; 0 = by the tolerance */
    double tolerance; /* of flattened curves */
} csg_font_pen;

/* Adds the loops of a glyph, each point times the pen's scale plus its shift; they run
 * counter-clockwise around what is inside. What the font fails to give is empty. */
csgm_status csg_font_outline(csg_font *font, uint32_t glyph, const csg_font_pen *pen,
                             csg_outline *out);
/* Highest and lowest of the points of a glyph, those off the curve included, out to whole pixels;
 * 0 for an empty one. */
csg_box csg_font_box(csg_font *font, uint32_t glyph);

#endif
