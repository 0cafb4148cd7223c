/* SPDX-License-Identifier: MIT
 * Instead of font.c where FreeType or HarfBuzz is missing: no font can be opened, so the others
 * are not called.
 */
#include "outline/letters/font.h"

csgm_status csg_font_open(csg_bytes *bytes, unsigned index, csg_font **out, csg_problem *problem)
{
    (void)index;
    *out = NULL;
    csg_bytes_release(bytes);
    return csg_problem_set(problem, CSGM_ERR_UNSUPPORTED,
                           "this build has no text (made without FreeType and HarfBuzz)");
}
void csg_font_close(csg_font *font)
{
    (void)font;
}
bool csg_font_has(const csg_font *font, uint32_t character)
{
    (void)font, (void)character;
    return false;
}
csg_font_metrics csg_font_get_metrics(const csg_font *font)
{
    (void)font;
    return (csg_font_metrics){0};
}
csg_character_kind csg_character_kind_of(uint32_t character)
{
    (void)character;
    return CSG_CHARACTER_PLAIN;
}
uint32_t csg_character_script(uint32_t character)
{
    (void)character;
    return 0;
}
bool csg_script_is_rtl(uint32_t script)
{
    (void)script;
    return false;
}
uint32_t csg_script_of_name(const char *name)
{
    (void)name;
    return 0;
}
csgm_status csg_font_shape(csg_font *font, const csg_font_run *run, csg_memory *memory,
                           csg_glyph **glyphs, size_t *count, size_t *capacity)
{
    (void)font, (void)run, (void)memory, (void)glyphs, (void)count, (void)capacity;
    return CSGM_ERR_UNSUPPORTED;
}
csgm_status csg_font_outline(csg_font *font, uint32_t glyph, const csg_font_pen *pen,
                             csg_outline *out)
{
    (void)font, (void)glyph, (void)pen, (void)out;
    return CSGM_ERR_UNSUPPORTED;
}
csg_box csg_font_box(csg_font *font, uint32_t glyph)
{
    (void)font, (void)glyph;
    return csg_box_empty();
}
